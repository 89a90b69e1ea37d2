//! The one place where threads are started: a map over indices that keeps the order.
//!
//! Each result depends on its index alone and lands in its own slot, so the outcome is the
//! same bytes with one thread, with many, and without the feature `parallel`.

/// `[f(0), f(1), .., f(len - 1)]`, with feature `parallel` on all threads of rayon's pool.
#[cfg(feature = "parallel")]
pub(crate) fn map_indexed<T: Send>(len: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    use rayon::prelude::*;
    (0..len).into_par_iter().map(&f).collect()
}

/// `[f(0), f(1), .., f(len - 1)]`, with feature `parallel` on all threads of rayon's pool.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map_indexed<T: Send>(len: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..len).map(f).collect()
}

/// Calls `f` with every chunk of `len` items (the last may be shorter) and the number of its first
/// item, with feature `parallel` on all threads of rayon's pool.
#[cfg(feature = "parallel")]
pub(crate) fn for_each_chunk<T: Send>(
    items: &mut [T],
    len: usize,
    f: impl Fn(usize, &mut [T]) + Sync,
) {
    use rayon::prelude::*;
    items.par_chunks_mut(len).enumerate().for_each(|(k, chunk)| f(k * len, chunk));
}

/// Calls `f` with every chunk of `len` items (the last may be shorter) and the number of its first
/// item, with feature `parallel` on all threads of rayon's pool.
#[cfg(not(feature = "parallel"))]
pub(crate) fn for_each_chunk<T: Send>(
    items: &mut [T],
    len: usize,
    f: impl Fn(usize, &mut [T]) + Sync,
) {
    items.chunks_mut(len).enumerate().for_each(|(k, chunk)| f(k * len, chunk));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_everything_once() {
        let mut items = vec![0; 10_001];
        for_each_chunk(&mut items, 100, |first, chunk| {
            chunk.iter_mut().enumerate().for_each(|(k, item)| *item += first + k);
        });
        assert!(items.iter().enumerate().all(|(k, &item)| k == item));
    }

    #[test]
    fn keeps_the_order() {
        assert!(map_indexed(0, |k| k).is_empty());
        assert!(map_indexed(10_000, |k| 3 * k).iter().enumerate().all(|(k, &x)| x == 3 * k));
    }
}
