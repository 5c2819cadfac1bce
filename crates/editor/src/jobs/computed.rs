//! What jobs have made so far: their last results, and the model that they work on.

use std::sync::{Arc, Mutex};

use pliant_deform::{Bound, Ordering, ReusableFactor};
use pliant_mesh::{Joint, Model};

use super::bound_controls::BoundControls;
use super::carried::Carried;
use super::inspected::{Inspectable, Inspected};
use super::intersections::Intersections;
use super::job::{Pickable, Revision, ShownTriangles};
use super::region::{FileContacts, Region};
use crate::warning::HandleWarning;

/// The last results.
pub(crate) struct Computed {
    pub(crate) model: Option<Arc<Model>>,
    pub(crate) pickable: Option<Pickable>,
    /// The triangles that rays are to meet.
    pub(super) shown: ShownTriangles,
    /// One a power of the Laplacian that a method has asked for.
    pub(super) orderings: Vec<Arc<Ordering>>,
    pub(crate) region: Region,
    /// What the model's components touch.
    pub(super) contacts: FileContacts,
    pub(super) bound: Option<Arc<Mutex<Bound>>>,
    /// The binding's control points.
    pub(crate) controls: Option<BoundControls>,
    /// What a solve from a kept shape goes on from, with this factorisation.
    pub(super) carried: Option<Carried>,
    /// What of the binding can be looked at.
    pub(crate) inspectable: Inspectable,
    /// What of it is looked at.
    pub(crate) inspected: Inspected,
    /// What the next binding can take over of the last one.
    pub(super) reusable_factor: Option<ReusableFactor>,
    /// Of the limb under the pointer.
    pub(super) joint: Option<Arc<Joint>>,
    /// Where a shape passes through itself, and the shape's revision.
    pub(super) intersections: Option<(Revision, Intersections)>,
    /// About the last binding.
    pub(crate) warnings: Vec<HandleWarning>,
    /// About the targets of the last solve.
    pub(crate) blind_to: Vec<HandleWarning>,
    /// The examples' weights that the last solve took or found.
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
