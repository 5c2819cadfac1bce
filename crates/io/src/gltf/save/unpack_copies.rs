//! Copies of a node (`EXT_mesh_gpu_instancing`) that differ after an edit: each becomes a node of its own below it.

use glam::DVec3;

use crate::gltf::document::Document;
use crate::gltf::geometry::instancing::{self, EXTENSION};
use crate::gltf::save::patch::Patch;
use crate::{Format, SaveError};

impl Patch<'_> {
    /// Replaces a node's copies by children, which come before its others so that all are drawn in the same order.
    /// `meshes` is the mesh of each copy.
    ///
    /// # Errors
    /// Weights of morph targets on the node, which its children would not follow.
    pub(super) fn unpack_copies(&mut self, node: usize, meshes: &[usize], format: Format) -> Result<(), SaveError> {
        let document = self.document;
        let json = &document.json;
        let at = document.nodes_at[node];
        let cannot = |what: &str| SaveError::CannotHold {
            what: format!(
                "{what} of {} that differ after the edit ({EXTENSION}),",
                document.called(node)
            ),
            format,
            remedy: "select all copies of it, or save as .obj".to_owned(),
        };
        if json.member(at, "weights").is_some() || is_weighed_by_animation(document, node) {
            return Err(cannot("the morph targets' weights of copies"));
        }
        let places = instancing::copies(document, at).ok().flatten().unwrap_or_default();
        if places.len() != meshes.len() {
            return Err(cannot("copies"));
        }
        let name = json.member(at, "name").map(|name| {
            let raw = String::from_utf8_lossy(json.raw(name)).into_owned();
            format!(",\"name\":{raw}")
        });
        let name = name.unwrap_or_default();
        let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let vector = |vector: DVec3| list(&vector.to_array());
        let first = document.nodes_at.len() + self.new_nodes.len();
        self.new_nodes.extend(places.iter().zip(meshes).map(|(place, mesh)| {
            let rotation = place.rotation.normalize().to_array();
            let rotation = if rotation.iter().all(|number| number.is_finite()) {
                format!(",\"rotation\":[{}]", list(&rotation))
            } else {
                String::new()
            };
            format!(
                "{{\"mesh\":{mesh}{name},\"translation\":[{}]{rotation},\"scale\":[{}]}}",
                vector(place.translation),
                vector(place.scale)
            )
        }));
        let numbers: Vec<String> = (first..first + places.len()).map(|number| number.to_string()).collect();
        let numbers = numbers.join(",");
        let extensions = json.member(at, "extensions");
        let is_only_one = extensions.is_some_and(|extensions| json.members(extensions).count() == 1);
        let mut removed = Vec::new();
        match extensions {
            Some(_) if is_only_one => removed.push("extensions"),
            Some(extensions) => self.edits.remove_members(json, extensions, &[EXTENSION]),
            None => {}
        }
        match json.member(at, "children") {
            Some(children) => {
                removed.push("mesh");
                let is_empty = json.elements(children).next().is_none();
                let start = json.span(children).start + 1;
                let separator = if is_empty { "" } else { "," };
                self.edits.replace(start..start, format!("{numbers}{separator}"));
            }
            None => {
                let member = json
                    .members(at)
                    .find(|&(key, _)| json.string(key).as_deref() == Some("mesh"));
                if let Some((key, value)) = member {
                    self.edits.replace(json.span(key), "\"children\"");
                    self.edits.replace(json.span(value), format!("[{numbers}]"));
                }
            }
        }
        self.edits.remove_members(json, at, &removed);
        let called = document.called(node);
        self.out.warnings.push(format!(
            "The copies that {called} shows differ after the edit, so each became a node of its own."
        ));
        Ok(())
    }
}

/// Returns true if an animation changes the weights of a node's morph targets.
fn is_weighed_by_animation(document: &Document, node: usize) -> bool {
    let json = &document.json;
    let animations = json.member(json.root(), "animations");
    let animations = animations.into_iter().flat_map(|list| json.elements(list));
    let channels = animations.filter_map(|animation| json.member(animation, "channels"));
    let mut targets = channels
        .flat_map(|channels| json.elements(channels))
        .filter_map(|channel| json.member(channel, "target"));
    targets.any(|target| {
        let path = json.member(target, "path").and_then(|path| json.string(path));
        let own = json.member(target, "node").and_then(|node| json.number(node));
        path.as_deref() == Some("weights") && own == Some(node as f64)
    })
}
