//! The solve of a frame: the edit on the frame's own shape.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Budget, Ordering, Role, Solve, Target};
use pliant_editor::{BodyMotion, FollowedHandle, HandlePlace, Rest, SequenceTimeline, Setup, settle};
use pliant_mesh::{Model, Progress, Surface, SurfaceVertex};

use super::bent::{Bent, Unbent};
use super::held::{Held, HeldShapes, Shapes};
use super::leaders::Leaders;
use crate::EngineError;
use crate::binding::bind;
use crate::watch::Watch;

/// The data that all frames share.
pub(super) struct Bending<'a> {
    /// The first frame's model, whose topology all frames have.
    pub model: &'a Model,
    pub setup: &'a Setup,
    pub timeline: &'a SequenceTimeline,
    /// The fill-reducing ordering, if the method needs one: it depends on the topology alone.
    pub ordering: Option<&'a Ordering>,
    pub budget: Budget,
    /// The footprints of handles.
    pub footprints: &'a [Held],
    /// The shapes by which these hold frames.
    pub held_shapes: &'a HeldShapes<'a>,
    /// The vertices of each handle.
    pub handles: &'a [Vec<SurfaceVertex>],
    /// The motions of the whole body in all frames; none if its path is not bent.
    pub body: &'a [BodyMotion],
}

/// The vertices of each handle of a setup, ascending.
pub(super) fn vertices_of_handles(setup: &Setup) -> Vec<Vec<SurfaceVertex>> {
    let mut handles = vec![Vec::new(); setup.handles.len()];
    for (vertex, role) in (0..).zip(&setup.roles) {
        if let Role::Handle(handle) = role {
            handles[usize::from(*handle)].push(SurfaceVertex(vertex));
        }
    }
    handles
}

/// The place of a handle's vertices in a frame, whose surface is at `positions`.
pub(super) fn place(vertices: &[SurfaceVertex], first: &[DVec3], positions: &[DVec3]) -> HandlePlace {
    HandlePlace::of(&at(vertices, first), &at(vertices, positions))
}

/// The same with the handle's lowest coordinates there.
pub(super) fn followed(vertices: &[SurfaceVertex], first: &[DVec3], positions: &[DVec3]) -> FollowedHandle {
    FollowedHandle::of(&at(vertices, first), &at(vertices, positions))
}

fn at(vertices: &[SurfaceVertex], positions: &[DVec3]) -> Vec<DVec3> {
    vertices.iter().map(|vertex| positions[vertex.index()]).collect()
}

/// The maps of all targets, if each is one.
fn maps(targets: &[Target]) -> Option<Vec<DAffine3>> {
    let map = |target: &Target| match target {
        Target::Map(map) => Some(*map),
        Target::Places(_) | Target::Maps(_) => None,
    };
    targets.iter().map(map).collect()
}

impl Bending<'_> {
    /// The handles' targets in a frame whose surface is at `positions`; `None` if no handle moves.
    ///
    /// # Errors
    /// A frame that can't be read, by which a footprint holds this one.
    fn targets(&self, frame: usize, positions: &[DVec3], watch: &Watch) -> Result<Option<Vec<Target>>, EngineError> {
        let held = self.held_places(frame, positions, watch)?;
        if held.is_empty() && !self.timeline.reaches(frame) {
            return Ok(None);
        }
        let first = &self.model.surface.positions;
        let handles = self.handles.iter();
        let places: Vec<HandlePlace> = handles.map(|vertices| place(vertices, first, positions)).collect();
        let maps = self.timeline.maps_at(frame, &places);
        let is_moved = |(handle, places): &(usize, Vec<DVec3>)| {
            let now = self.handles[*handle].iter().map(|vertex| &positions[vertex.index()]);
            !now.eq(places)
        };
        if maps.is_none() && !held.iter().any(is_moved) {
            return Ok(None);
        }
        let maps = maps.unwrap_or_else(|| vec![DAffine3::IDENTITY; self.handles.len()]);
        let mut targets: Vec<Target> = maps.into_iter().map(Target::Map).collect();
        for (handle, places) in held {
            targets[handle] = Target::Places(places);
        }
        Ok(Some(targets))
    }

    /// The handles that footprints hold in a frame, by number, and the places of their vertices.
    ///
    /// # Errors
    /// A frame that can't be read, by which a footprint holds this one.
    fn held_places(
        &self,
        frame: usize,
        positions: &[DVec3],
        watch: &Watch,
    ) -> Result<Vec<(usize, Vec<DVec3>)>, EngineError> {
        let holding = self.footprints.iter().enumerate();
        let holding: Vec<(usize, &Held)> = holding.filter(|(_, own)| own.footprints.hold(frame)).collect();
        let mut known: BTreeMap<usize, Shapes> = BTreeMap::new();
        for needed in holding.iter().flat_map(|(_, own)| own.footprints.needed_in(frame)) {
            if let Entry::Vacant(entry) = known.entry(needed) {
                entry.insert(self.held_shapes.in_frame(needed, watch)?);
            }
        }
        let own_shapes = match holding.is_empty() {
            true => return Ok(Vec::new()),
            false => self.held_shapes.at(positions),
        };
        let places = |(number, own): (usize, &Held)| {
            let shape_in = |frame: usize| known.get(&frame).map(|shapes| &*shapes[number]);
            let places = own.footprints.places(frame, &own_shapes[number], shape_in, self.body)?;
            Some((own.handle, places))
        };
        Ok(holding.into_iter().filter_map(places).collect())
    }

    /// True if frames begin at the ends of leaders.
    pub fn is_led(&self) -> bool {
        self.setup.method.solve() != Solve::Direct
    }

    /// Solves a frame; `None` if nothing moves there. Its descent begins at the end of its leader, if `leaders` have it.
    ///
    /// # Errors
    /// A frame that can't be bound or solved, or one by which a footprint holds it and which can't be read;
    /// [`EngineError::Interrupted`].
    pub fn frame(&self, unbent: &Unbent<'_>, leaders: &Leaders, watch: &Watch) -> Result<Option<Bent>, EngineError> {
        let bent = match leaders.end(unbent.frame) {
            Some(bent) => Some(bent.clone()),
            None => self.bent(unbent, leaders.start(unbent.frame), watch)?,
        };
        let Some(motion) = self.body.get(unbent.frame).filter(|motion| motion.moves()) else {
            return Ok(bent);
        };
        let mut bent = bent.unwrap_or_else(|| Bent {
            displacements: vec![DVec3::ZERO; unbent.positions.len()],
            is_settled: true,
            warnings: Vec::new(),
        });
        let ways = bent.displacements.iter_mut().zip(unbent.positions);
        ways.for_each(|(way, position)| *way = motion.moved(*position + *way) - *position);
        Ok(Some(bent))
    }

    /// Bends a frame by its handles, without the body's path; `None` if none of them moves. A descent begins at the
    /// shape of `start`, if that is given, or at rest.
    ///
    /// # Errors
    /// Those of [`frame`](Self::frame).
    pub fn bent(&self, unbent: &Unbent<'_>, start: Option<&Bent>, watch: &Watch) -> Result<Option<Bent>, EngineError> {
        let Unbent { frame, file, positions } = *unbent;
        let Some(targets) = self.targets(frame, positions, watch)? else {
            return Ok(None);
        };
        let first = &self.model.surface.positions;
        let from_first: Vec<DVec3> = positions.iter().zip(first).map(|(own, first)| *own - *first).collect();
        let surface = Surface {
            positions: positions.to_vec(),
            triangles: self.model.surface.triangles.clone(),
        };
        let setup = Setup {
            rest: Some(Rest {
                displacements: Arc::new(from_first),
                surface: Arc::new(surface),
            }),
            ..self.setup.clone()
        };
        let cancel = &watch.cancel;
        let mut bound = bind(
            file,
            self.model,
            &setup,
            self.ordering,
            self.budget,
            (&Progress::new(), cancel),
        )?;
        bound.set_cancel(cancel);
        let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
        let bent = match maps(&targets) {
            Some(maps) => bound.set_targets(&maps),
            None => bound.set_places(&targets),
        };
        if let Some(start) = start {
            bound.begin_at(&start.displacements);
        }
        let bent = bent.and_then(|()| settle(&mut bound, &mut displacements, usize::MAX, cancel));
        let step = bent.map_err(|error| EngineError::Solve {
            file: file.to_owned(),
            source: error.renumbered(|vertex| self.model.first_file_vertex(SurfaceVertex(vertex)).0),
        })?;
        if cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        Ok(Some(Bent {
            displacements,
            is_settled: step.converged,
            warnings: setup.worded(bound.warnings()),
        }))
    }
}
