//! The window's own file dialog, if the system has none: folders with sizes and dates, places for quick access, a path
//! that completes itself. `egui_file` reads folders on the window's thread and knows neither sizes, dates, completion
//! nor recent places, and `egui-file-dialog` has no version for this egui.
//!
//! [`FolderBrowser`] has the state, a worker reads the folders ([`listing`]), and [`view`] draws.

mod browser;
mod row;
#[cfg(test)]
mod tests;
mod typed_path;
pub(in crate::window) mod view;

pub(in crate::window) use browser::{Asked, FolderBrowser, Place};
