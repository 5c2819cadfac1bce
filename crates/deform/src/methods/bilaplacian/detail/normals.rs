//! Normal displacements: each vertex of the surface keeps its foot on the base and its height over it along the base's
//! normal [BS08, equation 9].
//!
//! p = b + h n(b), and b keeps its barycentric coordinates when the base bends, so p' = b' + h n'(b'). The heights are
//! shorter than the displacements from the vertices' own points of the base, and they do not depend on the base's slip
//! along itself. Neighbouring displacements know nothing of each other: where the bent base has a radius of curvature
//! smaller than a height, they cross.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::base::Base;
use super::faces::Faces;
use super::foot::{Foot, RestBase, frame, mix};
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;

/// The feet of the rows on the base.
#[derive(Debug)]
pub(crate) struct NormalDisplacements {
    pub faces: Faces,
    /// For each row its foot; `None` if it is on the base, or if the base has no normal there.
    feet: Vec<Option<Foot>>,
    /// The rows' points over the base at rest, as the feet give them.
    pub at_rest: Vec<DVec3>,
    /// The normals of the last frame's base.
    normals: Vec<DVec3>,
}

impl NormalDisplacements {
    /// Finds the foot of every vertex that fairing moved.
    pub fn of(base: &Base, problem: &BoundaryProblem<'_>) -> Self {
        let patch = &base.patch;
        let faces = Faces::of(patch, problem);
        let mut normals = Vec::new();
        faces.normals(&patch.rest, &mut normals);
        let rest = RestBase {
            faces: &faces,
            points: &patch.rest,
            normals: &normals,
        };
        let foot = |row: usize| {
            let local = patch.rows[row];
            let point = patch.rest[local as usize] + base.offsets[row];
            base.is_faired[row].then(|| rest.foot(local, point)).flatten()
        };
        let rows = (0..patch.rows.len()).into_par_iter().with_min_len(CHUNK / 8);
        let mut found = Self {
            feet: rows.map(foot).collect(),
            at_rest: Vec::new(),
            faces,
            normals,
        };
        let rows = (0..patch.rows.len()).into_par_iter().with_min_len(CHUNK);
        found.at_rest = rows.map(|row| found.point(base, row, &patch.rest, &[])).collect();
        found
    }

    /// Prepares [`NormalDisplacements::point`] for a bent base.
    pub fn bend(&mut self, posed: &[DVec3]) {
        self.faces.normals(posed, &mut self.normals);
    }

    /// A row's point over the base that was bent last.
    #[inline]
    pub fn point(&self, base: &Base, row: usize, posed: &[DVec3], turns: &[DMat3]) -> DVec3 {
        let own = || {
            let offset = base.offsets[row];
            posed[base.patch.rows[row] as usize] + offset + base.turn(row, turns) * offset
        };
        let over = |foot: &Foot| {
            let corners = self.faces.corners[foot.face as usize];
            let place = mix(foot.weights, corners.map(|corner| posed[corner as usize]));
            if foot.remainder != DVec3::ZERO {
                let frame = frame(corners, foot.weights, posed, &self.normals)?;
                return Some(place + frame.z_axis * foot.height + frame * foot.remainder);
            }
            let normal = mix(foot.weights, corners.map(|corner| self.normals[corner as usize]));
            Some(place + normal.try_normalize()? * foot.height)
        };
        self.feet[row].as_ref().and_then(over).unwrap_or_else(own)
    }
}
