//! The shapes of other moments around the shown one.

use std::sync::{Arc, Mutex};

use glam::DVec3;
use pliant_deform::Bound;

use crate::revision::Revision;

/// The shape of another moment.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Its place: -1 is the nearest before the shown moment, 1 the nearest after it.
    pub place: i8,
    /// The displacements from the file's shape, per surface vertex.
    pub from_file: Arc<Vec<DVec3>>,
}

/// The shapes of the moments around the shown one.
#[derive(Default)]
pub struct Skinned {
    /// By their moments.
    pub(super) skins: Vec<Skin>,
    /// The own factorisation of an iterative method, and the revision of the binding that it repeats: the descent of the
    /// shown shape continues from its last step, so the one of other moments must not disturb it.
    pub(super) own: Option<(Revision, Arc<Mutex<Bound>>)>,
}
