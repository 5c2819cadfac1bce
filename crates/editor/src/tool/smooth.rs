//! A stroke with Shift: the borders between regions are smoothed where the brush goes.

use std::collections::BTreeMap;

use glam::DVec2;
use pliant_mesh::{SurfaceVertex, Topology};

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use super::paint::lay;
use crate::document::{Paint, Transaction};
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::scene_view::Cursor;
use crate::view::View;
use crate::workspace::{Workspace, tidy_handles};

/// A stroke that goes on.
#[derive(Debug)]
pub(crate) struct SmoothStroke {
    transaction: Transaction,
    last_px: DVec2,
}

impl SmoothStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer) -> Self {
        let mut stroke = Self {
            transaction: context.workspace.begin_stroke("Smooth regions"),
            last_px: pointer.position_px,
        };
        stroke.dab(context, pointer.position_px);
        stroke
    }

    fn dab(&mut self, context: &mut Context<'_>, to_px: DVec2) {
        let mut met: Vec<SurfaceVertex> = Vec::new();
        if let Some(picking) = context.workspace.picking(context.view) {
            let size = &context.settings.brush;
            context
                .brush
                .stroke(&picking, self.last_px, to_px, size, |vertex, _| met.push(vertex));
        }
        self.last_px = to_px;
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

/// What more than half of a vertex' neighbours are painted with, if the vertex is not.
fn outvoted(vertex: SurfaceVertex, paint: &[Paint], topology: &Topology) -> Option<Paint> {
    let own = paint[vertex.index()];
    let neighbours = topology.neighbours(vertex);
    let of = |neighbour: &SurfaceVertex| paint[neighbour.index()];
    let others = neighbours.iter().map(of).filter(|other| *other != own);
    others
        .into_iter()
        .find(|other| 2 * neighbours.iter().filter(|v| of(v) == *other).count() > neighbours.len())
}

impl Gesture for SmoothStroke {
    fn activity(&self) -> Activity {
        Activity::Painting
    }

    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    fn lit(&self) -> Lit {
        Lit::Ring
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some("Smoothing the borders of regions: Esc takes it back".to_owned())
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        self.dab(context, pointer.position_px);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        if pointer.position_px != self.last_px {
            self.dab(context, pointer.position_px);
        }
        tidy_handles(context.workspace, self.transaction.before());
        context.workspace.commit(&self.transaction);
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}
