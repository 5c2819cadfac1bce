//! Colours with a meaning.

/// Region colours for [`crate::Surface::update_regions`], as in the figures of \[BS08\]: grey is fixed, blue is free,
/// gold is the handle.
pub mod region {
    /// Fixed vertices.
    pub const FIXED: [u8; 4] = [156, 154, 151, 255];
    /// Free vertices.
    pub const FREE: [u8; 4] = [120, 153, 204, 255];
    /// Handle vertices.
    pub const HANDLE: [u8; 4] = [232, 184, 84, 255];
}

/// Colours of [`crate::Borders::On`].
pub mod border {
    /// A boundary edge: it belongs to one triangle.
    pub const OPEN: [u8; 4] = [64, 208, 232, 255];
    /// A non-manifold edge: it belongs to more than two triangles.
    pub const BRANCHING: [u8; 4] = [240, 84, 160, 255];
}
