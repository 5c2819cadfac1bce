//! Accessors and meshes with readers besides the drawn set: an edit copies them instead of writing over them.
//!
//! Everything that an extension may read counts: unless an extension is known to name none of these, every whole number
//! in it may be an accessor or a buffer view, and every one under a key about meshes may be a mesh.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::gltf::document::Document;
use crate::gltf::document::accessor::Strided;
use crate::gltf::document::json::At;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::Semantic;

/// Extensions that name neither accessors nor buffer views with plain bytes, nor meshes that an edit must not change.
const HARMLESS: [&str; 19] = [
    "EXT_instance_features",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_meshopt_compression",
    "FB_ngon_encoding",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_node_visibility",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_screencoverage",
    "VRM",
];

/// Beginnings of the names of further such extensions.
const HARMLESS_FAMILIES: [&str; 5] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "VRMC_",
];

/// The numbers that extensions name.
#[derive(Default)]
struct Named {
    numbers: BTreeSet<usize>,
    meshes: BTreeSet<usize>,
}

impl Named {
    fn of(document: &Document) -> Self {
        let json = &document.json;
        let mut named = Self::default();
        // Each value, with whether it is in an extension that may name something, and whether its key is about meshes.
        let mut open: Vec<(At, bool, bool)> = vec![(json.root(), false, false)];
        while let Some((at, is_foreign, is_mesh)) = open.pop() {
            if is_foreign && let Some(number) = whole_number(json.raw(at)) {
                named.numbers.insert(number);
                if is_mesh {
                    named.meshes.insert(number);
                }
            }
            open.extend(json.elements(at).map(|element| (element, is_foreign, is_mesh)));
            for (key, value) in json.members(at) {
                let key = json.string(key).unwrap_or_default();
                match key.as_str() {
                    // Only the program that wrote them knows them, and a number there may mean anything.
                    "extras" => {}
                    "extensions" => {
                        let each = json.members(value);
                        let each = each.map(|(name, value)| (is_foreign || !is_harmless(document, name), value));
                        open.extend(each.map(|(is_foreign, value)| (value, is_foreign, false)));
                    }
                    key => open.push((value, is_foreign, key.to_ascii_lowercase().contains("mesh"))),
                }
            }
        }
        named
    }
}

fn is_harmless(document: &Document, name: At) -> bool {
    let name = document.json.string(name).unwrap_or_default();
    HARMLESS.contains(&&*name) || HARMLESS_FAMILIES.iter().any(|family| name.starts_with(family))
}

/// A number in the notation of an index.
fn whole_number(text: &[u8]) -> Option<usize> {
    let is_whole = !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    is_whole.then(|| std::str::from_utf8(text).ok()?.parse().ok()).flatten()
}

/// The meshes that are shown or read without being drawn: by nodes of other scenes or of none, and by extensions.
pub(crate) fn meshes(document: &Document, pieces: &Pieces) -> BTreeSet<usize> {
    let json = &document.json;
    let drawn: BTreeSet<usize> = pieces.instances.iter().map(|instance| instance.node).collect();
    let others = document
        .nodes_at
        .iter()
        .enumerate()
        .filter(|(node, _)| !drawn.contains(node));
    let of_others = others.filter_map(|(_, &at)| json.number(json.member(at, "mesh")?));
    let mut meshes = Named::of(document).meshes;
    meshes.extend(of_others.map(|mesh| mesh as usize));
    meshes
}

/// Accessors with readers other than a primitive's POSITION, NORMAL or TANGENT.
pub(crate) fn accessors(document: &Document, meshes: &[Vec<Primitive>]) -> BTreeSet<usize> {
    let json = &document.json;
    let section = |key: &str| {
        json.member(json.root(), key)
            .into_iter()
            .flat_map(|list| json.elements(list))
    };
    let mut named: Vec<At> = Vec::new();
    for primitive in meshes.iter().flatten() {
        let targets = json
            .member(primitive.at, "targets")
            .into_iter()
            .flat_map(|targets| json.elements(targets));
        named.extend(targets.flat_map(|target| json.members(target)).map(|(_, value)| value));
        named.extend(json.member(primitive.at, "indices"));
        let attributes = json
            .member(primitive.at, "attributes")
            .into_iter()
            .flat_map(|at| json.members(at));
        let ours = Semantic::ALL.map(|semantic| Some(semantic.key().to_owned()));
        named.extend(
            attributes
                .filter(|&(key, _)| !ours.contains(&json.string(key)))
                .map(|(_, value)| value),
        );
    }
    named.extend(section("skins").filter_map(|skin| json.member(skin, "inverseBindMatrices")));
    let samplers = section("animations").filter_map(|animation| json.member(animation, "samplers"));
    for sampler in samplers.flat_map(|samplers| json.elements(samplers)) {
        named.extend(["input", "output"].iter().filter_map(|key| json.member(sampler, key)));
    }
    let numbers = named.into_iter().filter_map(|at| json.number(at));
    let mut elsewhere: BTreeSet<usize> = numbers.map(|number| number as usize).collect();
    let of_extensions = Named::of(document).numbers;
    if !of_extensions.is_empty() {
        let bytes = Spans::of(document, &of_extensions);
        elsewhere.extend((0..document.accessors.len()).filter(|&accessor| {
            let layout = document.layout(accessor).ok();
            let places = layout.into_iter().flat_map(|layout| {
                let sparse = layout
                    .sparse
                    .into_iter()
                    .flat_map(|sparse| [sparse.indices, sparse.values]);
                layout.dense.into_iter().chain(sparse)
            });
            of_extensions.contains(&accessor) || places.into_iter().any(|place| bytes.meet(&place))
        }));
    }
    elsewhere
}

/// Spans of bytes in buffers, disjoint and in order.
struct Spans(Vec<(usize, Range<usize>)>);

impl Spans {
    /// The bytes of the buffer views with these numbers.
    fn of(document: &Document, views: &BTreeSet<usize>) -> Self {
        let mut spans: Vec<(usize, Range<usize>)> = (views.iter())
            .filter(|&&view| view < document.views_at.len())
            .filter_map(|&view| document.place_of_view(view))
            .collect();
        spans.sort_by_key(|(buffer, range)| (*buffer, range.start));
        let mut joined: Vec<(usize, Range<usize>)> = Vec::new();
        for (buffer, range) in spans {
            match joined.last_mut() {
                Some((last, before)) if *last == buffer && range.start <= before.end => {
                    before.end = before.end.max(range.end);
                }
                _ => joined.push((buffer, range)),
            }
        }
        Self(joined)
    }

    /// Returns true if an element may share a byte with one of them.
    fn meet(&self, place: &Strided) -> bool {
        let Self(spans) = self;
        let first = spans.partition_point(|(buffer, range)| (*buffer, range.end) <= (place.buffer, place.start));
        let next = spans.get(first).filter(|(buffer, _)| *buffer == place.buffer);
        place.count > 0 && next.is_some_and(|(_, range)| range.start < place.end())
    }
}
