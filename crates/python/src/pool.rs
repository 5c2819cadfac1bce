//! The threads of long loops.

use std::mem;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::PyResult;
use pyo3::exceptions::PyRuntimeError;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool, and the number of its process.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// The process's pool: a thread for each processor, or as many as the variable `RAYON_NUM_THREADS` says.
///
/// Rayon's own global pool would hang in a process that Python's `multiprocessing` forked, because no thread lives on
/// there: such a process gets a pool of its own.
///
/// # Errors
/// `RuntimeError` if the system gives no threads.
pub fn pool() -> PyResult<Arc<ThreadPool>> {
    let own = process::id();
    let mut held = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((of, pool)) = &*held
        && *of == own
    {
        return Ok(Arc::clone(pool));
    }
    let pool = ThreadPoolBuilder::new().build().map_err(|error| {
        PyRuntimeError::new_err(format!(
            "the system can't start the threads ({error}): set RAYON_NUM_THREADS to fewer"
        ))
    })?;
    let pool = Arc::new(pool);
    // The threads of a pool from before a fork can't be ended: this process does not have them.
    mem::forget(held.replace((own, Arc::clone(&pool))));
    Ok(pool)
}
