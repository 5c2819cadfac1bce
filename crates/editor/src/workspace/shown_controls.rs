//! The control points that are shown: those of the selected handle's curve, or else of the method's cage or lattice.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::Attachment;

use super::state::Workspace;
use crate::document::{HandleCurve, HandleId};
use crate::jobs::BoundControls;

/// The segments of a shown curve between two of its control points.
const SEGMENTS: usize = 12;

/// Control points, at their visible positions, and the lines between them.
#[derive(Clone, Debug)]
pub(crate) struct ShownControls {
    pub(crate) positions: Arc<Vec<DVec3>>,
    pub(crate) lines: ShownLines,
    pub(crate) source: ControlSource,
}

/// The lines between control points.
#[derive(Clone, Debug)]
pub(crate) enum ShownLines {
    /// A curve, in segments.
    Curve(Vec<[DVec3; 2]>),
    /// The edges of a cage or lattice, each with its lower point first.
    Net(Arc<Vec<[u32; 2]>>),
}

/// The owner of control points.
#[derive(Clone, Debug)]
pub(crate) enum ControlSource {
    /// The method's cage or lattice, by its declared name.
    Attachment(&'static str, Attachment),
    /// A handle's curve, which the map moves to its visible place.
    Curve(HandleId, HandleCurve, DAffine3),
}

impl Workspace {
    /// The control points that are shown.
    pub(crate) fn shown_controls(&self) -> Option<ShownControls> {
        self.shown_curve().or_else(|| {
            let BoundControls {
                name,
                attachment,
                edges,
                positions,
            } = self.shown_attachment()?;
            Some(ShownControls {
                lines: ShownLines::Net(edges),
                positions,
                source: ControlSource::Attachment(name, attachment),
            })
        })
    }

    /// The curve of the selected handle.
    fn shown_curve(&self) -> Option<ShownControls> {
        let handle = self.selected().filter(|handle| handle.visible)?;
        let curve = handle.line.as_ref()?.curve()?;
        let then = handle.affine();
        let motion = curve.motion_at(self.document.strength());
        let moved = motion.moved();
        let place = |point: DVec3| then.transform_point3(point);
        let positions: Vec<DVec3> = moved.points().iter().copied().map(place).collect();
        let places = moved.point_places();
        let ends = places.iter().copied().zip(places.iter().copied().skip(1));
        let closing = moved.is_closed().then(|| (places[places.len() - 1], moved.length()));
        let lines = ends.chain(closing).flat_map(|(from, to)| {
            let at = move |step: usize| from + (to - from) * step as f64 / SEGMENTS as f64;
            (0..SEGMENTS).map(move |step| [at(step), at(step + 1)])
        });
        let lines = lines.map(|ends| ends.map(|at| place(moved.position(at))));
        Some(ShownControls {
            lines: ShownLines::Curve(lines.collect()),
            positions: Arc::new(positions),
            source: ControlSource::Curve(handle.id, curve.clone(), then),
        })
    }
}
