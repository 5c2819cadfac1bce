//! Lists with one weight or name per target, made longer.

use crate::gltf::document::Document;
use crate::gltf::document::json::{At, Edits};
use crate::gltf::save::accessors::number;
use crate::gltf::save::morph::deltas::NewTarget;

/// The treatment of a missing list of weights.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Missing {
    /// It is written, with zeros for the earlier targets.
    Write,
    /// It is left out: the mesh's own applies.
    Leave,
}

/// Adds the targets' weights to the list of a mesh or a node with `known` earlier targets.
pub(super) fn append_weights(
    document: &Document,
    edits: &mut Edits,
    object: At,
    known: usize,
    targets: &[NewTarget],
    missing: Missing,
) {
    let json = &document.json;
    let list = json.member(object, "weights");
    let there = list.map_or(0, |list| json.elements(list).count());
    let zeros = std::iter::repeat_n("0".to_owned(), known.saturating_sub(there));
    let own = targets.iter().map(|target| number(target.weight as f32));
    let added: Vec<String> = zeros.chain(own).collect();
    match list {
        Some(list) => edits.append_elements(json, list, &added),
        None if missing == Missing::Write => {
            edits.set_member(json, object, "weights", &format!("[{}]", added.join(",")));
        }
        None => {}
    }
}

/// Adds the targets' names to those of the mesh, where exporters keep them; returns whether there was a place for them.
pub(super) fn append_names(
    document: &Document,
    edits: &mut Edits,
    mesh: At,
    known: usize,
    targets: &[NewTarget],
) -> bool {
    let json = &document.json;
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    let own = targets.iter().map(|target| quoted(&target.name));
    let extras = json.member(mesh, "extras");
    if let Some(list) = extras.and_then(|extras| json.member(extras, "targetNames")) {
        let is_whole = json.elements(list).count() == known;
        if is_whole {
            edits.append_elements(json, list, &own.collect::<Vec<_>>());
        }
        return is_whole;
    }
    let unnamed = (0..known).map(|target| quoted(&format!("target {target}")));
    let names: Vec<String> = unnamed.chain(own).collect();
    let names = format!("[{}]", names.join(","));
    match extras {
        None => edits.set_member(json, mesh, "extras", &format!("{{\"targetNames\":{names}}}")),
        Some(extras) if json.raw(extras).starts_with(b"{") => edits.set_member(json, extras, "targetNames", &names),
        Some(_) => return false,
    }
    true
}
