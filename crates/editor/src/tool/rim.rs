//! The rim of a hole under the pointer, which a click takes.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex};

use crate::view::{ControlShape, View};
use crate::workspace::{Workspace, held_parts};

/// The use of the rim that the next click takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RimUse {
    /// Its hole is filled.
    Fill,
    /// It is bridged with another one.
    Bridge {
        /// A vertex of the first one, once that was taken.
        first: Option<SurfaceVertex>,
    },
    /// It has a place of a pair, of which several are picked before borders are joined there.
    Merge {
        /// The first place of the present pair, once that was taken.
        first: Option<SurfaceVertex>,
    },
}

impl RimUse {
    /// The vertex of the first of two rims, once that was taken.
    pub fn first(self) -> Option<SurfaceVertex> {
        match self {
            Self::Fill => None,
            Self::Bridge { first } | Self::Merge { first } => first,
        }
    }
}

/// A rim under the pointer.
#[derive(Clone, PartialEq, Debug)]
pub struct PointedRim {
    /// The vertex nearest to the pointer.
    pub vertex: SurfaceVertex,
    /// Its length in the present shape, in world units.
    pub length: f64,
    /// The present positions of its vertices, in order.
    pub line: Vec<DVec3>,
}

impl PointedRim {
    /// The number of its edges.
    pub fn edges(&self) -> usize {
        self.line.len()
    }
}

/// The pointer takes a rim that is no further away, in points.
const NEAR_PX: f64 = 40.0;

/// A visible vertex counts before a hidden one of its rim, such as one across the opening, that is nearer to the pointer
/// by at most this, in points.
const BEHIND_PX: f64 = 12.0;

/// An orange that differs from clay and handles.
const POINTED: [u8; 4] = [255, 150, 40, 255];
/// The first of two rims, in blue.
const TAKEN: [u8; 4] = [58, 128, 220, 255];
/// The other rims.
const OTHERS: [u8; 4] = [255, 150, 40, 130];

/// The rims of a mesh, found once.
#[derive(Debug, Default)]
pub(super) struct Rims {
    of: Option<Arc<Model>>,
    loops: Vec<Vec<SurfaceVertex>>,
    /// The use for which `offered` was found.
    wanted: Option<RimUse>,
    /// For each rim, whether a click may take it.
    offered: Vec<bool>,
}

impl Rims {
    /// Finds the rims of the open mesh, or forgets them if no rim is wanted.
    pub(super) fn follow(&mut self, workspace: &Workspace, wanted: Option<RimUse>) {
        let model = workspace.model().filter(|_| wanted.is_some());
        let is_same = match (&self.of, model) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            (before, now) => before.is_none() && now.is_none(),
        };
        if !is_same {
            self.loops = model.map_or_else(Vec::new, |model| model.topology.boundary_loops());
            self.of = model.cloned();
        }
        if !is_same || self.wanted != wanted {
            self.wanted = wanted;
            self.offered = match wanted.zip(model) {
                Some((wanted, model)) => self.offered(workspace, wanted, model),
                None => Vec::new(),
            };
        }
    }

    /// A second rim is another one than the first; for a merge, it is on the other side.
    fn offered(&self, workspace: &Workspace, wanted: RimUse, model: &Model) -> Vec<bool> {
        let Some(first) = wanted.first() else {
            return vec![true; self.loops.len()];
        };
        let held = held_parts(workspace);
        let is_held = |vertex: SurfaceVertex| held.contains(&model.topology.component(vertex));
        let may_follow = |rim: &Vec<SurfaceVertex>| match wanted {
            RimUse::Merge { .. } => rim.first().is_some_and(|vertex| is_held(*vertex) != is_held(first)),
            RimUse::Bridge { .. } | RimUse::Fill => !rim.contains(&first),
        };
        self.loops.iter().map(may_follow).collect()
    }

    /// The rim nearest to the pointer that a click may take, if it is near, and its vertex there; visible ones first.
    pub(super) fn pointed(&self, workspace: &Workspace, view: &View, pointer_px: DVec2) -> Option<PointedRim> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let picking = workspace.picking(view);
        let is_seen = |vertex: SurfaceVertex| {
            let position = workspace.position(vertex);
            let eye = camera
                .project(position, viewport_px)
                .map(|px| camera.ray(px, viewport_px).origin);
            let sight = picking.as_ref().zip(eye);
            sight.is_some_and(|(picking, eye)| picking.is_seen(vertex, position, eye))
        };
        // The vertex of each rim that is near, with whether it is hidden.
        let mut near: Vec<(bool, f64, usize, SurfaceVertex)> = Vec::new();
        let loops = self.loops.iter().enumerate();
        for (number, vertices) in loops.filter(|(number, _)| self.offered[*number]) {
            let far = |&vertex| {
                let px = camera
                    .project(workspace.position(vertex), viewport_px)?
                    .distance(pointer_px);
                (px <= NEAR_PX).then_some((px, vertex))
            };
            let mut own: Vec<(f64, SurfaceVertex)> = vertices.iter().filter_map(far).collect();
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            let Some(&nearest) = own.first() else { continue };
            let mut beside = own.iter().take_while(|(px, _)| *px <= nearest.0 + BEHIND_PX);
            let seen = beside.find(|(_, vertex)| is_seen(*vertex));
            let (px, vertex) = *seen.unwrap_or(&nearest);
            near.push((seen.is_none(), px, number, vertex));
        }
        near.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let &(_, _, number, vertex) = near.first()?;
        let line = self.line(workspace, number);
        let next = line.iter().cycle().skip(1);
        Some(PointedRim {
            vertex,
            length: line.iter().zip(next).map(|(from, to)| from.distance(*to)).sum(),
            line,
        })
    }

    fn line(&self, workspace: &Workspace, number: usize) -> Vec<DVec3> {
        let vertices = self.loops[number].iter();
        vertices.map(|&vertex| workspace.position(vertex)).collect()
    }

    /// All rims, the one under the pointer brighter, and the first of two in its own colour.
    pub(super) fn shapes(
        &self,
        workspace: &Workspace,
        view: &View,
        wanted: Option<RimUse>,
        pointed: Option<&PointedRim>,
    ) -> Vec<ControlShape> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        // They are moved towards the eye, so that the surface beside them does not hide them.
        let lifted = |point: DVec3| point + camera.towards_eye(point) * camera.world_per_px(point, viewport_px);
        let closed = |line: &[DVec3]| -> Vec<[DVec3; 2]> {
            let next = line.iter().cycle().skip(1);
            line.iter().zip(next).map(|(a, b)| [lifted(*a), lifted(*b)]).collect()
        };
        let mut shapes = Vec::new();
        let mut others = Vec::new();
        for (number, vertices) in self.loops.iter().enumerate() {
            let line = closed(&self.line(workspace, number));
            match wanted.and_then(RimUse::first) {
                Some(first) if vertices.contains(&first) => shapes.push(ControlShape::lines(TAKEN, line)),
                _ => others.extend(line),
            }
        }
        if !others.is_empty() {
            shapes.push(ControlShape::lines(OTHERS, others));
        }
        shapes.extend(pointed.map(|rim| ControlShape::lines(POINTED, closed(&rim.line))));
        shapes
    }
}
