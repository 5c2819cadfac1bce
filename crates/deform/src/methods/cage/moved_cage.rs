//! A moved cage of Green coordinates: the coefficients of the field.

use glam::{DMat3, DVec3};

use super::green::Green;
use super::lane_rows::LaneRows;
use super::mesh::CageMesh;
use super::stretched::RestFace;
use crate::numerical::rigid_fit::RigidMotion;

/// A rigid motion and the differences from it.
#[derive(Debug)]
pub(super) struct MovedCage {
    pub rigid: Option<RigidMotion>,
    pub turn: DMat3,
    /// The coefficients of each vertex, then of each face's stretched normal.
    pub differences: Vec<DVec3>,
}

/// A cage at rest that displacements can move.
#[derive(Debug)]
pub(super) struct RestCage {
    pub mesh: CageMesh,
    pub faces: Vec<RestFace>,
    normals: Vec<DVec3>,
}

impl RestCage {
    /// The rest cage of this mesh.
    pub fn new(mesh: CageMesh) -> Self {
        let faces = mesh.faces.iter();
        Self {
            faces: faces.map(|corners| RestFace::of(*corners, &mesh.vertices)).collect(),
            normals: Green::new(&mesh).normals().collect(),
            mesh,
        }
    }

    /// The positions of its vertices with these displacements.
    pub fn places(&self, shifts: &[DVec3]) -> Vec<DVec3> {
        let rest = self.mesh.vertices.iter().zip(shifts);
        rest.map(|(rest, shift)| *rest + *shift).collect()
    }

    /// The cage with these displacements of its vertices.
    pub fn moved(&self, shifts: &[DVec3]) -> MovedCage {
        let rigid = RigidMotion::fit(&self.mesh.vertices, shifts);
        let turn = rigid.map_or(DMat3::IDENTITY, |rigid| DMat3::from_quat(rigid.rotation()));
        let of_vertices = self.mesh.vertices.iter().zip(shifts);
        let of_vertices = of_vertices.map(|(rest, shift)| *shift - displaced(rigid.as_ref(), *rest));
        let places = self.places(shifts);
        let of_faces = self.faces.iter().zip(&self.normals);
        let of_faces = of_faces.map(|(face, normal)| face.stretched_normal(&places) - turn * *normal);
        let differences = of_vertices.chain(of_faces).collect();
        MovedCage {
            rigid,
            turn,
            differences,
        }
    }
}

impl MovedCage {
    /// The displacements of points with these coordinates. A rigid motion of the whole cage moves every point with it.
    pub fn at(&self, points: &[DVec3], rows: &LaneRows<f64>) -> Vec<DVec3> {
        let mut sums = rows.product(&self.differences);
        for (sum, point) in sums.iter_mut().zip(points) {
            *sum += self.displaced(*point);
        }
        sums
    }

    /// The displacement of a point by the rigid motion.
    pub fn displaced(&self, point: DVec3) -> DVec3 {
        displaced(self.rigid.as_ref(), point)
    }
}

fn displaced(rigid: Option<&RigidMotion>, point: DVec3) -> DVec3 {
    rigid.map_or(DVec3::ZERO, |rigid| rigid.displace(point))
}
