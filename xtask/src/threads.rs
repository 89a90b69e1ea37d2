//! Work spread over the cores.

use std::sync::atomic::{AtomicUsize, Ordering};

/// `f` of all items, in their order, by as many threads as there are cores.
pub fn map_on_threads<A: Sync, B: Send>(items: &[A], f: impl Fn(&A) -> B + Sync) -> Vec<B> {
    let next = AtomicUsize::new(0);
    let work = || {
        let numbers = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        let mine = numbers.take_while(|&k| k < items.len());
        mine.map(|k| (k, f(&items[k]))).collect::<Vec<_>>()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut found: Vec<(usize, B)> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        handles.into_iter().flat_map(|h| h.join().expect("the work does not panic")).collect()
    });
    found.sort_by_key(|&(k, _)| k);
    found.into_iter().map(|(_, b)| b).collect()
}
