//! `EXT_mesh_gpu_instancing`: a node that shows its mesh many times, each copy by its own transform.

use glam::{DAffine3, DQuat, DVec3};

use crate::gltf::document::Document;
use crate::gltf::document::json::At;

pub(crate) const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// The place of a copy relative to its node.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct CopyPlace {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl CopyPlace {
    pub fn node_from_copy(&self) -> DAffine3 {
        // Files round quaternions, and quantise them; a zero one is no rotation.
        let length = self.rotation.length();
        let rotation = if length > 0.0 {
            self.rotation / length
        } else {
            DQuat::IDENTITY
        };
        DAffine3::from_scale_rotation_translation(self.scale, rotation, self.translation)
    }
}

/// The copies of its mesh that a node shows; `None` if it shows the mesh once, without the extension.
///
/// # Errors
/// Attributes that can't be read, as the end of a sentence.
pub(crate) fn copies(document: &Document, node: At) -> Result<Option<Vec<CopyPlace>>, String> {
    let json = &document.json;
    let Some(attributes) = json.path(node, &["extensions", EXTENSION, "attributes"]) else {
        return Ok(None);
    };
    let mut count = None;
    let mut read = |key: &str, lanes: usize| -> Result<Option<Vec<[f32; 4]>>, String> {
        let accessor = document.index(attributes, key, document.accessors.len(), || EXTENSION.to_owned())?;
        let Some(accessor) = accessor else { return Ok(None) };
        let layout = document.layout(accessor)?;
        let known = *count.get_or_insert(layout.count);
        if layout.lanes != lanes || layout.count != known {
            return Err(format!(
                "accessor {accessor} is not {known} elements of {lanes} numbers"
            ));
        }
        Ok(Some(layout.floats::<4>(document)))
    };
    let (translations, rotations) = (read("TRANSLATION", 3)?, read("ROTATION", 4)?);
    let scales = read("SCALE", 3)?;
    let vector = |list: &Option<Vec<[f32; 4]>>, copy: usize, missing: DVec3| match list {
        Some(list) => DVec3::from_array([0, 1, 2].map(|lane: usize| f64::from(list[copy][lane]))),
        None => missing,
    };
    let place = |copy: usize| CopyPlace {
        translation: vector(&translations, copy, DVec3::ZERO),
        rotation: match &rotations {
            Some(list) => DQuat::from_array(list[copy].map(f64::from)),
            None => DQuat::IDENTITY,
        },
        scale: vector(&scales, copy, DVec3::ONE),
    };
    Ok(count.map(|count| (0..count).map(place).collect()))
}
