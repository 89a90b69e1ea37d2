//! A progress bar on stderr for work that takes more than a second.

use std::io::{IsTerminal, stderr};
use std::ops::ControlFlow;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use evenlight::task::Task;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How long the work may take before a bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that counts steps of work; it appears after [`PATIENCE`] and vanishes when dropped.
///
/// Nothing is ever drawn if stderr is not a terminal or the run is to be quiet.
pub struct Progress {
    bar: ProgressBar,
    /// The thread that waits to show the bar, and what ends its waiting when dropped.
    waiting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// A bar over `steps` steps.
    pub fn new(steps: usize, quiet: bool) -> Self {
        let wanted = !quiet && stderr().is_terminal();
        Self::on(wanted.then(ProgressDrawTarget::stderr), steps, PATIENCE)
    }

    fn on(target: Option<ProgressDrawTarget>, steps: usize, patience: Duration) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        bar.set_style(style());
        let waiting = target.map(|target| show_later(bar.clone(), target, patience));
        Self { bar, waiting }
    }

    /// Says what is being done from now on.
    pub fn stage(&self, name: impl Into<String>) {
        self.bar.set_message(name.into());
    }

    /// One step is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// Does work of the library, whose own stages and steps the bar shows meanwhile.
    pub fn show<T>(&self, work: impl FnOnce() -> T) -> T {
        let (done, total) = (self.bar.position(), self.bar.length().unwrap_or(0));
        let bar = self.bar.clone();
        let watched = Task::new().watch(move |at| {
            bar.set_message(at.stage);
            bar.set_length(at.total as u64);
            bar.set_position(at.done as u64);
            ControlFlow::Continue(())
        });
        let result = watched.run(work);
        self.bar.set_length(total);
        self.bar.set_position(done);
        result
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.waiting.take() {
            drop(end);
            // Whether it could draw does not matter: the work is done.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

/// Shows `bar` on `target` after `patience`, unless the sender is dropped before.
fn show_later(
    bar: ProgressBar,
    target: ProgressDrawTarget,
    patience: Duration,
) -> (Sender<()>, JoinHandle<()>) {
    let (sender, end) = channel();
    let thread = thread::spawn(move || {
        if end.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(target);
            bar.enable_steady_tick(Duration::from_millis(100));
        }
    });
    (sender, thread)
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{spinner} {msg} [{bar:30}] {pos}/{len} {elapsed}")
        .expect("the template is a constant")
        .progress_chars("=> ")
}

#[cfg(test)]
mod tests {
    use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
    use indicatif::InMemoryTerm;

    use super::*;

    fn on_screen(patience: Duration) -> (InMemoryTerm, Progress) {
        let screen = InMemoryTerm::new(5, 100);
        let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
        (screen, Progress::on(Some(target), 3, patience))
    }

    #[test]
    fn a_bar_appears_when_the_work_takes_long_and_vanishes_after_it() {
        let (screen, progress) = on_screen(Duration::from_millis(1));
        progress.stage("Thinking");
        progress.step();
        while !screen.contents().contains("1/3") {
            thread::sleep(Duration::from_millis(5));
        }
        assert!(screen.contents().contains("Thinking ["));
        drop(progress);
        assert_eq!(screen.contents(), "");
    }

    #[test]
    fn the_bar_shows_the_steps_of_the_library() {
        let (screen, progress) = on_screen(Duration::from_millis(1));
        let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]])).unwrap();
        let surface = Surface::build(cage, SurfaceOptions::default()).unwrap();
        progress.show(|| {
            evenlight::tessellate::tessellate(&surface, 2).unwrap();
            while !screen.contents().contains("Evaluating vertices [") {
                thread::sleep(Duration::from_millis(5));
            }
        });
        assert_eq!((progress.bar.position(), progress.bar.length()), (0, Some(3)));
    }

    #[test]
    fn nothing_is_drawn_for_short_work() {
        let (screen, progress) = on_screen(Duration::from_secs(3600));
        progress.stage("Thinking");
        progress.step();
        drop(progress);
        assert_eq!(screen.contents(), "");
    }

    #[test]
    fn quiet_means_no_bar() {
        assert!(Progress::new(3, true).waiting.is_none());
    }
}
