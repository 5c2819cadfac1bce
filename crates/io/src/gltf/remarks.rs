//! Notes on a glTF that is read nevertheless: on splats and directions that an edit does not turn, unknown extensions,
//! transforms that are not finite, and members that an object has twice.

use crate::gltf::document::Document;
use crate::gltf::document::json::{At, Json};
use crate::gltf::geometry::primitive::Primitive;
use crate::quote::quoted;
use crate::source::notes::Notes;

/// Adds the remarks on a document.
pub(crate) fn add(document: &Document, meshes: &[Vec<Primitive>], notes: &mut Notes) {
    splats_and_directions(document, meshes, notes);
    unknown_extensions(document, notes);
    transforms(document, notes);
    let twice = document.json.told_twice().map(|member| {
        let member = quoted(&member);
        format!("An object of its JSON has the member '{member}' more than once; the first one counts.")
    });
    notes.add("objects", twice);
}

const SPLATS: &str = "KHR_gaussian_splatting";

/// Parts of the names of attributes that have a direction.
const DIRECTED: [&str; 8] = [
    "NORMAL",
    "TANGENT",
    "DIRECTION",
    "ROTATION",
    "ORIENTATION",
    "QUATERNION",
    "VELOCITY",
    "FORCE",
];

fn splats_and_directions(document: &Document, meshes: &[Vec<Primitive>], notes: &mut Notes) {
    let json = &document.json;
    for (mesh, primitives) in meshes.iter().enumerate() {
        let called = || {
            let name = document.name(document.meshes_at[mesh]);
            match name.is_empty() {
                true => format!("mesh {mesh}"),
                false => format!("mesh {mesh} ({})", quoted(&name)),
            }
        };
        let has_splats = |primitive: &&Primitive| json.path(primitive.at, &["extensions", SPLATS]).is_some();
        let splats = primitives.iter().find(has_splats).map(|_| {
            format!(
                "The points of {} are Gaussian splats ({SPLATS}): an edit moves their centres but keeps their \
                 rotations, scales and harmonics, so a bent scan turns into needles.",
                called()
            )
        });
        let is_splats = splats.is_some();
        notes.add("meshes of splats", splats);
        let mut directed: Vec<String> = Vec::new();
        let attributes = primitives
            .iter()
            .filter_map(|primitive| json.member(primitive.at, "attributes"));
        for (key, _) in attributes.flat_map(|attributes| json.members(attributes)) {
            let name = json.string(key).unwrap_or_default();
            let is_own = !name.starts_with('_') && !name.contains(':');
            let is_of_splats = is_splats && name.starts_with(SPLATS);
            let upper = name.to_ascii_uppercase();
            let has_direction = DIRECTED.iter().any(|part| upper.contains(part));
            if has_direction && !is_own && !is_of_splats && !directed.contains(&name) {
                directed.push(name);
            }
        }
        for name in directed {
            let name = quoted(&name);
            let note = format!(
                "The attribute {name} of {} is a direction, which does not turn with an edit.",
                called()
            );
            notes.add("attributes", Some(note));
        }
    }
}

/// Extensions that are heeded, or that do not affect the picture or the saved shape.
const KNOWN: [&str; 14] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_gaussian_splatting",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

fn unknown_extensions(document: &Document, notes: &mut Notes) {
    let json = &document.json;
    let required = json.member(json.root(), "extensionsRequired");
    let names = required
        .into_iter()
        .flat_map(|list| json.elements(list))
        .filter_map(|at| json.string(at));
    for name in names.filter(|name| !KNOWN.contains(&&**name) && !name.starts_with("KHR_materials_")) {
        let name = quoted(&name);
        let note = format!("The file requires the unknown extension {name}, whose effect is not shown.");
        notes.add("extensions", Some(note));
    }
}

/// The members of a node's transform, and the count of numbers in each.
const TRANSFORMS: [(&str, usize); 4] = [("matrix", 16), ("translation", 3), ("rotation", 4), ("scale", 3)];

fn transforms(document: &Document, notes: &mut Notes) {
    let json = &document.json;
    let is_list = |list: At, count: usize| {
        let numbers: Vec<Option<f64>> = json.elements(list).map(|at| json.number(at)).collect();
        numbers.len() == count && numbers.iter().all(|number| number.is_some_and(f64::is_finite))
    };
    for (node, &at) in document.nodes_at.iter().enumerate() {
        for (key, count) in TRANSFORMS {
            let is_broken = json.member(at, key).is_some_and(|list| !is_list(list, count));
            let note = || {
                format!(
                    "The {key} of {} does not have {count} numbers and was left out.",
                    document.called(node)
                )
            };
            notes.add("nodes", is_broken.then(note));
        }
    }
}

impl Json {
    /// The name of a member that an object has twice, if there is one.
    fn told_twice(&self) -> Option<String> {
        let mut open = vec![self.root()];
        while let Some(at) = open.pop() {
            let mut keys: Vec<&[u8]> = Vec::new();
            for (key, value) in self.members(at) {
                keys.push(self.raw(key));
                open.push(value);
            }
            open.extend(self.elements(at));
            keys.sort_unstable();
            if let Some(pair) = keys.windows(2).find(|pair| pair[0] == pair[1]) {
                return serde_json::from_slice(pair[0]).ok();
            }
        }
        None
    }
}
