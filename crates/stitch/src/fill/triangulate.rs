//! The first triangles of a patch: the triangulation of least weight [Lie03].
//!
//! The weight of a triangulation is its largest angle between neighbouring triangles, including those outside the rim;
//! the least area decides among equal ones. W(i, j), the least weight of the polygon from point i to point j, is the
//! least of W(i, m), W(m, j) and the triangle (i, m, j) together, over all m between. This takes n³ / 6 steps, so a
//! polygon of more than [`MOST`] points is first cut in two ([`divide`](super::divide)).

use glam::DVec3;

use super::divide::best_chord;
use super::rim::Rim;

/// Longer polygons are cut in two: 150 points take 0.6 million steps.
const MOST: usize = 150;

/// Angles are compared in steps of this many radians, so that rounding does not decide between flat triangulations.
const ANGLE_STEP: f64 = 1e-4;

/// The triangles of least weight, counterclockwise; `None` if every triangulation would double an edge of the surface.
pub(crate) fn triangulate(rim: &Rim<'_>) -> Option<Vec<[u32; 3]>> {
    let mut triangles = Vec::new();
    let count = rim.points.len();
    let whole = Polygon {
        points: (0..count as u32).collect(),
        beyond: rim.beyond.iter().copied().map(Some).collect(),
    };
    let mut waiting = vec![whole];
    while let Some(polygon) = waiting.pop() {
        if polygon.points.len() > MOST
            && let Some(chord) = best_chord(rim, &polygon.points)
        {
            waiting.extend(polygon.cut(chord));
            continue;
        }
        triangles.extend(lightest(rim, &polygon)?);
    }
    Some(triangles)
}

/// A part of the rim's polygon.
struct Polygon {
    /// Points of the rim, in order.
    points: Vec<u32>,
    /// The third corner of the triangle beyond each edge, if it is known.
    beyond: Vec<Option<DVec3>>,
}

impl Polygon {
    /// The two parts on both sides of a chord between two places.
    fn cut(&self, [from, to]: [usize; 2]) -> [Self; 2] {
        let inner = Self {
            points: self.points[from..=to].to_vec(),
            beyond: self.beyond[from..to].iter().copied().chain([None]).collect(),
        };
        let around = |list: &[u32]| [&list[to..], &list[..=from]].concat();
        let beyond = [&self.beyond[to..], &self.beyond[..from]].concat();
        let outer = Self {
            points: around(&self.points),
            beyond: beyond.into_iter().chain([None]).collect(),
        };
        [inner, outer]
    }
}

/// The largest angle between triangles, in [`ANGLE_STEP`]s, and the area.
#[derive(Clone, Copy, Debug)]
struct Weight {
    angle: u32,
    area: f64,
}

impl Weight {
    const NOTHING: Self = Self { angle: 0, area: 0.0 };
    const IMPOSSIBLE: Self = Self {
        angle: u32::MAX,
        area: f64::INFINITY,
    };

    fn with(self, other: Self) -> Self {
        Self {
            angle: self.angle.max(other.angle),
            area: self.area + other.area,
        }
    }

    fn is_below(self, other: Self) -> bool {
        self.angle < other.angle || (self.angle == other.angle && self.area < other.area)
    }
}

/// The lightest triangulation of a polygon; `None` if there is none.
fn lightest(rim: &Rim<'_>, polygon: &Polygon) -> Option<Vec<[u32; 3]>> {
    let count = polygon.points.len();
    let point = |place: usize| rim.points[polygon.points[place] as usize];
    let at = |i: usize, j: usize| i * count + j;
    let mut weights = vec![Weight::NOTHING; count * count];
    let mut middles = vec![0_u32; count * count];
    // The third corner of the triangle inside an edge of the sub-polygon, or beyond an edge of the polygon.
    let third = |middles: &[u32], i: usize, j: usize| match j - i {
        1 => polygon.beyond[i],
        _ => Some(point(middles[at(i, j)] as usize)),
    };
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            let is_closing = i == 0 && j == count - 1;
            let mut best = Weight::IMPOSSIBLE;
            if is_closing || !rim.joined.contains(polygon.points[i], polygon.points[j]) {
                let (a, c) = (point(i), point(j));
                for m in i + 1..j {
                    let rest = weights[at(i, m)].with(weights[at(m, j)]);
                    if rest.angle > best.angle {
                        continue;
                    }
                    let b = point(m);
                    let own = (b - a).cross(c - a);
                    let mut angle = rest.angle;
                    for (from, to, other) in [(a, b, third(&middles, i, m)), (b, c, third(&middles, m, j))] {
                        angle = angle.max(other.map_or(0, |other| bend(own, from, to, other)));
                    }
                    if is_closing {
                        let other = polygon.beyond[count - 1];
                        angle = angle.max(other.map_or(0, |other| bend(own, c, a, other)));
                    }
                    let area = rest.area + 0.5 * own.length();
                    let weight = Weight { angle, area };
                    if weight.is_below(best) {
                        best = weight;
                        middles[at(i, j)] = m as u32;
                    }
                }
            }
            weights[at(i, j)] = best;
        }
    }
    if weights[at(0, count - 1)].area.is_infinite() {
        return None;
    }
    let mut triangles = Vec::with_capacity(count.saturating_sub(2));
    let mut waiting = vec![(0, count - 1)];
    while let Some((i, j)) = waiting.pop() {
        if j - i > 1 {
            let m = middles[at(i, j)] as usize;
            triangles.push([i, m, j].map(|place| polygon.points[place]));
            waiting.extend([(i, m), (m, j)]);
        }
    }
    Some(triangles)
}

/// The angle between a triangle with this normal at its edge and the triangle of this edge and `other`, which is on the
/// edge's right side, in [`ANGLE_STEP`]s: 0 if they are in one plane. A triangle without area counts as folded.
fn bend(normal: DVec3, from: DVec3, to: DVec3, other: DVec3) -> u32 {
    let beside = (other - from).cross(to - from);
    let lengths = normal.length() * beside.length();
    let cosine = if lengths > 0.0 {
        normal.dot(beside) / lengths
    } else {
        -1.0
    };
    (cosine.clamp(-1.0, 1.0).acos() / ANGLE_STEP).round() as u32
}
