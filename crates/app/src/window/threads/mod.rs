//! Work on other threads, and the return of its results.

pub(in crate::window) mod arrivals;
pub(in crate::window) mod interface_pool;
pub(in crate::window) mod message;
pub(in crate::window) mod pose_queue;
pub(in crate::window) mod workers;
