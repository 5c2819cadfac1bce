//! The cage's parts alone, for tests and measurements.

use glam::DVec3;

use pliant_mesh::{Cancel, Progress};

use super::green::Green;
use super::harmonic::Harmonic;
use super::mean_value::MeanValue;
use super::mesh::CageMesh;
use super::offset::offset_cage;
use super::stretched::RestFace;
use crate::Budget;

/// Vertices and faces of a mesh.
pub type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// The cage made for points and the triangles between them, with `detail` cells on its longest side.
pub fn made(points: &[DVec3], triangles: &[[DVec3; 3]], detail: u32) -> Mesh {
    let mesh = offset_cage(points, triangles.iter().copied(), detail);
    (mesh.vertices, mesh.faces)
}

/// The mean value coordinates of points in a cage, and their gradients.
pub fn mean_value(mesh: &Mesh, points: &[DVec3]) -> Vec<Vec<(f64, DVec3)>> {
    let cage = CageMesh::new(mesh.0.clone(), mesh.1.clone());
    let mut all = Vec::new();
    MeanValue::new(&cage).at(points, |_, own| all.push(own.to_vec()));
    all
}

/// The Green coordinates of a point in a cage, and their gradients: those of the vertices, then those of the faces.
pub fn green(mesh: &Mesh, point: DVec3) -> Vec<(f64, DVec3)> {
    let cage = CageMesh::new(mesh.0.clone(), mesh.1.clone());
    let green = Green::new(&cage);
    let mut values = vec![0.0; green.count()];
    let mut gradients = vec![DVec3::ZERO; green.count()];
    green.at(point, &mut values, Some(&mut gradients));
    values.into_iter().zip(gradients).collect()
}

/// The position of a point by Green coordinates after the cage's vertices moved.
pub fn green_moved(mesh: &Mesh, moved: &[DVec3], point: DVec3) -> DVec3 {
    let cage = CageMesh::new(mesh.0.clone(), mesh.1.clone());
    let green = Green::new(&cage);
    let mut values = vec![0.0; green.count()];
    green.at(point, &mut values, None);
    let normals = mesh
        .1
        .iter()
        .map(|corners| RestFace::of(*corners, &mesh.0).stretched_normal(moved));
    let targets = moved.iter().copied().chain(normals);
    targets.zip(&values).map(|(target, value)| target * *value).sum()
}

/// The harmonic coordinates of points in a cage, by a grid of this step; `None` if the solve fails.
pub fn harmonic(mesh: &Mesh, step: f64, points: &[DVec3]) -> Option<Vec<Vec<f64>>> {
    let cage = CageMesh::new(mesh.0.clone(), mesh.1.clone());
    let harmonic = Harmonic::solved(&cage, step, Budget::default(), &Progress::new(), &Cancel::new()).ok()?;
    Some(points.iter().map(|point| harmonic.at(*point)).collect())
}
