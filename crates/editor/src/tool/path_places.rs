//! The path of a sequence's body over the view: its place on the ground in every frame.

use glam::{DVec2, DVec3};

use crate::view::{ControlLines, ControlShape, GRAB_PX, ShownPoint, View, control_shapes, distance_to_segment};
use crate::workspace::Workspace;

/// The body's own way under a bent one.
const OWN: [u8; 4] = [255, 255, 255, 110];

/// The shown frame's place is taken before another one that is nearer to the pointer by at most this, in points.
const BEHIND_PX: f64 = 2.0;

/// The places of the body on the ground, in the space of the shown frame.
pub(super) struct PathPlaces {
    /// On the bent path, frame by frame.
    bent: Vec<DVec3>,
    /// On its own way, if that is another.
    own: Vec<DVec3>,
    /// The frames at which the path is moved.
    moved: Vec<usize>,
    shown: usize,
}

impl PathPlaces {
    /// `None` if the path is not shown, or not known yet.
    pub(super) fn of(workspace: &Workspace, view: &View) -> Option<Self> {
        let animation = workspace.document.animation();
        animation.frames()?;
        if !(view.look.timeline && view.look.path) {
            return None;
        }
        let (way, up) = (workspace.body_way(), workspace.path_up(view.camera().up));
        let own = way.own()?;
        let body = view.body();
        let seen = |place: DVec3| body.before(way.on_ground(place, up));
        Some(Self {
            bent: (0..own.len()).filter_map(|frame| way.bent(frame).map(seen)).collect(),
            own: own.iter().copied().filter(|_| way.is_bent()).map(seen).collect(),
            moved: animation
                .path()
                .map_or_else(Vec::new, |path| path.shifts().map(|(frame, _)| frame).collect()),
            shown: animation.frame(),
        })
    }

    /// The frame under a point of the viewport: the shown one, one at which the path is moved, or another.
    pub(super) fn at(&self, px: DVec2, view: &View) -> Option<usize> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let at = |place: &DVec3| camera.project(*place, viewport_px);
        let marked = self.moved.iter().chain([&self.shown]);
        let distances = marked.filter_map(|frame| {
            let distance = at(self.bent.get(*frame)?)?.distance(px);
            let handicap = if *frame == self.shown { 0.0 } else { BEHIND_PX };
            (distance <= GRAB_PX).then_some((distance + handicap, *frame))
        });
        if let Some((_, frame)) = distances.min_by(|a, b| a.0.total_cmp(&b.0)) {
            return Some(frame);
        }
        let places: Vec<Option<DVec2>> = self.bent.iter().map(at).collect();
        let pieces = places.windows(2).enumerate().filter_map(|(frame, ends)| {
            let (from, to) = (ends[0]?, ends[1]?);
            let nearer = usize::from(to.distance(px) < from.distance(px));
            Some((distance_to_segment(px, from, to), frame + nearer))
        });
        let nearest = pieces.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest
            .filter(|(distance, _)| *distance <= GRAB_PX)
            .map(|(_, frame)| frame)
    }

    /// The own way, the bent one over it, and the places at which it is moved; the shown frame's has another colour.
    pub(super) fn shapes(&self, pointed: Option<usize>, view: &View) -> Vec<ControlShape> {
        let lines = |places: &[DVec3]| places.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        let mut marked: Vec<usize> = self.moved.iter().copied().chain([self.shown]).chain(pointed).collect();
        marked.sort_unstable();
        marked.dedup();
        let point = |frame: usize| {
            Some(ShownPoint {
                position: *self.bent.get(frame)?,
                is_selected: frame == self.shown,
                is_pinned: false,
                is_hidden: false,
                is_back: false,
                is_pointed_at: Some(frame) == pointed,
            })
        };
        let points: Vec<ShownPoint> = marked.into_iter().filter_map(point).collect();
        let bent = ControlLines::Curve(lines(&self.bent));
        let bent = control_shapes(&points, bent, view.camera(), view.viewport_px());
        std::iter::once(ControlShape::lines(OWN, lines(&self.own)))
            .chain(bent)
            .collect()
    }
}
