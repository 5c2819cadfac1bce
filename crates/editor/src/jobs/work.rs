//! The work of each job, as a closure that owns its data. `solving` has the one that bends.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{BindError, Ordering, Problem, ReusableFactor};
use pliant_mesh::{Bvh, Cancel, Damage, Model, Progress, SurfaceVertex};

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

/// The input of a binding.
pub(super) struct BindInput {
    model: Arc<Model>,
    document: Document,
    region: Region,
    ordering: Option<Arc<Ordering>>,
    reusable_factor: Option<ReusableFactor>,
    revision: u64,
    allowance: Allowance,
}

impl BindInput {
    /// That of the document, with the region that was measured last; `None` while the ordering that the method needs is
    /// missing.
    pub(super) fn of(
        computed: &Computed,
        model: &Arc<Model>,
        document: &Document,
        revision: u64,
        allowance: Allowance,
    ) -> Option<Self> {
        let ordering = match document.method.ordering_power() {
            Some(power) => Some(computed.ordering(power)?),
            None => None,
        };
        Some(Self {
            model: Arc::clone(model),
            document: document.clone(),
            region: computed.region.clone(),
            ordering,
            reusable_factor: computed.slots.bind.last().and_then(|last| last.reusable_factor.clone()),
            revision,
            allowance,
        })
    }

    /// The same of the document in another frame of its sequence, in which the same vertices may move.
    pub(super) fn of_document(&self, document: Document) -> Self {
        let rest = document.applied.then(|| document.rest.as_slice());
        Self {
            model: Arc::clone(&self.model),
            region: self.region.on(&self.model.surface, rest),
            document,
            ordering: self.ordering.clone(),
            reusable_factor: None,
            revision: self.revision,
            allowance: self.allowance,
        }
    }

    /// Factorises.
    pub(super) fn bind(&self, progress: &Progress, cancel: &Cancel) -> Result<PresentBinding, Unfinished> {
        let (model, region) = (&self.model, &self.region);
        let setup = Setup::of_document(&self.document, region, &model.surface);
        if let Some((number, why)) = setup.lines.refused() {
            let name = &setup.handles[*number].name;
            return Err(Unfinished::Failed(format!("The crease of {name} {why}.")));
        }
        let problem = Problem {
            revision: self.revision,
            ..setup.problem(model)
        };
        let (ordering, reusable_factor) = (self.ordering.as_deref(), self.reusable_factor.as_ref());
        match problem.rebind_within(ordering, reusable_factor, self.allowance.budget(), progress, cancel) {
            Ok(bound) => Ok(PresentBinding::of(bound, &region.handles, setup.lines.clone())),
            Err(BindError::Cancelled(cancelled)) => Err(cancelled.into()),
            Err(error) => Err(Unfinished::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            )),
        }
    }
}

/// Factorises; `None` while the ordering that the method needs is missing.
pub(super) fn bind_work(
    computed: &Computed,
    model: &Arc<Model>,
    document: &Document,
    revision: u64,
    allowance: Allowance,
) -> Option<Work<Box<PresentBinding>>> {
    let input = BindInput::of(computed, model, document, revision, allowance)?;
    Some(Box::new(move |progress, cancel| {
        input.bind(progress, cancel).map(Box::new)
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
