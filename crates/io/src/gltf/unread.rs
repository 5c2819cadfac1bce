//! Parts of a glTF that a new file with other vertices does not get, in words.

use std::collections::BTreeSet;

use super::Stored;
use super::appearance::originals::original;
use super::document::json::At;
use super::geometry::primitive::Mode;
use crate::quote::listed;

/// Extensions without data that a new file could lack: their geometry was decoded, or is named as lights.
const TAKEN_ALONG: [&str; 3] = ["EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", LIGHTS];

const LIGHTS: &str = "KHR_lights_punctual";

/// The members of a node's transform.
const TRANSFORM: [&str; 4] = ["matrix", "translation", "rotation", "scale"];

/// The part of its materials that a new file gets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum MaterialsKept {
    /// All that [`OriginalMaterial`](crate::OriginalMaterial) has.
    AsWritten,
    /// What is drawn.
    AsDrawn,
}

impl Stored {
    /// The parts that a new file lacks, besides skins, animations and morph targets.
    pub(crate) fn unread(&self, materials: MaterialsKept) -> Vec<String> {
        let json = &self.document.json;
        let mut parts = Vec::new();
        let has = |path: &[&str]| {
            let list = json.path(json.root(), path);
            list.is_some_and(|list| json.elements(list).next().is_some())
        };
        let scenes = json
            .member(json.root(), "scenes")
            .map_or(0, |list| json.elements(list).count());
        let asset = json.member(json.root(), "asset");
        let with_lines = self.pieces.pieces.iter().any(|piece| {
            let instance = &self.pieces.instances[piece.instance];
            let mode = self.meshes[instance.mesh][piece.primitive].mode;
            !mode.is_some_and(Mode::makes_triangles)
        });
        for (is_there, name) in [
            (has(&["cameras"]), "cameras"),
            (has(&["extensions", LIGHTS, "lights"]), "lights"),
            (with_lines, "lines and points"),
            (scenes > 1, "further scenes"),
            (self.has_unshown_meshes(), "meshes that are not shown"),
            (self.has_tree(), "the tree of nodes with its transforms"),
            (
                asset.is_some_and(|asset| json.member(asset, "copyright").is_some()),
                "the copyright note",
            ),
        ] {
            parts.extend(is_there.then(|| name.to_owned()));
        }
        let mut list = |one: &str, many: &str, names: &BTreeSet<String>| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let kind = if names.len() == 1 { one } else { many };
            parts.extend((!names.is_empty()).then(|| format!("{kind}{}", listed(&names))));
        };
        list("the attribute ", "the attributes ", &self.unread_attributes());
        list("the extension ", "the extensions ", &self.unread_extensions());
        list("", "", &self.unread_of_materials(materials));
        list("the extras of ", "the extras of ", &self.extras());
        parts
    }

    /// Attributes of the shown triangles that the drawn vertices don't have.
    fn unread_attributes(&self) -> BTreeSet<String> {
        let json = &self.document.json;
        let mut names = BTreeSet::new();
        for piece in &self.pieces.pieces {
            let mesh = self.pieces.instances[piece.instance].mesh;
            let primitive = &self.meshes[mesh][piece.primitive];
            let read = [
                primitive.position,
                primitive.normal,
                primitive.colour,
                primitive.uv,
                primitive.second_uv,
            ];
            let attributes = json.member(primitive.at, "attributes");
            for (key, value) in attributes.into_iter().flat_map(|attributes| json.members(attributes)) {
                let name = json.string(key).unwrap_or_default();
                let accessor = json.number(value).map(|number| number as usize);
                let is_of_skin = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
                if !is_of_skin && (accessor.is_none() || !read.contains(&accessor)) {
                    names.insert(name);
                }
            }
        }
        names
    }

    /// Extensions of the file, its nodes, meshes and primitives whose data is not read.
    fn unread_extensions(&self) -> BTreeSet<String> {
        let objects = self.sections().into_iter().map(|(_, at)| at);
        let mut names: BTreeSet<String> = objects.flat_map(|at| self.extension_names(at)).collect();
        names.retain(|name| !TAKEN_ALONG.contains(&&**name));
        names
    }

    fn extension_names(&self, object: At) -> Vec<String> {
        let json = &self.document.json;
        let extensions = json.member(object, "extensions");
        let members = extensions.into_iter().flat_map(|extensions| json.members(extensions));
        members.filter_map(|(name, _)| json.string(name)).collect()
    }

    /// Members of materials in words.
    fn unread_of_materials(&self, kept: MaterialsKept) -> BTreeSet<String> {
        let document = &self.document;
        let mut parts = BTreeSet::new();
        for (number, &at) in document.materials_at.iter().enumerate() {
            match (kept, original(document, number)) {
                (MaterialsKept::AsWritten, Some((_, lost))) => parts.extend(lost),
                _ => {
                    const DRAWN: [&str; 2] = ["KHR_materials_unlit", "KHR_materials_emissive_strength"];
                    let names = self.extension_names(at).into_iter();
                    parts.extend(names.filter(|name| !DRAWN.contains(&&**name)));
                    let has_extras = document.json.member(at, "extras").is_some();
                    parts.extend(has_extras.then(|| "the extras of materials".to_owned()));
                }
            }
        }
        parts
    }

    /// The kinds of objects, besides materials, that have extras.
    fn extras(&self) -> BTreeSet<String> {
        let with_extras = self.sections().into_iter().filter(|(_, at)| {
            let extras = self.document.json.member(*at, "extras");
            extras.is_some()
        });
        with_extras.map(|(kind, _)| kind.to_owned()).collect()
    }

    /// The file's objects that a new file makes anew, with their kinds.
    fn sections(&self) -> Vec<(&'static str, At)> {
        let (document, json) = (&self.document, &self.document.json);
        let mut objects = vec![("the file", json.root())];
        objects.extend(json.member(json.root(), "asset").map(|at| ("the asset", at)));
        let scenes = json.member(json.root(), "scenes");
        let scenes = scenes.into_iter().flat_map(|list| json.elements(list));
        objects.extend(scenes.map(|at| ("scenes", at)));
        objects.extend(document.nodes_at.iter().map(|&at| ("nodes", at)));
        objects.extend(document.meshes_at.iter().map(|&at| ("meshes", at)));
        let primitives = self.meshes.iter().flatten();
        objects.extend(primitives.map(|primitive| ("primitives", primitive.at)));
        objects.extend(document.images_at.iter().map(|&at| ("images", at)));
        objects
    }

    fn has_unshown_meshes(&self) -> bool {
        let mut is_shown = vec![false; self.meshes.len()];
        self.pieces
            .instances
            .iter()
            .for_each(|instance| is_shown[instance.mesh] = true);
        is_shown.contains(&false)
    }

    /// True if nodes have parents, transforms or no mesh: a new file has one node without a transform for each name.
    fn has_tree(&self) -> bool {
        let json = &self.document.json;
        self.document.nodes_at.iter().any(|&node| {
            let has = |key: &&str| json.member(node, key).is_some();
            has(&"children") || TRANSFORM.iter().any(has) || !has(&"mesh")
        })
    }
}
