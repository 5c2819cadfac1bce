//! What frames the view: menus above, the status below; the first steps and what became of a request over its corners.

pub(in crate::window) mod hints;
pub(in crate::window) mod status;
pub(in crate::window) mod toast;
pub(in crate::window) mod top_bar;
