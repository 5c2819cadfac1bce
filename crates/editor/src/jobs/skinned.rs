//! The shapes of the moments around the shown one, as their job finds them.

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
    pub(super) skins: Vec<Skin>,
    /// The factorisation of the binding with this revision: the descent of an iterative method continues from its last
    /// step, so it gets one of its own here.
    pub(super) own: Option<(Revision, Arc<Mutex<Bound>>)>,
}
