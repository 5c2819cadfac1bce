//! What frames the window: menus above, the status below, the first steps.

pub(in crate::window) mod hints;
pub(in crate::window) mod status;
pub(in crate::window) mod top_bar;
