//! A frame before and after it is bent.

use std::path::Path;

use glam::DVec3;

/// A frame to be bent.
#[derive(Clone, Copy)]
pub(super) struct Unbent<'a> {
    pub frame: usize,
    /// Its file, for messages.
    pub file: &'a Path,
    /// The positions of its surface.
    pub positions: &'a [DVec3],
}

/// The result of a frame.
#[derive(Clone)]
pub(super) struct Bent {
    /// The displacement of each surface vertex from its place in the frame.
    pub displacements: Vec<DVec3>,
    pub is_settled: bool,
    pub warnings: Vec<String>,
}
