//! What menus, buttons, keys and the command palette can ask for: commands are data.
//!
//! Everything about a command stands in one entry of its room's file: how menus list it, what it concerns, when it can
//! be done and why not, what it does. Here each command is bound to its entry; one without an entry does not compile.

mod controls;
mod document;
mod entry;
mod examples;
mod handle;
mod key_map;
mod look;
mod object;
mod paint;
mod pose;
mod region;
mod shortcut;
mod table;
mod transform;
mod view;

pub(crate) use entry::{Scope, State};
pub use examples::WITHOUT_EXAMPLES;
pub use key_map::KeyMap;
pub use shortcut::Shortcut;
pub use table::{Command, Listed};
pub(crate) use view::frame_all;
