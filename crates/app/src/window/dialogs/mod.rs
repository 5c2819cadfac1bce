//! The layers that open over the window: questions, the folder browser, the palette, the list of keys, the choice of
//! memory, the options of a merge, the log, the version.

pub(in crate::window) mod about;
pub(in crate::window) mod file_dialog;
pub(in crate::window) mod folder_browser;
pub(in crate::window) mod keys_window;
pub(in crate::window) mod log;
pub(in crate::window) mod memory_window;
pub(in crate::window) mod merge_window;
pub(in crate::window) mod palette;
pub(in crate::window) mod question;
mod system_dialog;

use self::about::About;
use self::keys_window::KeysWindow;
use self::log::Log;
use self::memory_window::MemoryWindow;
use self::merge_window::MergeWindow;
use self::palette::Palette;
use self::question::Question;

/// The layers, open or not.
#[derive(Default)]
pub(in crate::window) struct Dialogs {
    pub palette: Option<Palette>,
    pub log: Log,
    pub keys: KeysWindow,
    pub memory: MemoryWindow,
    pub merge: MergeWindow,
    pub about: About,
    pub question: Option<Question>,
}
