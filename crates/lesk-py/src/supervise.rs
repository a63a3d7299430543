//! Long work in a thread of its own, while Python's thread looks after signals and progress.

use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How often Python's thread looks for Ctrl-C and reports progress.
const TICK: Duration = Duration::from_millis(50);

/// What the work and Python's thread share.
pub struct Shared<P> {
    stop: AtomicBool,
    latest: Mutex<Option<P>>,
}

impl<P> Shared<P> {
    /// Tells how far the work is.
    pub fn report(&self, progress: P) {
        *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
    }

    /// Whether the work shall stop.
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Runs `work` in another thread and `progress` in this one, without the interpreter's lock in between. Gives the result
/// of the work, and what Python raised meanwhile.
pub fn supervise<T: Send, P: Copy + Send>(
    work: impl FnOnce(&Shared<P>) -> T + Send,
    mut progress: impl FnMut(Python<'_>, P) -> PyResult<()>,
) -> (T, Option<PyErr>) {
    let shared = Shared { stop: AtomicBool::new(false), latest: Mutex::new(None) };
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        let shared = &shared;
        let worker = scope.spawn(move || {
            let result = work(shared);
            // nobody waits where Python raised
            let _ = sender.send(());
            result
        });
        let mut raised = None;
        while receiver.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
            if raised.is_some() {
                continue;
            }
            let now = *shared.latest.lock().unwrap_or_else(PoisonError::into_inner);
            let attended = Python::attach(|py| {
                py.check_signals()?;
                now.map_or(Ok(()), |now| progress(py, now))
            });
            if let Err(error) = attended {
                raised = Some(error);
                shared.stop.store(true, Ordering::Relaxed);
            }
        }
        match worker.join() {
            Ok(result) => (result, raised),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}
