//! The layers that open over the window: questions, the folder browser, the palette, the list of keys, the choice of
//! memory, the log, the version.

pub(in crate::window) mod about;
pub(in crate::window) mod file_dialog;
pub(in crate::window) mod folder_browser;
pub(in crate::window) mod keys_window;
pub(in crate::window) mod log;
pub(in crate::window) mod memory_window;
pub(in crate::window) mod palette;
pub(in crate::window) mod question;
mod system_dialog;
