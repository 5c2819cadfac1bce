//! The work of each job, as a closure that owns its data. `solving` has the one that bends.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{BindError, Problem};
use pliant_mesh::{Bvh, Damage, Model, SurfaceVertex};

use super::allowance::Allowance;
use super::computed::Computed;
use super::intersections::Intersections;
use super::present_binding::PresentBinding;
use super::slot::{Unfinished, Work};
use crate::Setup;
use crate::document::Document;
use crate::pickable::Pickable;
use crate::region::{Region, RegionInput};

/// This many pairs of triangles are enough to show the places.
const MOST_PAIRS: usize = 20_000;

/// Measures the region.
pub(super) fn region_work(input: RegionInput) -> Option<Work<Region>> {
    Some(Box::new(move |_, cancel| Ok(Region::measure(&input, cancel)?)))
}

/// Builds or refits the hierarchy for rays.
pub(super) fn pick_work(computed: &Computed, model: &Arc<Model>, document: &Document) -> Option<Work<Pickable>> {
    let (model, displacements, shown) = (
        Arc::clone(model),
        Arc::clone(&document.from_file),
        computed.shown.clone(),
    );
    let is_of_shown = |pickable: &&Pickable| pickable.shown.revision == shown.revision;
    let bvh = computed
        .pickable()
        .filter(is_of_shown)
        .map(|pickable| pickable.bvh.clone());
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let surface = &model.surface;
        let mut bvh = bvh.unwrap_or_else(|| match &shown.triangles {
            None => Bvh::build(&surface.positions, &surface.triangles),
            Some(shown) => {
                let triangles = shown.iter().map(|&triangle| surface.triangles[triangle as usize]);
                Bvh::build(&surface.positions, &triangles.collect::<Vec<_>>())
            }
        });
        bvh.refit(|vertex| surface.positions[vertex.index()] + displacements[vertex.index()]);
        Ok(Pickable { bvh, shown })
    }))
}

/// Factorises; `None` while the ordering that the method needs is missing.
pub(super) fn bind_work(
    computed: &Computed,
    model: &Arc<Model>,
    document: &Document,
    revision: u64,
    allowance: Allowance,
) -> Option<Work<Box<PresentBinding>>> {
    let ordering = match document.method.ordering_power() {
        Some(power) => Some(computed.ordering(power)?),
        None => None,
    };
    let (model, document, region) = (Arc::clone(model), document.clone(), computed.region.clone());
    let reusable_factor = computed.slots.bind.last().and_then(|last| last.reusable_factor.clone());
    Some(Box::new(move |progress, cancel| {
        let setup = Setup::of_document(&document, &region, &model.surface);
        let problem = Problem {
            revision,
            ..setup.problem(&model)
        };
        let (ordering, reusable_factor) = (ordering.as_deref(), reusable_factor.as_ref());
        match problem.rebind_within(ordering, reusable_factor, allowance.budget(), progress, cancel) {
            Ok(bound) => Ok(Box::new(PresentBinding::of(
                bound,
                &region.handles,
                setup.lines.clone(),
            ))),
            Err(BindError::Cancelled(cancelled)) => Err(cancelled.into()),
            Err(error) => Err(Unfinished::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            )),
        }
    }))
}

/// Searches the hierarchy for rays, which has the shown triangles, and checks all triangles and edges.
pub(super) fn intersect_work(
    computed: &Computed,
    model: &Arc<Model>,
    displacements: &Arc<Vec<DVec3>>,
) -> Option<Work<Intersections>> {
    let (bvh, model) = (computed.pickable()?.bvh.clone(), Arc::clone(model));
    let displacements = Arc::clone(displacements);
    Some(Box::new(move |progress, cancel| {
        let (surface, topology) = (&model.surface, &model.topology);
        let found = bvh.new_self_intersections(surface, topology, MOST_PAIRS, progress, cancel)?;
        let moved = surface.positions.iter().zip(displacements.iter());
        let deformed: Vec<DVec3> = moved.map(|(rest, displacement)| *rest + *displacement).collect();
        let damage = Damage::of(surface, topology, &deformed);
        Ok(Intersections::of(&found, damage))
    }))
}
