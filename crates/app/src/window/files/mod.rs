//! Files in the window: opening, saving, projects, settings, recovery of unsaved work.

pub(in crate::window) mod actions;
pub(in crate::window) mod app_directories;
pub(in crate::window) mod file_command;
pub(in crate::window) mod names;
mod opening;
pub(crate) mod original;
pub(in crate::window) mod project_file;
pub(in crate::window) mod recovery;
pub(in crate::window) mod rest_mesh;
pub(in crate::window) mod save_request;
pub(in crate::window) mod save_wish;
pub(in crate::window) mod saves;
pub(in crate::window) mod session;
pub(in crate::window) mod settings;
pub(in crate::window) mod writing;
