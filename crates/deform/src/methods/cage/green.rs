//! Green coordinates [LLC08]: p = Σ_i φ_i(p) v_i + Σ_j ψ_j(p) s_j n_j, by Green's third identity for the functions x, y
//! and z. With the cage's normals n and the stretch of its faces, s, the map keeps angles.
//!
//! φ_i is the double-layer potential of the hat function of vertex i and ψ_j the single-layer potential of face j, both
//! over 4π. The closed form uses a face's solid angle Ω, its height h over p, and of each edge e the potential L_e = ∫
//! 1/r ds, the distance d_e in the plane and the normal m_e in the plane:
//!
//! 4π ψ = Σ_e d_e L_e − h Ω and 4π φ_i = Γ_i Ω − h Σ_e (∇Γ_i · m_e) L_e,
//!
//! where Γ_i is the corner's hat function at the foot of p in the plane.

use std::f64::consts::PI;

use glam::DVec3;

use super::mesh::CageMesh;

/// A cage for Green coordinates.
#[derive(Debug)]
pub(super) struct Green<'a> {
    cage: &'a CageMesh,
    planes: Vec<Plane>,
}

/// A face's plane.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    /// For each corner the normal, in the plane and outward, of the edge opposite to it.
    outward: [DVec3; 3],
    /// For each corner the slope at which its hat function falls along `outward`: one over the triangle's height there.
    slopes: [f64; 3],
}

/// The contribution of an edge from a to b, relative to the point, to the faces at its sides.
#[derive(Clone, Copy, Debug, Default)]
struct AtEdge {
    /// ∫ 1/r ds.
    potential: f64,
    /// The gradient of `potential`.
    slope: DVec3,
    /// ∫ r × ds / r³, whose sum around a face is the gradient of its solid angle.
    turn: DVec3,
}

impl<'a> Green<'a> {
    pub fn new(cage: &'a CageMesh) -> Self {
        let plane = |face: usize| {
            let corners = cage.corners(face);
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let normal = area.normalize_or_zero();
            let along = |k: usize| corners[(k + 2) % 3] - corners[(k + 1) % 3];
            Plane {
                normal,
                outward: [0, 1, 2].map(|k| along(k).cross(normal).normalize_or_zero()),
                slopes: [0, 1, 2].map(|k| along(k).length() / area.length().max(f64::MIN_POSITIVE)),
            }
        };
        Self {
            cage,
            planes: (0..cage.faces.len()).map(plane).collect(),
        }
    }

    /// The count of coordinates: those of the vertices, then those of the faces.
    pub fn count(&self) -> usize {
        self.cage.vertices.len() + self.cage.faces.len()
    }

    /// Computes the coordinates of a point, and their gradients. Those of the vertices sum to 1 inside.
    pub fn at(&self, point: DVec3, values: &mut [f64], mut gradients: Option<&mut [DVec3]>) {
        let cage = self.cage;
        values.fill(0.0);
        if let Some(gradients) = gradients.as_deref_mut() {
            gradients.fill(DVec3::ZERO);
        }
        let spokes: Vec<(DVec3, f64)> = cage
            .vertices
            .iter()
            .map(|vertex| (*vertex - point, vertex.distance(point)))
            .collect();
        let edges: Vec<AtEdge> = cage
            .edges
            .iter()
            .map(|&[a, b]| at_edge(spokes[a as usize], spokes[b as usize]))
            .collect();
        let vertex_count = cage.vertices.len();
        for (number, ((face, sides), plane)) in cage.faces.iter().zip(&cage.sides).zip(&self.planes).enumerate() {
            let [a, b, c] = face.map(|vertex| spokes[vertex as usize]);
            let height = a.0.dot(plane.normal);
            let volume = a.0.dot(b.0.cross(c.0));
            let lengths = a.1 * b.1 * c.1;
            // On the face itself this takes the limit from inside.
            let volume = if volume.abs() < 1e-14 * lengths {
                volume.abs()
            } else {
                volume
            };
            let below = lengths + a.0.dot(b.0) * c.1 + b.0.dot(c.0) * a.1 + c.0.dot(a.0) * b.1;
            let solid_angle = 2.0 * volume.atan2(below);
            let own = sides.map(|side| edges[side.edge as usize]);
            // Each edge is opposite to its corner, so another corner is on it.
            let distances = [0, 1, 2].map(|k| [b, c, a][k].0.dot(plane.outward[k]));
            let mut single = -height * solid_angle;
            for k in 0..3 {
                single += distances[k] * own[k].potential;
            }
            values[vertex_count + number] = single / (4.0 * PI);
            // Σ_e m_e L_e: the double layers need its products with ∇Γ_i = −slope m_i.
            let pull: DVec3 = (0..3).map(|k| plane.outward[k] * own[k].potential).sum();
            for corner in 0..3 {
                let hat = distances[corner] * plane.slopes[corner];
                let rise = -plane.outward[corner] * plane.slopes[corner];
                values[face[corner] as usize] += (hat * solid_angle - height * rise.dot(pull)) / (4.0 * PI);
                if let Some(gradients) = gradients.as_deref_mut() {
                    let turn: DVec3 = (0..3).map(|k| own[k].turn * sides[k].sign).sum();
                    let slope: DVec3 = (0..3).map(|k| own[k].slope * rise.dot(plane.outward[k])).sum();
                    gradients[face[corner] as usize] +=
                        (rise * solid_angle + turn * hat + plane.normal * rise.dot(pull) - slope * height) / (4.0 * PI);
                }
            }
            if let Some(gradients) = gradients.as_deref_mut() {
                gradients[vertex_count + number] = (plane.normal * solid_angle - pull) / (4.0 * PI);
            }
        }
    }

    /// Each face's unit normal.
    pub fn normals(&self) -> impl Iterator<Item = DVec3> {
        self.planes.iter().map(|plane| plane.normal)
    }
}

/// The contribution of an edge between two vertices, given relative to the point with their distances.
fn at_edge((a, a_length): (DVec3, f64), (b, b_length): (DVec3, f64)) -> AtEdge {
    let length = a.distance(b);
    let sum = a_length + b_length;
    // On the edge itself the factors of these are zero.
    let tiny = 1e-16 * length.max(f64::MIN_POSITIVE.sqrt());
    let gap = (sum - length).max(tiny);
    let product = (a_length * b_length).max(tiny * tiny);
    let beside = (product + a.dot(b)).max(tiny * tiny);
    AtEdge {
        potential: ((sum + length) / gap).ln(),
        slope: (a.normalize_or_zero() + b.normalize_or_zero()) * (2.0 * length / (gap * (sum + length))),
        turn: a.cross(b) * (sum / (product * beside)),
    }
}
