//! The graphics device: opening it, errors, buffers, reading back, and timing.

pub(crate) mod bindings;
pub(crate) mod buffers;
pub(crate) mod error;
pub(crate) mod guard;
pub(crate) mod opening;
pub(crate) mod readback;
pub(crate) mod timer;
