//! Colours that mean something.

/// Region colours for [`crate::Surface::update_regions`], as in the survey's figures: grey is held, blue is free,
/// gold is the handle.
pub mod region {
    /// Held where it is.
    pub const FIXED: [u8; 4] = [150, 150, 150, 255];
    /// Follows.
    pub const FREE: [u8; 4] = [112, 150, 204, 255];
    /// Is moved by hand.
    pub const HANDLE: [u8; 4] = [236, 184, 62, 255];
}
