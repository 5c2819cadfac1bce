//! Work on other threads, and the return of its results.

pub(in crate::window) mod interface_pool;
pub(in crate::window) mod message;
pub(in crate::window) mod workers;
