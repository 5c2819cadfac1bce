//! The last results of jobs, and their model.

use std::sync::{Arc, Mutex};

use pliant_deform::{Bound, Ordering, ReusableFactor};
use pliant_mesh::{Cancel, Joint, Model};

use super::bound_controls::BoundControls;
use super::carried::Carried;
use super::inspected::{Inspectable, Inspected};
use super::intersections::Intersections;
use crate::pickable::{Pickable, ShownTriangles};
use crate::region::{FileContacts, Region};
use crate::revision::Revision;
use crate::warning::HandleWarning;

/// The last results.
pub(crate) struct Computed {
    pub(crate) model: Option<Arc<Model>>,
    pub(crate) pickable: Option<Pickable>,
    /// The triangles for rays.
    pub(super) shown: ShownTriangles,
    /// One ordering per power of the Laplacian that a method has asked for.
    pub(super) orderings: Vec<Arc<Ordering>>,
    pub(crate) region: Region,
    /// The contacts of the model's components.
    pub(super) contacts: FileContacts,
    pub(super) bound: Option<Arc<Mutex<Bound>>>,
    /// The binding's control points.
    pub(crate) controls: Option<BoundControls>,
    /// Raised when newer targets wait, so that a solve for the older ones takes no long steps.
    pub(super) newer_targets: Cancel,
    /// The state from which a solve with a kept shape continues, with this factorisation.
    pub(super) carried: Option<Carried>,
    /// The parts of the binding that can be shown.
    pub(crate) inspectable: Inspectable,
    /// The shown parts of it.
    pub(crate) inspected: Inspected,
    /// The parts of the last binding that the next one can reuse.
    pub(super) reusable_factor: Option<ReusableFactor>,
    /// The joint of the limb under the pointer.
    pub(super) joint: Option<Arc<Joint>>,
    /// The places where a shape passes through itself, and the shape's revision.
    pub(super) intersections: Option<(Revision, Intersections)>,
    /// Warnings about the last binding.
    pub(crate) warnings: Vec<HandleWarning>,
    /// Warnings about the targets of the last solve.
    pub(crate) blind_to: Vec<HandleWarning>,
    /// The examples' weights that the last solve used or found.
    pub(crate) example_weights: Vec<f64>,
}

impl Default for Computed {
    fn default() -> Self {
        Self {
            model: None,
            pickable: None,
            shown: ShownTriangles::default(),
            orderings: Vec::new(),
            region: Region::still(0),
            contacts: FileContacts::default(),
            bound: None,
            controls: None,
            newer_targets: Cancel::new(),
            carried: None,
            inspectable: Inspectable::default(),
            inspected: Inspected::default(),
            reusable_factor: None,
            joint: None,
            intersections: None,
            warnings: Vec::new(),
            blind_to: Vec::new(),
            example_weights: Vec::new(),
        }
    }
}

impl Computed {
    /// The ordering for a power of the Laplacian, if it was made.
    pub(super) fn ordering(&self, power: u32) -> Option<Arc<Ordering>> {
        let mut orderings = self.orderings.iter();
        orderings.find(|ordering| ordering.power() == power).cloned()
    }
}
