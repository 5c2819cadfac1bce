//! The drawing of a cage or a lattice over the surface: its edges as lines and its points as squares of constant size
//! on the screen. The renderer fades the parts that the surface hides; the back of a cage or lattice is grey and faint.

use glam::{DVec2, DVec3};

use super::camera::Camera;

/// Lines and triangles of one colour, in world space.
#[derive(Clone, PartialEq, Debug)]
pub struct ControlShape {
    /// sRGB with alpha.
    pub colour: [u8; 4],
    /// Line segments.
    pub lines: Vec<[DVec3; 2]>,
    /// Filled triangles.
    pub triangles: Vec<[DVec3; 3]>,
    /// The share of its opacity where a surface hides it, from 0 to 1.
    pub hidden_share: f32,
}

impl ControlShape {
    /// Line segments of one colour.
    pub(crate) fn lines(colour: [u8; 4], lines: Vec<[DVec3; 2]>) -> Self {
        Self {
            colour,
            lines,
            triangles: Vec::new(),
            hidden_share: HIDDEN_SHARE,
        }
    }

    /// Filled triangles of one colour.
    pub(crate) fn filled(colour: [u8; 4], triangles: Vec<[DVec3; 3]>) -> Self {
        Self {
            triangles,
            ..Self::lines(colour, Vec::new())
        }
    }

    /// The same with another share of its opacity where a surface hides it.
    pub(crate) fn with_hidden_share(self, hidden_share: f32) -> Self {
        Self { hidden_share, ..self }
    }
}

/// The usual share of a shape's opacity where a surface hides it.
const HIDDEN_SHARE: f32 = 0.35;

/// A visible control point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ShownPoint {
    pub(crate) position: DVec3,
    pub(crate) is_selected: bool,
    pub(crate) is_pinned: bool,
    pub(crate) is_hidden: bool,
    /// True at the back of a cage or lattice.
    pub(crate) is_back: bool,
    pub(crate) is_pointed_at: bool,
}

/// The lines between control points, in world space.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum ControlLines {
    /// A curve.
    Curve(Vec<[DVec3; 2]>),
    /// A cage or lattice: the edges that are turned to the eye, and those at its back.
    Net {
        front: Vec<[DVec3; 2]>,
        back: Vec<[DVec3; 2]>,
    },
}

impl ControlLines {
    pub(crate) fn is_curve(&self) -> bool {
        matches!(self, Self::Curve(_))
    }
}

impl ShownPoint {
    /// Returns true if its square covers a point of the viewport.
    pub(crate) fn covers(&self, position_px: DVec2, camera: &Camera, viewport_px: DVec2) -> bool {
        let at_px = camera.project(self.position, viewport_px);
        at_px.is_some_and(|at_px| (at_px - position_px).abs().max_element() <= 1.4 * HALF_PX + RIM_PX)
    }
}

/// Blue, orange and near-black are distinct from clay, from each other and from both themes' grounds.
const EDGE: [u8; 4] = [58, 128, 220, 220];
const BACK_EDGE: [u8; 4] = [128, 134, 144, 80];
const BACK_POINT: [u8; 4] = [150, 156, 166, 150];
const CURVE: [u8; 4] = [255, 214, 110, 255];
const CURVE_HIDDEN_SHARE: f32 = 0.75;
const POINT: [u8; 4] = [120, 180, 255, 255];
const SELECTED: [u8; 4] = [255, 150, 30, 255];
const RIM: [u8; 4] = [18, 24, 36, 255];
const PIN: [u8; 4] = [250, 250, 250, 255];

/// Half the side of a point's square, and the width of its rim, in points of the view.
const HALF_PX: f64 = 3.6;
const RIM_PX: f64 = 1.3;

/// The width of the frame around a pinned point.
const PIN_PX: f64 = 3.2;

/// The pointer's distance to a point within which it takes the point.
pub(crate) const GRAB_PX: f64 = 8.0;

/// The same of a curve's points, which are far apart: a press beside one would draw another line.
const CURVE_GRAB_PX: f64 = 18.0;

/// The shapes: edges at the back and in front, the frames of pinned points, the points' rims, points at the back and in
/// front, and selected ones. A curve inside a limb is visible through it.
pub(crate) fn control_shapes(
    points: &[ShownPoint],
    lines: ControlLines,
    camera: &Camera,
    viewport_px: DVec2,
) -> Vec<ControlShape> {
    let squares = |colour, beyond: f64, wanted: &dyn Fn(&&ShownPoint) -> bool| {
        let wanted = points.iter().filter(wanted);
        let squares = wanted.flat_map(|point| {
            let half = if point.is_pointed_at { 1.4 * HALF_PX } else { HALF_PX };
            square(point.position, half + beyond, camera, viewport_px)
        });
        ControlShape::filled(colour, squares.collect())
    };
    let (colour, hidden_share, lines, back) = match lines {
        ControlLines::Curve(lines) => (CURVE, CURVE_HIDDEN_SHARE, lines, Vec::new()),
        ControlLines::Net { front, back } => (EDGE, HIDDEN_SHARE, front, back),
    };
    // A point that is taken or about to be is as clear at the back as in front.
    let is_faint = |point: &ShownPoint| point.is_back && !point.is_selected && !point.is_pointed_at;
    let shapes = [
        ControlShape::lines(BACK_EDGE, back),
        ControlShape::lines(colour, lines),
        squares(PIN, PIN_PX, &|point| point.is_pinned),
        squares(RIM, RIM_PX, &|point| !is_faint(point)),
        squares(BACK_POINT, 0.0, &|point| is_faint(point)),
        squares(POINT, 0.0, &|point| !point.is_selected && !is_faint(point)),
        squares(SELECTED, 0.0, &|point| point.is_selected),
    ];
    shapes.map(|shape| shape.with_hidden_share(hidden_share)).to_vec()
}

/// A square across the line of sight.
fn square(position: DVec3, half_px: f64, camera: &Camera, viewport_px: DVec2) -> [[DVec3; 3]; 2] {
    let half = half_px * camera.world_per_px(position, viewport_px);
    let axes = camera.axes();
    let (right, up) = (axes.x_axis * half, axes.y_axis * half);
    let [a, b, c, d] = [-right - up, right - up, right + up, up - right].map(|corner| position + corner);
    [[a, b, c], [a, c, d]]
}

/// The point under the pointer: of those near it a visible one in front, and of these the nearest to the eye; of a
/// curve's points the nearest to the pointer.
pub(crate) fn control_at(
    points: &[ShownPoint],
    is_curve: bool,
    pointer_px: DVec2,
    camera: &Camera,
    viewport_px: DVec2,
) -> Option<u32> {
    let near = points.iter().enumerate().filter_map(|(number, point)| {
        let distance_px = camera.project(point.position, viewport_px)?.distance(pointer_px);
        let (reach_px, rank) = match is_curve {
            true => (CURVE_GRAB_PX, distance_px),
            false => (GRAB_PX, (point.position - camera.eye()).length()),
        };
        let is_behind = !is_curve && (point.is_hidden || point.is_back);
        (distance_px <= reach_px).then_some((is_behind, rank, number as u32))
    });
    let first = near.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    first.map(|(_, _, number)| number)
}
