//! The images of a material besides the base colour's, and its members that are extensions.

use serde_json::{Value, json};

use super::buffer::Built;
use super::looks::{Looks, PLAIN};
use crate::appearance::{Lighting, Map, Material, UvSet};
use crate::convert::NewMesh;

/// A transform of texture coordinates that differs from a turned, scaled and shifted one by more than this can't be
/// written.
const SKEW: f32 = 1e-4;

/// Adds the maps, the emission and the lighting of `material` to its JSON. Gives the extensions that it uses.
pub(super) fn dress(
    looks: &mut Looks,
    out: &mut Built,
    mesh: &NewMesh<'_>,
    material: &Material,
    value: &mut Value,
) -> Vec<&'static str> {
    let mut used = Vec::new();
    let mut put =
        |looks: &mut Looks, out: &mut Built, map: Option<Map>, place: [&str; 2], scale: Option<(&str, f32)>| {
            let reference = map.and_then(|map| reference(looks, out, mesh, map, &mut used));
            if let Some(mut reference) = reference {
                if let Some((name, factor)) = scale.filter(|(_, factor)| *factor != 1.0 && factor.is_finite()) {
                    reference[name] = factor.into();
                }
                match place {
                    ["", name] => value[name] = reference,
                    [parent, name] => value[parent][name] = reference,
                }
            }
        };
    let inside = ["pbrMetallicRoughness", "metallicRoughnessTexture"];
    put(looks, out, material.metallic_roughness_map, inside, None);
    let scale = Some(("scale", material.normal_scale));
    put(looks, out, material.normal_map, ["", "normalTexture"], scale);
    let strength = Some(("strength", material.occlusion_strength));
    put(looks, out, material.occlusion_map, ["", "occlusionTexture"], strength);
    put(looks, out, material.emissive_map, ["", "emissiveTexture"], None);
    let most = material.emissive.into_iter().fold(0.0, f32::max);
    if most > 0.0 && most.is_finite() {
        let strength = most.max(1.0);
        value["emissiveFactor"] = json!(material.emissive.map(|light| (light / strength).clamp(0.0, 1.0)));
        if strength > 1.0 {
            used.push("KHR_materials_emissive_strength");
            value["extensions"]["KHR_materials_emissive_strength"] = json!({ "emissiveStrength": strength });
        }
    }
    if material.lighting == Lighting::Unlit {
        used.push("KHR_materials_unlit");
        value["extensions"]["KHR_materials_unlit"] = json!({});
    }
    used
}

/// The reference to a map; `None` if the mesh lacks its texture coordinates or its image.
fn reference(
    looks: &mut Looks,
    out: &mut Built,
    mesh: &NewMesh<'_>,
    map: Map,
    used: &mut Vec<&'static str>,
) -> Option<Value> {
    let set = set_number(mesh, map.set)?;
    let image = looks.image(out, mesh, map.image, &PLAIN)?;
    let mut reference = json!({ "index": looks.texture(image, map.wrap) });
    if set > 0 {
        reference["texCoord"] = set.into();
    }
    let is_moved = place(out, &mut reference, map.transform)?;
    used.extend(is_moved.then_some("KHR_texture_transform"));
    Some(reference)
}

/// Gives a reference the transform of these rows, and tells whether it needs one; `None` if glTF can't hold it.
pub(super) fn place(out: &mut Built, reference: &mut Value, rows: [[f32; 3]; 2]) -> Option<bool> {
    match transform(rows) {
        Some(None) => Some(false),
        Some(Some(transform)) => {
            reference["extensions"] = json!({ "KHR_texture_transform": transform });
            Some(true)
        }
        None => {
            out.warnings
                .push("An image with skewed texture coordinates was left out, because glTF can't hold them.".into());
            None
        }
    }
}

/// The number of a set of texture coordinates in the new file; `None` if the mesh does not have it.
pub(super) fn set_number(mesh: &NewMesh<'_>, set: UvSet) -> Option<usize> {
    match set {
        UvSet::Base => mesh.appearance.uvs.as_ref().map(|_| 0),
        UvSet::Second => second_set(mesh),
    }
}

/// The number of the second set of texture coordinates, if the mesh has one.
pub(super) fn second_set(mesh: &NewMesh<'_>) -> Option<usize> {
    let first = usize::from(mesh.appearance.uvs.is_some());
    mesh.appearance.second_uvs.as_ref().map(|_| first)
}

/// KHR_texture_transform for rows that multiply (u, v, 1): `Some(None)` for the identity, `None` if it has no such form.
fn transform([[a, b, x], [c, d, y]]: [[f32; 3]; 2]) -> Option<Option<Value>> {
    if [[a, b, x], [c, d, y]] == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        return Some(None);
    }
    // Scaled by (s, t), turned by r, shifted: the rows are (s cos r, t sin r, x) and (−s sin r, t cos r, y).
    let rotation = (-c).atan2(a);
    let (sin, cos) = rotation.sin_cos();
    let (s, t) = (a * cos - c * sin, b * sin + d * cos);
    let is_exact = (t * sin - b).abs().max((t * cos - d).abs()) <= SKEW * (s.abs() + t.abs());
    let finite = [s, t, rotation, x, y].iter().all(|number| number.is_finite());
    (is_exact && finite).then(|| Some(json!({ "offset": [x, y], "rotation": rotation, "scale": [s, t] })))
}
