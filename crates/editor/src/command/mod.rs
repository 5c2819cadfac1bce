//! The commands of menus, buttons, keys and the command palette. Commands are data.
//!
//! One entry in a group's file has everything about a command: its form in menus, its scope, the condition for
//! executing it with the reason if it fails, and its effect. Here each command is bound to its entry; a command without
//! an entry does not compile.

mod animation;
mod controls;
mod curves;
mod document;
mod entry;
mod examples;
mod flow;
mod handle;
mod held_part;
mod key_map;
mod look;
mod mesh;
mod new_keys;
mod object;
mod paint;
mod pose;
mod region;
mod shortcut;
mod table;
mod transform;
mod view;
mod ways;

pub(crate) use entry::{Scope, State};
pub use examples::WITHOUT_EXAMPLES;
pub use key_map::KeyMap;
pub use shortcut::Shortcut;
pub use table::{Command, Listed};
pub(crate) use view::frame_all;
