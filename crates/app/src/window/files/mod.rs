//! Files in the window: opening, saving, projects, settings, unsaved work that is recovered.

pub(in crate::window) mod actions;
pub(in crate::window) mod app_directories;
pub(in crate::window) mod file_command;
pub(in crate::window) mod names;
mod opening;
pub(in crate::window) mod project_file;
pub(in crate::window) mod recovery;
pub(in crate::window) mod session;
pub(in crate::window) mod settings;
mod writing;
