//! The nodes that show the meshes of a save.

use std::collections::HashMap;

use crate::gltf::document::Document;
use crate::gltf::save::copy_on_write::MeshCopy;

/// The nodes that show each copy after the edit, ascending.
pub(super) fn nodes_of_copies(document: &Document, copies: &[MeshCopy]) -> Vec<Vec<usize>> {
    let json = &document.json;
    let mut copy_of: HashMap<usize, usize> = HashMap::new();
    for (number, copy) in copies.iter().enumerate() {
        copy_of.extend(copy.uses.iter().map(|&(node, _)| (node, number)));
    }
    let mut nodes = vec![Vec::new(); copies.len()];
    for (node, &at) in document.nodes_at.iter().enumerate() {
        let mesh = json.member(at, "mesh").and_then(|at| json.number(at));
        // The file's own meshes come first among the copies.
        let shown = copy_of.get(&node).copied().or(mesh.map(|mesh| mesh as usize));
        if let Some(nodes) = shown.and_then(|copy| nodes.get_mut(copy)) {
            nodes.push(node);
        }
    }
    nodes
}

/// A node with copies (`EXT_mesh_gpu_instancing`) that differ after the edit.
pub(super) fn node_of_different_copies(copies: &[MeshCopy]) -> Option<usize> {
    let mut copy_of: HashMap<usize, usize> = HashMap::new();
    let uses = copies.iter().enumerate();
    let mut uses = uses.flat_map(|(number, copy)| copy.uses.iter().map(move |&(node, _)| (node, number)));
    let different = uses.find(|&(node, number)| *copy_of.entry(node).or_insert(number) != number);
    different.map(|(node, _)| node)
}
