//! The node tree: the meshes of the default scene and their world transforms.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use pliant_mesh::Cancel;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::document::json::At;
use crate::quote::quoted;
use crate::source::notes::Notes;

/// A mesh seen through a node.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Placed {
    pub node: usize,
    pub mesh: usize,
    pub world_from_node: DAffine3,
}

/// A determinant below this share of the product of the axes' lengths is a node flattened to a plane or less.
const FLAT: f64 = 1e-12;

/// The default scene's meshes in the order of its nodes, depth first; without a default scene those of all root
/// nodes. Nodes whose world transform can't be inverted are left out and named in `notes`.
///
/// A skinned mesh is placed by its node, with the positions of its POSITION accessor: joints are not applied.
pub(crate) fn placed_meshes(document: &Document, notes: &mut Notes, cancel: &Cancel) -> Result<Vec<Placed>, Fault> {
    let json = &document.json;
    let node_count = document.nodes_at.len();
    let mut children = Vec::with_capacity(node_count);
    for (node, &at) in document.nodes_at.iter().enumerate() {
        cancel.check()?;
        children.push(node_list(document, at, "children", || {
            format!("node {node} has child")
        })?);
    }
    let roots = roots(document, &children)?;
    let mut placed = Vec::new();
    let mut seen = vec![false; node_count];
    let mut open: Vec<(usize, DAffine3)> = roots.into_iter().rev().map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((node, world_from_parent)) = open.pop() {
        cancel.check()?;
        if std::mem::replace(&mut seen[node], true) {
            return Err(format!("node {node} is reached twice: its nodes are not a tree").into());
        }
        let at = document.nodes_at[node];
        let world_from_node = world_from_parent * parent_from_node(document, at);
        let mesh = document.index(at, "mesh", document.meshes_at.len(), || format!("node {node}"))?;
        if let Some(mesh) = mesh {
            if is_invertible(world_from_node) {
                placed.push(Placed {
                    node,
                    mesh,
                    world_from_node,
                });
            } else {
                let name = document.name(at);
                let called = if name.is_empty() {
                    String::new()
                } else {
                    format!(" ({})", quoted(&name))
                };
                let note = format!("Node {node}{called} is left out: its transform flattens it and can't be undone.");
                notes.add("nodes", Some(note));
            }
        }
        open.extend(children[node].iter().rev().map(|&child| (child, world_from_node)));
    }
    // A ring of nodes has no root, so it is found as nodes that were not reached.
    if json.member(json.root(), "scene").is_none() && seen.contains(&false) {
        let node = seen.iter().position(|seen| !seen).unwrap_or(0);
        return Err(format!("node {node} is its own ancestor: its nodes are not a tree").into());
    }
    Ok(placed)
}

fn roots(document: &Document, children: &[Vec<usize>]) -> Result<Vec<usize>, String> {
    let json = &document.json;
    let Some(scene) = json.member(json.root(), "scene") else {
        let mut is_child = vec![false; children.len()];
        children.iter().flatten().for_each(|&child| is_child[child] = true);
        return Ok((0..children.len()).filter(|&node| !is_child[node]).collect());
    };
    let scenes = json.member(json.root(), "scenes");
    let scenes: Vec<At> = scenes.map_or_else(Vec::new, |at| json.elements(at).collect());
    let scene = document.index_at(scene, scenes.len(), || "its default scene is scene".to_owned())?;
    node_list(document, scenes[scene], "nodes", || format!("scene {scene} names node"))
}

fn node_list(document: &Document, object: At, key: &str, what: impl Fn() -> String) -> Result<Vec<usize>, String> {
    let json = &document.json;
    let list = json.member(object, key);
    let nodes = list.into_iter().flat_map(|list| json.elements(list));
    nodes
        .map(|at| document.index_at(at, document.nodes_at.len(), &what))
        .collect()
}

/// A node's own transform: its matrix, or translation · rotation · scale. f64 from the text.
fn parent_from_node(document: &Document, node: At) -> DAffine3 {
    if let Some(matrix) = numbers::<16>(document, node, "matrix") {
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix));
    }
    let translation = numbers(document, node, "translation").map_or(DVec3::ZERO, DVec3::from_array);
    let scale = numbers(document, node, "scale").map_or(DVec3::ONE, DVec3::from_array);
    let rotation = numbers(document, node, "rotation").map_or(DQuat::IDENTITY, DQuat::from_array);
    // Files round quaternions to f32; a zero one is no rotation.
    let rotation = if rotation.length_squared() > 0.0 {
        rotation.normalize()
    } else {
        DQuat::IDENTITY
    };
    DAffine3::from_scale_rotation_translation(scale, rotation, translation)
}

fn numbers<const N: usize>(document: &Document, object: At, key: &str) -> Option<[f64; N]> {
    let json = &document.json;
    let list = json.member(object, key)?;
    let mut out = [0.0; N];
    let mut elements = json.elements(list);
    for slot in &mut out {
        *slot = json.number(elements.next()?)?;
    }
    Some(out)
}

fn is_invertible(world_from_node: DAffine3) -> bool {
    let DMat3 { x_axis, y_axis, z_axis } = world_from_node.matrix3;
    let volume = x_axis.length() * y_axis.length() * z_axis.length();
    let determinant = world_from_node.matrix3.determinant();
    world_from_node.is_finite() && determinant.abs() > FLAT * volume && world_from_node.inverse().is_finite()
}
