//! A stroke of the brush on a large surface: jobs find the vertices under it.
//!
//! A brush that closes round limbs searches the ways from its middle over as much of the surface as it is wide. With a
//! large brush on half a million vertices that takes a tenth of a second, which would hold up the window at every move.
//! Each job searches a piece of the stroke. The pieces depend on the pointer alone, never on when their jobs come, and so
//! does what is painted.

use std::collections::VecDeque;

use glam::DVec2;
use pliant_mesh::{Cancel, SurfaceVertex};

use super::brush::{Brush, BrushMetric, BrushSize};
use super::context::Context;
use super::drawn_shape::DrawnShape;
use super::paint::PaintStroke;
use super::sought_stroke::{Change, Drawing, Outcome, SoughtStroke};
use super::stroke::StrokeGesture;
use crate::input::Pointer;
use crate::jobs::Enclosed;
use crate::workspace::Workspace;

/// The number of vertices from which on a surface is large.
const LARGE: usize = 100_000;

/// The length of a piece as a share of the brush's radius. Until it is complete nothing of it is painted.
const PIECE: f64 = 0.25;

/// A stroke on a large surface.
#[derive(Debug)]
pub(super) struct LargeStroke {
    /// Complete pieces that wait for the job of the one before.
    pieces: VecDeque<Piece>,
    /// The piece that grows, from the last one's end on.
    way_px: Vec<DVec2>,
    is_searching: bool,
    is_released: bool,
}

impl LargeStroke {
    /// Whether strokes of the chosen brush need jobs.
    pub(super) fn suits(context: &Context<'_>) -> bool {
        let is_along_surface = match context.settings.brush().metric {
            BrushMetric::Round | BrushMetric::Surface => true,
            BrushMetric::Screen | BrushMetric::Through => false,
        };
        let model = context.workspace.model();
        is_along_surface && model.is_some_and(|model| model.surface.positions.len() >= LARGE)
    }

    /// Begins a stroke with a first piece under the pointer.
    pub(super) fn begin(
        context: &mut Context<'_>,
        stroke: StrokeGesture<PaintStroke>,
        pointer: Pointer,
    ) -> SoughtStroke<Self> {
        let mut own = Self {
            pieces: VecDeque::new(),
            way_px: vec![pointer.position_px; 2],
            is_searching: false,
            is_released: false,
        };
        own.end_piece(context);
        SoughtStroke::new(stroke, own)
    }

    /// Completes the piece that grows.
    fn end_piece(&mut self, context: &mut Context<'_>) {
        let Some(&last_px) = self.way_px.last() else { return };
        let way_px = std::mem::replace(&mut self.way_px, vec![last_px]);
        self.pieces.extend(Piece::of(context, way_px));
        self.search(context.workspace);
    }

    /// Begins the next job, unless one runs.
    fn search(&mut self, workspace: &mut Workspace) {
        if self.is_searching {
            return;
        }
        if let Some(piece) = self.pieces.pop_front() {
            let work = Box::new(move |_: &_, cancel: &Cancel| {
                cancel.check()?;
                Ok(piece.vertices().into())
            });
            workspace.jobs.ask(|slots| &mut slots.enclose, work);
            self.is_searching = true;
        }
    }

    /// Paints, and ends if nothing is left to be found.
    fn painting(&self, change: Change) -> Outcome {
        match self.is_released && !self.is_searching {
            true => Outcome::Ends(change),
            false => Outcome::Paints(change),
        }
    }
}

impl Drawing for LargeStroke {
    fn status(&self) -> Option<String> {
        None
    }

    fn is_looking(&self) -> bool {
        self.is_released
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) {
        if self.way_px.last() == Some(&pointer.position_px) {
            return;
        }
        self.way_px.push(pointer.position_px);
        let lengths = self.way_px.windows(2).map(|ends| ends[0].distance(ends[1]));
        if lengths.sum::<f64>() >= PIECE * context.settings.brush().radius_px {
            self.end_piece(context);
        }
    }

    fn released(&mut self, context: &mut Context<'_>) -> Outcome {
        if self.way_px.len() > 1 {
            self.end_piece(context);
        }
        self.is_released = true;
        self.painting(Box::new(|_, _| {}))
    }

    fn found(&mut self, context: &mut Context<'_>, under: Enclosed) -> Outcome {
        self.is_searching = false;
        self.search(context.workspace);
        self.painting(Box::new(move |stroke, workspace| {
            stroke.take_new(workspace, under.vertices)
        }))
    }
}

/// A piece of a stroke, with all data of the search for the vertices under it.
struct Piece {
    shape: DrawnShape,
    way_px: Vec<DVec2>,
    size: BrushSize,
}

impl std::fmt::Debug for Piece {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.way_px.fmt(formatter)
    }
}

impl Piece {
    /// A piece on the drawn shape; `None` while its hierarchy is not ready.
    fn of(context: &Context<'_>, way_px: Vec<DVec2>) -> Option<Self> {
        Some(Self {
            shape: DrawnShape::of(context.workspace, context.view)?,
            way_px,
            size: context.settings.brush(),
        })
    }

    /// The vertices under the brush, ascending.
    fn vertices(&self) -> Vec<SurfaceVertex> {
        let mut found = Vec::new();
        let visit = |vertex, _| found.push(vertex);
        Brush::default().stroke(&self.shape.picking(), &self.way_px, &self.size, visit);
        found.sort_unstable();
        found.dedup();
        found
    }
}
