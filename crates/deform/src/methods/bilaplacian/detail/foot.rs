//! The foot of a point: the nearest point of the base from which the point is seen along the base's normal
//! [BS08, equation 9; KVS99].
//!
//! The normals of vertices are interpolated over the triangles, so the feet of a surface are a continuous map to the
//! base. The search begins with the point's own vertex of the base, so it stays on its side of a thin part. It walks
//! down to the nearest point, from triangle to neighbouring triangle, and from there solves p = b(u, v) + h n(u, v) by
//! Newton steps, which walk on if they leave the triangle.

use glam::{DMat3, DVec3};

use super::donors::NONE;
use super::faces::Faces;

/// A point's place relative to the base.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    /// The base's triangle.
    pub face: u32,
    /// The foot's barycentric coordinates.
    pub weights: [f64; 3],
    /// h, the signed distance along the unit normal.
    pub height: f64,
    /// The rest of the way in the foot's frame: zero but where no normal of the base leads to the point, as beyond a
    /// border.
    pub remainder: DVec3,
}

/// The base at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestBase<'a> {
    pub faces: &'a Faces,
    pub points: &'a [DVec3],
    pub normals: &'a [DVec3],
}

/// The most triangles of a walk.
const WALK: usize = 1000;

/// The most triangles that Newton steps try, and the most steps in each.
const TRIED: usize = 40;
const STEPS: usize = 12;

/// Newton steps end with one below this, in barycentric coordinates: the error after a step is about its square.
const SMALL: f64 = 1e-7;

/// A foot may be outside its triangle by this much, in barycentric coordinates.
const OUTSIDE: f64 = 1e-9;

/// A foot is at most this many times as far as the nearest point.
const FARTHEST: f64 = 2.0;

impl RestBase<'_> {
    /// The foot of a point that belongs to the local vertex `start`; `None` if the base has no frame there.
    pub fn foot(&self, start: u32, point: DVec3) -> Option<Foot> {
        let (face, weights) = self.nearest(start, point)?;
        let distance = self.at(face, weights).0.distance(point);
        let normal = self.newton(face, weights, point);
        if let Some(foot) = normal.filter(|foot| foot.height.abs() <= FARTHEST * distance) {
            return Some(foot);
        }
        let (base, _) = self.at(face, weights);
        let frame = frame(self.faces.corners[face as usize], weights, self.points, self.normals)?;
        let offset = frame.transpose() * (point - base);
        Some(Foot {
            face,
            weights,
            height: offset.z,
            remainder: DVec3::new(offset.x, offset.y, 0.0),
        })
    }

    /// The nearest point of the base that is reached from a vertex without moving away from `point`.
    fn nearest(&self, start: u32, point: DVec3) -> Option<(u32, [f64; 3])> {
        let mut best: Option<(f64, u32, [f64; 3])> = None;
        let mut corners = [start; 3];
        // All triangles around these have been tried.
        let mut tried = [NONE; 3];
        for _ in 0..WALK {
            let mut is_nearer = false;
            for (number, corner) in corners.into_iter().enumerate() {
                if tried.contains(&corner) || corners[..number].contains(&corner) {
                    continue;
                }
                for face in self.faces.around(corner as usize) {
                    let corners = self.faces.corners[face as usize];
                    if corners.iter().any(|corner| tried.contains(corner)) {
                        continue;
                    }
                    let places = corners.map(|corner| self.points[corner as usize]);
                    let weights = nearest_in(point, places);
                    let square = mix(weights, places).distance_squared(point);
                    if best.is_none_or(|(least, ..)| square < least) {
                        best = Some((square, face, weights));
                        is_nearer = true;
                    }
                }
            }
            let (_, face, _) = best?;
            if !is_nearer {
                break;
            }
            tried = corners;
            corners = self.faces.corners[face as usize];
        }
        best.map(|(_, face, weights)| (face, weights))
    }

    /// Newton steps from a place of the base to the foot.
    fn newton(&self, mut face: u32, mut weights: [f64; 3], point: DVec3) -> Option<Foot> {
        let (base, normal) = self.at(face, weights);
        let mut height = (point - base).dot(normal);
        let scale = point.distance(base);
        for _ in 0..TRIED {
            (weights, height) = self.solve(face, weights, height, point)?;
            let (base, normal) = self.at(face, weights);
            let outermost = (0..3).min_by(|&a, &b| weights[a].total_cmp(&weights[b]))?;
            if weights[outermost] >= -OUTSIDE {
                let is_met = (base + normal * height).distance(point) <= 1e-9 * scale;
                return is_met.then_some(Foot {
                    face,
                    weights,
                    height: height * normal.length(),
                    remainder: DVec3::ZERO,
                });
            }
            face = self.across(face, outermost)?;
            let places = self.faces.corners[face as usize].map(|corner| self.points[corner as usize]);
            weights = nearest_in(base, places);
        }
        None
    }

    /// Solves b(u, v) + h n(u, v) = p in the plane of one triangle; the weights may be negative.
    fn solve(&self, face: u32, mut weights: [f64; 3], mut height: f64, point: DVec3) -> Option<([f64; 3], f64)> {
        let corners = self.faces.corners[face as usize];
        let [a, b, c] = corners.map(|corner| self.points[corner as usize]);
        let [na, nb, nc] = corners.map(|corner| self.normals[corner as usize]);
        for _ in 0..STEPS {
            let (base, normal) = self.at(face, weights);
            let missing = point - base - normal * height;
            let along = DMat3::from_cols(b - a + (nb - na) * height, c - a + (nc - na) * height, normal);
            let step = along.inverse() * missing;
            weights = [weights[0] - step.x - step.y, weights[1] + step.x, weights[2] + step.y];
            height += step.z;
            if !step.is_finite() || weights.iter().any(|weight| weight.abs() > 50.0) {
                return None;
            }
            if step.x.abs().max(step.y.abs()) < SMALL {
                break;
            }
        }
        Some((weights, height))
    }

    /// The triangle across the edge that is opposite to a corner.
    fn across(&self, face: u32, corner: usize) -> Option<u32> {
        let corners = self.faces.corners[face as usize];
        let (from, to) = (corners[(corner + 1) % 3], corners[(corner + 2) % 3]);
        let mut around = self.faces.around(from as usize);
        around.find(|&next| next != face && self.faces.corners[next as usize].contains(&to))
    }

    /// The point of a triangle, and the interpolated normal, which is not of unit length.
    fn at(&self, face: u32, weights: [f64; 3]) -> (DVec3, DVec3) {
        let corners = self.faces.corners[face as usize];
        let of = |values: &[DVec3]| mix(weights, corners.map(|corner| values[corner as usize]));
        (of(self.points), of(self.normals))
    }
}

/// Σ w v.
#[inline]
pub(crate) fn mix(weights: [f64; 3], [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * weights[0] + b * weights[1] + c * weights[2]
}

/// The frame at a place of a triangle: two tangents and the interpolated unit normal; `None` if there is no normal.
#[inline]
pub(crate) fn frame(corners: [u32; 3], weights: [f64; 3], points: &[DVec3], normals: &[DVec3]) -> Option<DMat3> {
    let normal = mix(weights, corners.map(|corner| normals[corner as usize])).try_normalize()?;
    let [a, b, c] = corners.map(|corner| points[corner as usize]);
    let edge = if (b - a).length_squared() > 0.0 { b - a } else { c - a };
    let tangent = (edge - normal * edge.dot(normal)).try_normalize()?;
    Some(DMat3::from_cols(tangent, normal.cross(tangent), normal))
}

/// The barycentric coordinates of the nearest point of a triangle.
fn nearest_in(point: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (u, v, w) = (b - a, c - a, point - a);
    let (uu, uv, vv) = (u.length_squared(), u.dot(v), v.length_squared());
    let determinant = uu * vv - uv * uv;
    if determinant > 0.0 {
        let (wu, wv) = (w.dot(u), w.dot(v));
        let (s, t) = ((vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant);
        if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
            return [1.0 - s - t, s, t];
        }
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let share = (point - from).dot(to - from) / (to - from).length_squared();
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        (from.lerp(to, share).distance_squared(point), share)
    };
    let (ab, bc, ca) = (on_edge(a, b), on_edge(b, c), on_edge(c, a));
    if ab.0 <= bc.0 && ab.0 <= ca.0 {
        [1.0 - ab.1, ab.1, 0.0]
    } else if bc.0 <= ca.0 {
        [0.0, 1.0 - bc.1, bc.1]
    } else {
        [ca.1, 0.0, 1.0 - ca.1]
    }
}
