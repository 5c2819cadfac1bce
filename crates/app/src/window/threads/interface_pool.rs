//! Threads for the parallel loops of the window's own thread.

use rayon::ThreadPoolBuilder;

/// Gives the calling thread its own thread pool: from now on all its parallel loops run there. On the pool that jobs
/// share, a loop waits until a job pauses, which froze the window for a third of a second.
pub fn install() {
    if is_installed() {
        return;
    }
    let builder = ThreadPoolBuilder::new().use_current_thread();
    // If the system gives no threads, loops run on the shared pool.
    if let Ok(pool) = builder.thread_name(|number| format!("window {number}")).build() {
        // It ends with the thread.
        std::mem::forget(pool);
    }
}

/// Returns true if the calling thread has threads of its own.
pub fn is_installed() -> bool {
    rayon::current_thread_index().is_some()
}
