//! Writes a mesh as a new file of any format.

use crate::convert::NewMesh;
use crate::save::Saved;
use crate::save::course::Course;
use crate::{Format, SaveError, gltf, obj, off, ply, stl, threemf, usdz};

/// A mesh as a new file.
pub(crate) fn write_new(mesh: &NewMesh<'_>, format: Format, course: &Course<'_>) -> Result<Saved, SaveError> {
    match format {
        Format::Glb => gltf::write::write_new(mesh, course),
        Format::Gltf => gltf::write::write_new_gltf(mesh, course),
        Format::Obj => obj::write_new(mesh, course),
        Format::Ply => ply::write_new(mesh, course),
        Format::Stl => stl::write_new(mesh, course),
        Format::Off => off::write_new(mesh, course),
        Format::Threemf => threemf::write_new(mesh, course),
        Format::Usdz => usdz::write_new(mesh, course),
    }
}
