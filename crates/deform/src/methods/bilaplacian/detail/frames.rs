//! Frames of rings: that of a patch's gradient around a vertex, fitted by least squares in the tangent plane.
//!
//! The normal is perpendicular to the images x and y of the two tangents, and within the plane the frame turns as they
//! do on average. No edge is singled out.

use glam::{DMat3, DVec3};
use pliant_mesh::{SurfaceVertex, Topology};
use rayon::prelude::*;

use super::donors::{NONE, nearest};
use crate::numerical::rows::CHUNK;
use crate::region::patch::Patch;

/// The parts of a frame at each row of a patch.
#[derive(Debug)]
pub(crate) struct RingFrames {
    /// The start of each row's neighbours; one more at the end.
    starts: Vec<u32>,
    /// The neighbours' local numbers and their shares in x and y.
    ring: Vec<(u32, [f64; 2])>,
    /// The row that lends its frame to this one: itself, or the nearest one with a frame, or [`NONE`].
    sources: Vec<u32>,
}

/// In a ring of the base narrower than this, in diagonals, only the solver's error is left.
pub(crate) const NARROWEST: f64 = 1e-7;

/// A ring or triangle of the base that is narrower than this share of its length has no frame of its own.
pub(crate) const SLIMMEST: f64 = 1e-6;

/// The least length of a ring's mean normal: with less the base is folded there.
const UNFOLDED: f64 = 0.1;

impl RingFrames {
    /// The frames of a patch's rings at rest.
    pub fn of(patch: &Patch, triangles: &[[SurfaceVertex; 3]], topology: &Topology) -> Self {
        let of_row = |row: usize| ring(patch, row, triangles, topology);
        let rings: Vec<Ring> = (0..patch.rows.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(of_row)
            .collect();
        let has_frame: Vec<bool> = rings.iter().map(|ring| ring.has_frame).collect();
        let mut starts = vec![0];
        let mut flat = Vec::with_capacity(rings.iter().map(|ring| ring.shares.len()).sum());
        for ring in rings {
            flat.extend(ring.shares);
            starts.push(flat.len() as u32);
        }
        let mut row_of = vec![NONE; patch.vertices.len()];
        for (row, &local) in patch.rows.iter().enumerate() {
            row_of[local as usize] = row as u32;
        }
        let sources = nearest(&has_frame, |row, visit| {
            for (local, _) in &flat[starts[row] as usize..starts[row + 1] as usize] {
                let next = row_of[*local as usize];
                if next != NONE {
                    visit(next);
                }
            }
        });
        Self {
            starts,
            ring: flat,
            sources,
        }
    }

    /// The frame of a row's source, the local vertices being at `posed`: two tangents and the normal; `None` if there
    /// is none, or if the patch is bent to a line or a point there.
    #[inline]
    pub fn frame(&self, patch: &Patch, row: usize, posed: &[DVec3]) -> Option<DMat3> {
        let source = self.sources[row] as usize;
        let own = posed[*patch.rows.get(source)? as usize];
        let (mut x, mut y) = (DVec3::ZERO, DVec3::ZERO);
        for (local, [a, b]) in &self.ring[self.starts[source] as usize..self.starts[source + 1] as usize] {
            let edge = posed[*local as usize] - own;
            x += edge * *a;
            y += edge * *b;
        }
        let first = x.try_normalize()?;
        let normal = x.cross(y).try_normalize()?;
        let second = normal.cross(first);
        // The turn about the normal that fits x and y best: its cosine and sine, up to a factor.
        let (cosine, sine) = (x.length() + y.dot(second), -y.dot(first));
        let length = cosine.hypot(sine);
        let (cosine, sine) = (cosine / length, sine / length);
        Some(DMat3::from_cols(
            first * cosine + second * sine,
            second * cosine - first * sine,
            normal,
        ))
    }
}

/// A row's neighbours and their shares in the gradient.
struct Ring {
    shares: Vec<(u32, [f64; 2])>,
    has_frame: bool,
}

fn ring(patch: &Patch, row: usize, triangles: &[[SurfaceVertex; 3]], topology: &Topology) -> Ring {
    let local = patch.rows[row] as usize;
    let vertex = SurfaceVertex(patch.vertices[local]);
    let local_of = |vertex: SurfaceVertex| patch.vertices.binary_search(&vertex.0).ok();
    let point = |vertex: SurfaceVertex| local_of(vertex).map_or(DVec3::ZERO, |local| patch.rest[local]);
    let (mut normal, mut area) = (DVec3::ZERO, 0.0);
    for face in topology.faces(vertex, triangles) {
        let [a, b, c] = triangles[face as usize].map(point);
        let own = (b - a).cross(c - a);
        normal += own;
        area += own.length();
    }
    let locals: Vec<usize> = topology
        .neighbours(vertex)
        .iter()
        .filter_map(|&next| local_of(next))
        .collect();
    let flat = |has_frame, [x, y]: [DVec3; 2]| {
        let shares = locals.iter().map(|&next| {
            let edge = patch.rest[next] - patch.rest[local];
            (next as u32, [edge.dot(x), edge.dot(y)])
        });
        Ring {
            shares: shares.collect(),
            has_frame,
        }
    };
    let without = || flat(false, [DVec3::ZERO; 2]);
    if normal.length() <= UNFOLDED * area {
        return without();
    }
    let (t, b) = normal.normalize().any_orthonormal_pair();
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for &next in &locals {
        let edge = patch.rest[next] - patch.rest[local];
        let (x, y) = (edge.dot(t), edge.dot(b));
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    let (determinant, trace) = (xx * yy - xy * xy, xx + yy);
    // The smaller eigenvalue is about determinant / trace: a squared width.
    let width = determinant / trace;
    let least = (NARROWEST * patch.size).powi(2).max(SLIMMEST.powi(2) * trace);
    if width > least {
        flat(true, [(t * yy - b * xy) / determinant, (b * xx - t * xy) / determinant])
    } else {
        without()
    }
}
