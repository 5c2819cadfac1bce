//! Long work without Python's lock, so that other threads run on, and which Ctrl-C stops.

use std::panic;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pliant_mesh::Cancel;
use pyo3::{PyResult, Python};
use rayon::ThreadPool;

use crate::pool::pool;

/// How often Python is asked whether a signal has come.
const PATIENCE: Duration = Duration::from_millis(50);

/// Runs a short job without Python's lock. It gets the pool for its loops, and is not on it: a lock that it takes must
/// not be held on the pool, where a thread that waits for a loop's end may begin another job.
///
/// # Errors
/// Where there are no threads.
pub fn detached<T: Send>(py: Python<'_>, job: impl FnOnce(&ThreadPool) -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    Ok(py.detach(|| job(&pool)))
}

/// Runs a long job in a thread of its own, without Python's lock; like [`detached`] it gets the pool. Meanwhile Python's
/// main thread sees signals: Ctrl-C raises the flag that the job gets, and once the job has ended its exception goes on.
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
                // Whoever waits is there until this thread ends.
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
