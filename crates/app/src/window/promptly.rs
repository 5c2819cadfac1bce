//! Threads for the window's own short loops.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

static THREADS: OnceLock<Option<ThreadPool>> = OnceLock::new();

/// Does `work` with its parallel loops on threads that no job has: on those that jobs share it would wait in line until
/// one of them comes to a pause, which has kept the window still for a third of a second.
pub fn promptly<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let threads = THREADS.get_or_init(|| {
        let builder = ThreadPoolBuilder::new().thread_name(|number| format!("window {number}"));
        builder.build().ok()
    });
    match threads {
        Some(threads) => threads.install(work),
        None => work(),
    }
}
