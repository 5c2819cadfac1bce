//! The node tree: the meshes of the default scene and their world transforms.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use pliant_mesh::Cancel;

use crate::gltf::document::Document;
use crate::gltf::document::fault::Fault;
use crate::gltf::document::json::At;
use crate::gltf::geometry::instancing;
use crate::gltf::geometry::pose::is_invertible;
use crate::gltf::geometry::skins::{self, Skin};
use crate::quote::quoted;
use crate::source::notes::Notes;

/// A mesh seen through a node.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Placed {
    pub node: usize,
    /// The number of the node's copy; 0 if there is one.
    pub copy: usize,
    pub mesh: usize,
    /// A copy has its own transform.
    pub world_from_node: DAffine3,
    /// The skin, which places bound vertices instead of the node.
    pub skin: Option<Skin>,
}

/// The default scene's meshes in the order of its nodes, depth first; without a default scene those of all root nodes.
/// Nodes whose world transform can't be inverted are left out and named in `notes`, except those whose skin places
/// their mesh.
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
    let mut shown = Vec::new();
    let mut seen = vec![false; node_count];
    let mut world = vec![DAffine3::IDENTITY; node_count];
    let mut open: Vec<(usize, DAffine3)> = roots.into_iter().rev().map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((node, world_from_parent)) = open.pop() {
        cancel.check()?;
        if std::mem::replace(&mut seen[node], true) {
            return Err(format!("node {node} is reached twice: its nodes are not a tree").into());
        }
        let at = document.nodes_at[node];
        let world_from_node = world_from_parent * parent_from_node(document, at);
        let mesh = document.index(at, "mesh", document.meshes_at.len(), || format!("node {node}"))?;
        world[node] = world_from_node;
        shown.extend(mesh.map(|mesh| (node, mesh)));
        open.extend(children[node].iter().rev().map(|&child| (child, world_from_node)));
    }
    // A ring of nodes has no root, so it is found as nodes that were not reached.
    if json.member(json.root(), "scene").is_none() && seen.contains(&false) {
        let node = seen.iter().position(|seen| !seen).unwrap_or(0);
        return Err(format!("node {node} is its own ancestor: its nodes are not a tree").into());
    }
    note_unseen(document, &seen, notes);
    place_others(document, &children, &mut seen, &mut world, cancel)?;
    let mut placed = Vec::new();
    for (node, mesh) in shown {
        cancel.check()?;
        let world_from_node = world[node];
        let skin = skins::of_node(document, document.nodes_at[node], &world).unwrap_or_else(|reason| {
            notes.add("skins", Some(unread_skin(&document.called(node), &reason)));
            None
        });
        let copies = instancing::copies(document, document.nodes_at[node]).unwrap_or_else(|reason| {
            let called = document.called(node);
            let reason = quoted(&reason);
            let note = format!("The copies of {called} can't be read ({reason}), so its mesh is shown once.");
            notes.add("nodes with copies", Some(note));
            None
        });
        let transforms = match copies {
            Some(copies) if skin.is_none() => {
                let each = copies.iter();
                each.map(|copy| world_from_node * copy.node_from_copy()).collect()
            }
            _ => vec![world_from_node],
        };
        for (copy, world_from_node) in transforms.into_iter().enumerate() {
            if skin.is_some() || is_invertible(&world_from_node) {
                placed.push(Placed {
                    node,
                    copy,
                    mesh,
                    world_from_node,
                    skin: skin.clone(),
                });
            } else {
                let called = document.called(node);
                let note = format!("The mesh of {called} is left out: its transform flattens it and can't be undone.");
                notes.add("nodes", Some(note));
            }
        }
    }
    Ok(placed)
}

/// Reports the meshes that are not drawn because the default scene does not show them, and hidden ones that are drawn.
fn note_unseen(document: &Document, seen: &[bool], notes: &mut Notes) {
    let json = &document.json;
    let has_mesh = |&node: &usize| json.member(document.nodes_at[node], "mesh").is_some();
    let unseen: Vec<usize> = (0..seen.len()).filter(|&node| !seen[node]).filter(has_mesh).collect();
    if let Some(&first) = unseen.first() {
        let nodes = if unseen.len() == 1 {
            "1 node with a mesh is"
        } else {
            &format!("{} nodes with meshes are", unseen.len())
        };
        let called = document.called(first);
        let note = format!(
            "{nodes} not drawn, because the default scene does not show them ({called} is the first); an edit does \
             not change them."
        );
        notes.add("scenes", Some(note));
    }
    let is_hidden = |&node: &usize| {
        let visible = json.path(
            document.nodes_at[node],
            &["extensions", "KHR_node_visibility", "visible"],
        );
        seen[node] && visible.is_some_and(|visible| json.raw(visible) == b"false")
    };
    let hidden: Vec<usize> = (0..seen.len()).filter(is_hidden).collect();
    if let Some(&first) = hidden.first() {
        let nodes = if hidden.len() == 1 {
            "1 node"
        } else {
            &format!("{} nodes", hidden.len())
        };
        let called = document.called(first);
        let note = format!(
            "{nodes} hidden by KHR_node_visibility ({called} is the first), but drawn here with the nodes below."
        );
        notes.add("hidden nodes", Some(note));
    }
}

/// The world transforms of the nodes that the default scene does not show, among which a skin may have its joints.
fn place_others(
    document: &Document,
    children: &[Vec<usize>],
    seen: &mut [bool],
    world: &mut [DAffine3],
    cancel: &Cancel,
) -> Result<(), Fault> {
    let mut open: Vec<(usize, DAffine3)> = loose_roots(children).map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((node, world_from_parent)) = open.pop() {
        cancel.check()?;
        if !std::mem::replace(&mut seen[node], true) {
            world[node] = world_from_parent * parent_from_node(document, document.nodes_at[node]);
        }
        let of_children = children[node].iter().filter(|child| !seen[**child]);
        open.extend(of_children.map(|&child| (child, world[node])));
    }
    Ok(())
}

/// The nodes that are no node's child.
fn loose_roots(children: &[Vec<usize>]) -> impl Iterator<Item = usize> + use<> {
    let mut is_child = vec![false; children.len()];
    children.iter().flatten().for_each(|&child| is_child[child] = true);
    (0..children.len()).filter(move |&node| !is_child[node])
}

fn roots(document: &Document, children: &[Vec<usize>]) -> Result<Vec<usize>, String> {
    let json = &document.json;
    let Some(scene) = json.member(json.root(), "scene") else {
        return Ok(loose_roots(children).collect());
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

/// The note about a skin that can't be read.
pub(super) fn unread_skin(called: &str, reason: &str) -> String {
    let reason = quoted(reason);
    format!("The skin of {called} can't be read ({reason}), so its mesh is placed by its node.")
}
