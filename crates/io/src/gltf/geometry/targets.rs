//! Morph targets by their names.
//!
//! glTF names them in `extras.targetNames` of a mesh; those without a name are called `target 0`, `target 1`, ...

use glam::{DVec3, Vec3};
use pliant_mesh::Cancel;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;

/// The names of all meshes' targets, each once, in the meshes' order.
pub(crate) fn names(document: &Document, meshes: &[Vec<Primitive>]) -> Vec<String> {
    let mut names = Vec::new();
    for mesh in 0..meshes.len() {
        for name in names_of(document, meshes, mesh) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

/// The displacement of each drawn vertex when the targets of this name are applied fully, in world space; `None` if no
/// mesh has such a target.
pub(crate) fn displacements(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    vertex_count: usize,
    name: &str,
    cancel: &Cancel,
) -> Result<Option<Vec<DVec3>>, Fault> {
    let target_of: Vec<Option<usize>> = (0..meshes.len())
        .map(|mesh| names_of(document, meshes, mesh).iter().position(|own| own == name))
        .collect();
    if target_of.iter().all(Option::is_none) {
        return Ok(None);
    }
    let mut displacements = vec![DVec3::ZERO; vertex_count];
    for instance in &pieces.instances {
        cancel.check()?;
        let Some(target) = target_of[instance.mesh] else {
            continue;
        };
        let primitive = &meshes[instance.mesh][instance.primitive];
        let Some(accessor) = primitive.targets.get(target).and_then(|target| target.position) else {
            continue;
        };
        let layout = document.layout(accessor)?;
        let vertices = instance.vertices.start as usize..instance.vertices.end as usize;
        if layout.count != vertices.len() || layout.lanes != 3 {
            let reason = format!("accessor {accessor}, a morph target, is not of its base's size");
            return Err(Fault::Malformed(reason));
        }
        let applied = instance.weights.iter().find(|(own, _)| *own == target);
        let left = 1.0 - applied.map_or(0.0, |(_, weight)| *weight);
        let ways = layout.floats::<3>(document);
        for (element, (displacement, way)) in displacements[vertices].iter_mut().zip(ways).enumerate() {
            let way = Vec3::from_array(way).as_dvec3();
            *displacement = instance.pose.at(element).transform_vector3(way) * left;
        }
    }
    Ok(Some(displacements))
}

fn names_of(document: &Document, meshes: &[Vec<Primitive>], mesh: usize) -> Vec<String> {
    let json = &document.json;
    let count = meshes[mesh].iter().map(|primitive| primitive.targets.len()).max();
    let extras = json.member(document.meshes_at[mesh], "extras");
    let list = extras.and_then(|extras| json.member(extras, "targetNames"));
    let given: Vec<Option<String>> = list
        .map(|list| json.elements(list).map(|at| json.string(at)).collect())
        .unwrap_or_default();
    let name = |target: usize| {
        let given = given.get(target).cloned().flatten();
        given.unwrap_or_else(|| format!("target {target}"))
    };
    (0..count.unwrap_or(0)).map(name).collect()
}
