//! Long work without Python's lock: other threads run meanwhile, and Ctrl-C stops it.

use std::panic;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pliant_mesh::Cancel;
use pyo3::{PyResult, Python};
use rayon::ThreadPool;

use crate::pool::pool;

/// The interval between checks for signals.
const PATIENCE: Duration = Duration::from_millis(50);

/// Runs a short job without Python's lock. It gets the pool for its loops, and is not on it: a lock that it takes must
/// not be held on the pool, where a thread that waits for a loop's end may begin another job.
///
/// # Errors
/// If there are no threads.
pub fn detached<T: Send>(py: Python<'_>, job: impl FnOnce(&ThreadPool) -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    Ok(py.detach(|| job(&pool)))
}

/// Runs a long job in its own thread, without Python's lock; like [`detached`] it gets the pool. Meanwhile Python's
/// main thread checks signals: Ctrl-C sets the job's flag, and the exception is raised after the job has ended.
///
/// # Errors
/// The exception of a signal's handler, `KeyboardInterrupt` by default.
pub fn interruptible<T: Send>(py: Python<'_>, job: impl FnOnce(&ThreadPool, &Cancel) -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    let cancel = Cancel::new();
    py.detach(|| {
        thread::scope(|scope| {
            let (done, is_done) = channel();
            let (pool, flag) = (&*pool, &cancel);
            let worker = scope.spawn(move || {
                let result = job(pool, flag);
                // The receiver lives until this thread ends.
                let _ = done.send(());
                result
            });
            let mut heard = Ok(());
            while let Err(RecvTimeoutError::Timeout) = is_done.recv_timeout(PATIENCE) {
                if heard.is_ok() {
                    heard = Python::attach(|py| py.check_signals());
                    if heard.is_err() {
                        cancel.cancel();
                    }
                }
            }
            match worker.join() {
                Ok(result) => heard.map(|()| result),
                Err(panicked) => panic::resume_unwind(panicked),
            }
        })
    })
}
