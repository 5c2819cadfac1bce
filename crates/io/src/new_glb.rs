//! A new glTF from the other kinds.

use crate::new_mesh::NewMesh;
use crate::save::Saved;
use crate::{Format, SaveError};

pub(crate) fn write_new(_mesh: &NewMesh<'_>) -> Result<Saved, SaveError> {
    Err(SaveError::TooLarge {
        format: Format::Glb,
    })
}

pub(crate) fn write_new_gltf(_mesh: &NewMesh<'_>) -> Result<Saved, SaveError> {
    Err(SaveError::TooLarge {
        format: Format::Gltf,
    })
}
