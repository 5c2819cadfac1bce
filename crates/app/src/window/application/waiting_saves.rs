//! Saves that wait for the shape, for a decision, or for each other.

use crate::window::dialogs::question::Then;
use crate::window::files::save_request::SaveRequest;
use crate::window::files::save_wish::SaveWish;

/// The saves that have not begun, and what follows them.
#[derive(Default)]
pub struct WaitingSaves {
    /// The action after the end of the save that comes first.
    pub then: Option<Then>,
    /// The saves that wait until the shape has settled.
    pub wishes: Vec<SaveWish>,
    /// The save that was held back because another program has changed the file, until the person decides.
    pub unwritten: Option<Box<SaveRequest>>,
}
