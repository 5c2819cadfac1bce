//! The program's own directories: for settings, for the work of a session that ends without saving, and for pictures of
//! recent files.

use std::path::PathBuf;

/// The program's own folders; `None` if the system names none, and in tests, which must not use a person's.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct AppDirectories {
    /// The file of settings.
    pub settings: Option<PathBuf>,
    /// The folder of sessions that may need recovery, and of reports of faults.
    pub recovery: Option<PathBuf>,
    /// The folder of the small pictures of recent files.
    pub pictures: Option<PathBuf>,
}

impl AppDirectories {
    /// The person's own directories.
    pub fn of_user() -> Self {
        Self {
            settings: dirs::config_dir().map(|folder| folder.join("pliant").join("settings.json")),
            recovery: dirs::state_dir()
                .or_else(dirs::data_local_dir)
                .map(|folder| folder.join("pliant").join("recovery")),
            pictures: dirs::cache_dir().map(|folder| folder.join("pliant").join("pictures")),
        }
    }
}
