//! Threads for the parallel loops of the window's own thread.

use rayon::ThreadPoolBuilder;

/// Gives the thread that calls it threads of its own: from now on its parallel loops run on those, whoever wrote them.
/// On those that jobs share a loop waits in line until one of them comes to a pause, which has kept the window still
/// for a third of a second.
pub fn install() {
    if is_installed() {
        return;
    }
    let builder = ThreadPoolBuilder::new().use_current_thread();
    // Where the system gives no threads, loops wait in line as everybody's do.
    if let Ok(pool) = builder.thread_name(|number| format!("window {number}")).build() {
        // It goes with the thread.
        std::mem::forget(pool);
    }
}

/// Whether the thread that calls it has threads of its own.
pub fn is_installed() -> bool {
    rayon::current_thread_index().is_some()
}
