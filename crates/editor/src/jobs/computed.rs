//! The last results of jobs, and their model.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Ordering;
use pliant_mesh::{Cancel, Joint, Model};

use super::bound_controls::BoundControls;
use super::inspected::Inspectable;
use super::intersections::Intersections;
use super::table::Slots;
use crate::bending::Carried;
use crate::document::{Aspect, Document, Version};
use crate::pickable::{Pickable, ShownTriangles};
use crate::region::{FileContacts, Region};
use crate::revision::Revision;
use crate::warning::HandleWarning;

/// The last results.
pub(crate) struct Computed {
    pub(crate) model: Option<Arc<Model>>,
    pub(crate) slots: Slots,
    /// The triangles for rays.
    pub(super) shown: ShownTriangles,
    /// One ordering per power of the Laplacian that a method has asked for, which serves the present region.
    pub(super) orderings: Vec<Arc<Ordering>>,
    /// The region, from the beginning on.
    pub(crate) region: Region,
    /// The contacts of the model's components.
    pub(crate) contacts: FileContacts,
    /// The targets for which the binding's control points have their positions.
    pub(super) controls_revision: Revision,
    /// Raised when newer targets wait, so that a solve for the older ones takes no long steps.
    pub(super) newer_targets: Cancel,
    /// The state from which a solve with a kept shape continues, with this factorisation.
    pub(super) carried: Option<Carried>,
    /// The version of the targets whose solve begins anew: where every frame of an animation begins.
    pub(super) anew: Option<Version>,
    /// Warnings about the targets of the last solve.
    pub(super) blind_to: Vec<HandleWarning>,
    /// The examples' weights that the last solve used or found.
    pub(crate) example_weights: Vec<f64>,
}

impl Default for Computed {
    fn default() -> Self {
        Self {
            model: None,
            slots: Slots::default(),
            shown: ShownTriangles::default(),
            orderings: Vec::new(),
            region: Region::still(0),
            contacts: FileContacts::default(),
            controls_revision: Revision(0),
            newer_targets: Cancel::new(),
            carried: None,
            anew: None,
            blind_to: Vec::new(),
            example_weights: Vec::new(),
        }
    }
}

impl Computed {
    /// Whether the solve for the document's targets begins anew.
    pub(super) fn solves_anew(&self, document: &Document) -> bool {
        self.anew == Some(document.versions().of(Aspect::Targets))
    }

    /// The ordering for a power of the Laplacian, if it was made.
    pub(super) fn ordering(&self, power: u32) -> Option<Arc<Ordering>> {
        let mut orderings = self.orderings.iter();
        orderings.find(|ordering| ordering.power() == power).cloned()
    }

    /// The data that answer rays.
    pub(crate) fn pickable(&self) -> Option<&Pickable> {
        self.slots.pick.last()
    }

    /// The last binding's control points.
    pub(crate) fn controls(&self) -> Option<&BoundControls> {
        self.slots.bind.last()?.controls.as_ref()
    }

    /// The parts of the last binding that can be shown.
    pub(crate) fn inspectable(&self) -> Inspectable {
        let binding = self.slots.bind.last();
        binding.map_or(Inspectable::default(), |binding| binding.inspectable)
    }

    /// The shown handle's weight at each surface vertex, from 0 to 1.
    pub(crate) fn weights(&self) -> Option<&Arc<Vec<f64>>> {
        self.slots.inspect.last()?.weights.as_ref()
    }

    /// The shown smooth base, as displacements of the surface's vertices from the file's shape.
    pub(crate) fn base(&self) -> Option<&Arc<Vec<DVec3>>> {
        self.slots.inspect.last()?.base.as_ref()
    }

    /// The last joint that was found.
    pub(crate) fn joint(&self) -> Option<&Arc<Joint>> {
        self.slots.joint.last()?.as_ref().map(|limb| &limb.joint)
    }

    /// The joints between that and the limb's tip, if they were asked for.
    pub(crate) fn inner_joints(&self) -> &[Arc<Joint>] {
        let limb = self.slots.joint.last().and_then(Option::as_ref);
        limb.map_or(&[], |limb| &limb.inner)
    }

    /// The places where the present shape passes through itself; `None` before the search.
    pub(crate) fn intersections(&self) -> Option<&Intersections> {
        self.slots.intersect.current()
    }

    /// Warnings about the last binding, and about the targets of the last solve.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = &HandleWarning> {
        let binding = self.slots.bind.last();
        let of_binding = binding.map_or(&[][..], |binding| &binding.warnings);
        of_binding.iter().chain(&self.blind_to)
    }
}
