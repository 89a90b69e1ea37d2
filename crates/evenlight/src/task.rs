//! How the library works: on how many threads, and who watches.
//!
//! All long work of this library takes both from the [`Task`] in which it runs:
//!
//! ```text
//!   Task::new().threads(2).watch(bar).run(|| tessellate(&surface, 16))
//!         |                    |                  |
//!         |                    |                  +-- Err(Cancelled) if the bar said so
//!         |                    +-- told of every step
//!         +-- at most two threads, which end with the work
//! ```
//!
//! Threads are started by the call that needs them and have ended when it returns. So a process may
//! fork between calls, and a host with threads of its own gives each call the share that it wants.
//!
//! Results do not depend on threads: each depends on its index alone and lands in its own slot.

use std::cell::RefCell;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// How much of the work is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// What is being done, as a few words for people.
    pub stage: &'static str,
    /// The steps of this stage that are done.
    pub done: usize,
    /// All steps of this stage.
    pub total: usize,
}

/// The function that watched the work stopped it ([`Task::watch`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the work was cancelled")]
pub struct Cancelled;

type Watch = dyn Fn(Progress) -> ControlFlow<()> + Send + Sync;

/// How the calls of this library within [`Task::run`] do their work.
///
/// ```
/// use std::ops::ControlFlow;
/// use evenlight::task::Task;
/// use evenlight::tessellate::{TessellateError, tessellate};
/// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
///
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
/// let surface = Surface::build(cage, SurfaceOptions::default())?;
/// let one_thread = Task::new().threads(1);
/// assert_eq!(one_thread.run(|| tessellate(&surface, 4)), tessellate(&surface, 4));
/// let impatient = Task::new().watch(|_| ControlFlow::Break(()));
/// assert_eq!(impatient.run(|| tessellate(&surface, 4)), Err(TessellateError::Cancelled));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Default)]
pub struct Task {
    threads: Option<NonZero<usize>>,
    watch: Option<Arc<Watch>>,
}

impl Task {
    /// The settings of the task around this one. Without one: all threads, and nobody watches.
    pub fn new() -> Self {
        Self::default()
    }

    /// At most this many threads; 0 for one per core. Without the feature `parallel` there is one.
    #[must_use]
    pub fn threads(self, count: usize) -> Self {
        let count = if cfg!(feature = "parallel") { count } else { 1 };
        Self { threads: Some(NonZero::new(count).unwrap_or_else(all_threads)), ..self }
    }

    /// Calls `watch` at the beginning and after every step; `Break` cancels the work, which then
    /// ends with an error as soon as it can.
    #[must_use]
    pub fn watch(
        self,
        watch: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Self {
        Self { watch: Some(Arc::new(watch)), ..self }
    }

    /// Does `work` as this task says.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> T {
        let around = Context::current();
        let own = Context {
            threads: self.threads.unwrap_or(around.threads),
            watch: self.watch.clone().or(around.watch),
        };
        own.during(work)
    }
}

impl std::fmt::Debug for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let is_watched = self.watch.is_some();
        f.debug_struct("Task")
            .field("threads", &self.threads)
            .field("watched", &is_watched)
            .finish()
    }
}

/// What a thread works under.
#[derive(Clone)]
struct Context {
    threads: NonZero<usize>,
    watch: Option<Arc<Watch>>,
}

thread_local! {
    static CURRENT: RefCell<Option<Context>> = const { RefCell::new(None) };
}

impl Context {
    fn current() -> Self {
        let own = CURRENT.with_borrow(Clone::clone);
        own.unwrap_or_else(|| Self { threads: all_threads(), watch: None })
    }

    /// Does `work` under this context; afterwards the context before is set again, in any case.
    fn during<T>(self, work: impl FnOnce() -> T) -> T {
        struct Restore(Option<Context>);
        impl Drop for Restore {
            fn drop(&mut self) {
                CURRENT.set(self.0.take());
            }
        }
        let _restore = Restore(CURRENT.replace(Some(self)));
        work()
    }
}

/// One thread per core.
fn all_threads() -> NonZero<usize> {
    static ALL: OnceLock<NonZero<usize>> = OnceLock::new();
    const ONE: NonZero<usize> = NonZero::<usize>::MIN;
    *ALL.get_or_init(|| {
        let is_parallel = cfg!(feature = "parallel");
        let cores = || std::thread::available_parallelism().unwrap_or(ONE);
        if is_parallel { cores() } else { ONE }
    })
}

/// The steps of one stage of work.
pub(crate) struct Steps {
    watch: Option<Arc<Watch>>,
    at: Progress,
}

impl Steps {
    /// Begins a stage.
    pub(crate) fn new(stage: &'static str, total: usize) -> Result<Self, Cancelled> {
        let steps =
            Self { watch: Context::current().watch, at: Progress { stage, done: 0, total } };
        steps.tell()?;
        Ok(steps)
    }

    /// One step is done.
    pub(crate) fn step(&mut self) -> Result<(), Cancelled> {
        self.at.done += 1;
        self.tell()
    }

    fn tell(&self) -> Result<(), Cancelled> {
        match &self.watch {
            Some(watch) if watch(self.at).is_break() => Err(Cancelled),
            _ => Ok(()),
        }
    }
}

/// `[f(0), f(1), .., f(len - 1)]`.
pub(crate) fn map_indexed<T: Send>(len: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    /// The number of parts for each thread: enough that no thread waits long for the last.
    const PARTS: usize = 8;
    let threads = Context::current().threads.get();
    let part = len.div_ceil(PARTS * threads).max(1);
    if threads == 1 || part >= len {
        return (0..len).map(f).collect();
    }
    let mut parts: Vec<Vec<T>> = Vec::new();
    parts.resize_with(len.div_ceil(part), Vec::new);
    for_each_chunk(&mut parts, 1, |k, slot| {
        slot[0] = (k * part..len.min((k + 1) * part)).map(&f).collect();
    });
    parts.into_iter().flatten().collect()
}

/// Calls `f` with every chunk of `len` items (the last may be shorter) and the number of its first
/// item.
pub(crate) fn for_each_chunk<T: Send>(
    items: &mut [T],
    len: usize,
    f: impl Fn(usize, &mut [T]) + Sync,
) {
    let chunks = items.len().div_ceil(len);
    let threads = Context::current().threads.get().min(chunks);
    if threads <= 1 {
        return items.chunks_mut(len).enumerate().for_each(|(k, chunk)| f(k * len, chunk));
    }
    let chunks = Mutex::new(items.chunks_mut(len).enumerate());
    let next = || chunks.lock().unwrap_or_else(PoisonError::into_inner).next();
    on_threads(threads, &|| {
        let Some((k, chunk)) = next() else { return false };
        f(k * len, chunk);
        true
    });
}

/// Calls `take_one` on `threads` threads until nothing is left: it does one part of the work, or
/// says `false`. One function for all kinds of work: threads are much code.
fn on_threads(threads: usize, take_one: &(dyn Fn() -> bool + Sync)) {
    let work = || {
        let alone = Context { threads: NonZero::<usize>::MIN, watch: None };
        alone.during(|| while take_one() {});
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            // Where no thread can be started, the others do its work.
            if std::thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn chunks_cover_everything_once() {
        for threads in [1, 2, 7] {
            let mut items = vec![0; 10_001];
            Task::new().threads(threads).run(|| {
                for_each_chunk(&mut items, 100, |first, chunk| {
                    chunk.iter_mut().enumerate().for_each(|(k, item)| *item += first + k);
                });
            });
            assert!(items.iter().enumerate().all(|(k, &item)| k == item));
        }
    }

    #[test]
    fn keeps_the_order() {
        for threads in [1, 2, 7] {
            Task::new().threads(threads).run(|| {
                assert!(map_indexed(0, |k| k).is_empty());
                for len in [1, 2, 13, 10_000] {
                    let found = map_indexed(len, |k| 3 * k);
                    assert!(found.iter().enumerate().all(|(k, &x)| x == 3 * k));
                }
            });
        }
    }

    #[test]
    fn no_more_threads_are_at_work_than_allowed() {
        let (now, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Task::new().threads(2).run(|| {
            map_indexed(200, |_| {
                most.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                // Work within work stays on its thread.
                map_indexed(3, |_| std::thread::yield_now());
                now.fetch_sub(1, Ordering::SeqCst);
            });
        });
        assert!(most.load(Ordering::SeqCst) <= 2);
    }

    #[test]
    fn who_watches_is_told_of_all_steps_and_may_cancel() {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let (told, is_tired) = (seen.clone(), Arc::new(AtomicBool::new(false)));
        let tired = is_tired.clone();
        let task = Task::new().watch(move |at| {
            told.lock().unwrap().push(at.done);
            if tired.load(Ordering::SeqCst) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let work = || {
            let mut steps = Steps::new("Working", 3)?;
            (0..3).try_for_each(|_| steps.step())
        };
        // A task within keeps who watches.
        assert_eq!(task.run(|| Task::new().threads(1).run(work)), Ok(()));
        assert_eq!(*seen.lock().unwrap(), [0, 1, 2, 3]);
        is_tired.store(true, Ordering::SeqCst);
        assert_eq!(task.run(work), Err(Cancelled));
        assert_eq!(work(), Ok(()), "outside nobody watches");
    }
}
