//! The widgets of panels and bars.

pub(in crate::window) mod command_button;
pub(in crate::window) mod default_button;
pub(in crate::window) mod icon;
pub(in crate::window) mod name_label;
pub(in crate::window) mod number_field;
pub(in crate::window) mod outbox;
pub(in crate::window) mod row_label;
pub(in crate::window) mod theme;
mod typed_number;
