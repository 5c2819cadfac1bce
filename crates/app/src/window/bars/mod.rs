//! The frame of the view: menus above, tools at the left, the choices of the view and the tool's settings over it, the
//! status below; the first steps and the results of requests over its corners.

mod flow_settings;
pub(in crate::window) mod hints;
mod menu_keys;
pub(in crate::window) mod recent_menu;
mod share_slider;
pub(in crate::window) mod status;
pub(in crate::window) mod timeline;
pub(in crate::window) mod toast;
pub(in crate::window) mod tool_column;
pub(in crate::window) mod tool_settings;
pub(in crate::window) mod top_bar;
pub(in crate::window) mod view_bar;
pub(in crate::window) mod work_pose;
