//! The Laplacian as a bi-Laplacian of order 1.

use crate::bilaplacian::loaded::LoadedSystem;
use crate::{Bilaplacian, BilaplacianOrder};

/// −L as a bi-Laplacian of order 1.
pub(crate) fn membrane() -> Bilaplacian {
    Bilaplacian {
        order: BilaplacianOrder::Membrane,
        ..Bilaplacian::default()
    }
}

/// k in A = −k L, also a factor of loads.
pub(crate) fn stiffness_of(system: &LoadedSystem) -> f64 {
    system.operator().stretching + system.operator().bending
}
