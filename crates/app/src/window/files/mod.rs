//! Files in the window: opening, saving, projects, settings, recovery of unsaved work.

pub(in crate::window) mod app_directories;
pub(in crate::window) mod desktop;
pub(in crate::window) mod in_file;
pub(in crate::window) mod listing;
pub(in crate::window) mod other_shape;
pub(in crate::window) mod project_file;
pub(in crate::window) mod recovery;
pub(in crate::window) mod rest_mesh;
pub(in crate::window) mod save_request;
pub(in crate::window) mod save_wish;
pub(in crate::window) mod settings;
pub(in crate::window) mod small_pictures;
pub(in crate::window) mod writing;
mod written_frames;
