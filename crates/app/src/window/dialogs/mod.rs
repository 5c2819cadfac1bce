//! What opens over the window: questions, the palette, the list of keys, the log.

pub(in crate::window) mod keys_window;
pub(in crate::window) mod log;
pub(in crate::window) mod palette;
pub(in crate::window) mod question;
