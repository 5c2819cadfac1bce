//! A stroke with Shift: it smooths the borders between regions under the brush.

use std::collections::BTreeMap;

use glam::DVec2;
use pliant_mesh::{SurfaceVertex, Topology};

use super::context::Context;
use super::paint::lay;
use super::stroke::{Stroke, StrokeGesture, meet};
use crate::document::{Document, Paint};
use crate::input::Pointer;
use crate::workspace::{Workspace, tidy_handles};

/// The stroke's action.
#[derive(Debug)]
pub(super) struct SmoothStroke;

impl SmoothStroke {
    pub fn begin(context: &mut Context<'_>, pointer: Pointer) -> StrokeGesture<Self> {
        let transaction = context.workspace.begin_stroke("Smooth regions");
        StrokeGesture::begin(context, transaction, Self, pointer)
    }
}

impl Stroke for SmoothStroke {
    fn doing(&self, _: &Workspace) -> String {
        "Smoothing the borders of regions".to_owned()
    }

    fn finish(&mut self, workspace: &mut Workspace, before: &Document) {
        tidy_handles(workspace, before);
    }

    fn dab(&mut self, context: &mut Context<'_>, _: &Document, way_px: [DVec2; 2]) {
        let mut met: Vec<SurfaceVertex> = Vec::new();
        meet(context, way_px, |vertex, _| met.push(vertex));
        let workspace = &mut *context.workspace;
        if let Some(sides) = workspace.both_sides().cloned() {
            met.extend(sides.opposite(met.clone()));
        }
        met.sort_unstable();
        met.dedup();
        let Some(model) = workspace.model().cloned() else {
            return;
        };
        let mut changes: BTreeMap<Paint, Vec<SurfaceVertex>> = BTreeMap::new();
        for vertex in met {
            if let Some(paint) = outvoted(vertex, workspace.document.paint(), &model.topology) {
                changes.entry(paint).or_default().push(vertex);
            }
        }
        for (paint, vertices) in changes {
            lay(workspace, vertices, paint);
        }
    }
}

/// The paint of more than half of a vertex' neighbours, if the vertex differs.
fn outvoted(vertex: SurfaceVertex, paint: &[Paint], topology: &Topology) -> Option<Paint> {
    let own = paint[vertex.index()];
    let neighbours = topology.neighbours(vertex);
    let of = |neighbour: &SurfaceVertex| paint[neighbour.index()];
    let others = neighbours.iter().map(of).filter(|other| *other != own);
    others
        .into_iter()
        .find(|other| 2 * neighbours.iter().filter(|v| of(v) == *other).count() > neighbours.len())
}
