//! Colours that mean something.

/// Region colours for [`crate::Surface::update_regions`], as in the survey's figures: grey is held, blue is free,
/// gold is the handle.
pub mod region {
    /// Held where it is.
    pub const FIXED: [u8; 4] = [156, 154, 151, 255];
    /// Follows.
    pub const FREE: [u8; 4] = [120, 153, 204, 255];
    /// Is moved by hand.
    pub const HANDLE: [u8; 4] = [232, 184, 84, 255];
}

/// Colours of [`crate::Borders::On`].
pub mod border {
    /// An edge that one triangle has.
    pub const OPEN: [u8; 4] = [64, 208, 232, 255];
    /// An edge that more than two triangles have.
    pub const BRANCHING: [u8; 4] = [240, 84, 160, 255];
}
