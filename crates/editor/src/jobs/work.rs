//! The work of each job, as a closure that owns its data. `solving` has the one that bends.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{BindError, Ordering, Problem};
use pliant_mesh::{Bvh, Damage, Model, SurfaceVertex};

use super::allowance::Allowance;
use super::computed::Computed;
use super::inspected::Inspectable;
use super::intersections::Intersections;
use super::job::{JobOutcome, Work};
use crate::Setup;
use crate::document::Document;
use crate::pickable::Pickable;
use crate::region::{Region, RegionInput};

/// This many pairs of triangles are enough to show the places.
const MOST_PAIRS: usize = 20_000;

/// Makes the ordering for a power of the Laplacian.
pub(super) fn order_work(model: &Arc<Model>, power: u32) -> Option<Work> {
    let model = Arc::clone(model);
    Some(Box::new(move |progress, cancel| {
        match Ordering::of(&model.topology, power, progress, cancel) {
            Ok(ordering) => JobOutcome::Ordered(Arc::new(ordering)),
            Err(_) => JobOutcome::Cancelled,
        }
    }))
}

/// Measures the region.
pub(super) fn region_work(input: RegionInput) -> Option<Work> {
    Some(Box::new(move |_, cancel| match Region::measure(&input, cancel) {
        Ok(region) => JobOutcome::Region(region),
        Err(_) => JobOutcome::Cancelled,
    }))
}

/// Builds or refits the hierarchy for rays.
pub(super) fn pick_work(computed: &Computed, model: &Arc<Model>, document: &Document) -> Option<Work> {
    let (model, displacements, shown) = (
        Arc::clone(model),
        Arc::clone(&document.from_file),
        computed.shown.clone(),
    );
    let is_of_shown = |pickable: &&Pickable| pickable.shown.revision == shown.revision;
    let bvh = computed
        .pickable
        .as_ref()
        .filter(is_of_shown)
        .map(|pickable| pickable.bvh.clone());
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let surface = &model.surface;
        let mut bvh = bvh.unwrap_or_else(|| match &shown.triangles {
            None => Bvh::build(&surface.positions, &surface.triangles),
            Some(shown) => {
                let triangles = shown.iter().map(|&triangle| surface.triangles[triangle as usize]);
                Bvh::build(&surface.positions, &triangles.collect::<Vec<_>>())
            }
        });
        bvh.refit(|vertex| surface.positions[vertex.index()] + displacements[vertex.index()]);
        JobOutcome::Pick(Pickable { bvh, shown })
    }))
}

/// Factorises; `None` while the ordering that the method needs is missing.
pub(super) fn bind_work(
    computed: &Computed,
    model: &Arc<Model>,
    document: &Document,
    revision: u64,
    allowance: Allowance,
) -> Option<Work> {
    let ordering = match document.method.ordering_power() {
        Some(power) => Some(computed.ordering(power)?),
        None => None,
    };
    let (model, document, region) = (Arc::clone(model), document.clone(), computed.region.clone());
    let reusable_factor = computed.reusable_factor.clone();
    Some(Box::new(move |progress, cancel| {
        let setup = Setup::of_document(&document, &region);
        let problem = Problem {
            revision,
            ..setup.problem(&model)
        };
        let (ordering, reusable_factor) = (ordering.as_deref(), reusable_factor.as_ref());
        match problem.rebind_within(ordering, reusable_factor, allowance.budget(), progress, cancel) {
            Ok(bound) => {
                let inspectable = Inspectable::of(&bound);
                JobOutcome::Bound(Box::new(bound), inspectable)
            }
            Err(BindError::Cancelled(_)) => JobOutcome::Cancelled,
            Err(error) => JobOutcome::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            ),
        }
    }))
}

/// Searches the hierarchy for rays, which has the shown triangles, and checks all triangles and edges.
pub(super) fn intersect_work(computed: &Computed, model: &Arc<Model>, displacements: &Arc<Vec<DVec3>>) -> Option<Work> {
    let (bvh, model) = (computed.pickable.as_ref()?.bvh.clone(), Arc::clone(model));
    let displacements = Arc::clone(displacements);
    Some(Box::new(move |progress, cancel| {
        let (surface, topology) = (&model.surface, &model.topology);
        let Ok(found) = bvh.new_self_intersections(surface, topology, MOST_PAIRS, progress, cancel) else {
            return JobOutcome::Cancelled;
        };
        let moved = surface.positions.iter().zip(displacements.iter());
        let deformed: Vec<DVec3> = moved.map(|(rest, displacement)| *rest + *displacement).collect();
        let damage = Damage::of(surface, topology, &deformed);
        JobOutcome::Intersections(Intersections::of(&found, damage))
    }))
}
