//! The cage of a binding: the brought one, or one made around the region.

use std::sync::Arc;

use glam::DVec3;

use super::brought::outward_faces;
use super::linear::Unit;
use super::mesh::CageMesh;
use super::offset::{offset_cage, voxel_size};
use crate::attachment::{Attachment, ControlMesh};
use crate::method::BindInput;
use crate::space::fit_samples::RegionBox;
use crate::space::shaping::shaping;

/// A cage.
#[derive(Debug)]
pub(super) struct ChosenCage {
    /// The cage in world units.
    pub attachment: ControlMesh,
    /// The cage in its own unit.
    pub mesh: CageMesh,
    /// The size of the voxels of a made cage; a brought cage has it too.
    pub voxel: f64,
    pub is_brought: bool,
}

impl ChosenCage {
    /// Chooses the cage of a binding; a made one has `detail` voxels on the longest side of the region.
    pub fn of(input: &BindInput<'_>, within: &RegionBox, unit: Unit, detail: u32) -> Self {
        let points = region_points(input, within, unit);
        let brought = match input.attachment {
            Some(Attachment::Mesh(mesh)) => Some(mesh.clone()),
            _ => None,
        };
        let is_brought = brought.is_some();
        let attachment = brought.unwrap_or_else(|| made(detail, &points, input, within, unit));
        let vertices = attachment.rest.iter().map(|vertex| unit.local(*vertex)).collect();
        Self {
            mesh: CageMesh::new(vertices, outward_faces(&attachment)),
            attachment,
            voxel: voxel_size(&points, detail),
            is_brought,
        }
    }
}

/// All points in the region's box, in the cage's unit, without bare points if triangles use any of them; all points of
/// the surface if nothing moves.
fn region_points(input: &BindInput<'_>, within: &RegionBox, unit: Unit) -> Vec<DVec3> {
    let positions = &input.problem.surface.positions;
    let all = 0..positions.len() as u32;
    let inside = all
        .clone()
        .filter(|&vertex| within.contains(positions[vertex as usize]));
    let inside = shaping(input.problem, inside);
    let points = if inside.is_empty() { all.collect() } else { inside }.into_iter();
    points.map(|vertex| unit.local(positions[vertex as usize])).collect()
}

/// Makes a cage around these points, at rest.
fn made(detail: u32, points: &[DVec3], input: &BindInput<'_>, within: &RegionBox, unit: Unit) -> ControlMesh {
    let surface = input.problem.surface;
    let triangles = surface.triangles.iter();
    let triangles = triangles.map(|corners| corners.map(|corner| surface.positions[corner.index()]));
    let triangles = triangles.filter(|corners| corners.iter().all(|corner| within.contains(*corner)));
    let triangles = triangles.map(|corners| corners.map(|corner| unit.local(corner)));
    let mesh = offset_cage(points, triangles, detail);
    let rest: Arc<Vec<DVec3>> = Arc::new(mesh.vertices.iter().map(|vertex| unit.world(*vertex)).collect());
    ControlMesh {
        moved: Arc::clone(&rest),
        rest,
        triangles: Arc::new(mesh.faces),
    }
}
