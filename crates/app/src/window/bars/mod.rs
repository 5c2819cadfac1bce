//! What frames the view: menus above, tools at the left, what is shown over the view, the status below; the first steps
//! and what became of a request over its corners.

pub(in crate::window) mod hints;
pub(in crate::window) mod status;
pub(in crate::window) mod toast;
pub(in crate::window) mod tool_column;
pub(in crate::window) mod top_bar;
pub(in crate::window) mod view_bar;
