//! A mesh as glTF, its bytes spread randomly over buffers: accessors with strides and of several types, several
//! primitives, nodes that share a mesh, morph targets, materials with images.

use serde_json::{Value, json};

use super::meshes::Soup;
use crate::trials::Chance;

/// A glTF before it is a file: its JSON, whose buffers and images have no URIs yet, and their bytes.
#[derive(Clone, Debug)]
pub struct Gltf {
    pub json: Value,
    pub buffers: Vec<Vec<u8>>,
    pub images: Vec<Vec<u8>>,
}

/// A glTF of a mesh, with at most `buffers` buffers. Everything except the positions is random.
pub fn gltf(soup: &Soup, buffers: usize, image: &[u8], chance: &mut Chance) -> Gltf {
    let mut gltf = Gltf {
        json: json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }], "nodes": [],
            "meshes": [{ "primitives": [] }], "accessors": [], "bufferViews": [], "buffers": [],
        }),
        buffers: vec![Vec::new(); buffers.max(1)],
        images: Vec::new(),
    };
    let positions = gltf.vectors(&soup.positions, chance);
    let mut attributes = json!({ "POSITION": positions });
    if chance.one_in(2) {
        attributes["NORMAL"] = gltf
            .vectors(&vec![[0.0, 0.0, 1.0]; soup.positions.len()], chance)
            .into();
    }
    let pieces = 1 + chance.below(3) * chance.below(2);
    let per_piece = soup.triangles.len().div_ceil(pieces).max(1);
    for triangles in soup.triangles.chunks(per_piece) {
        let indices = gltf.indices(triangles.as_flattened(), chance);
        let mut primitive = json!({ "attributes": attributes, "indices": indices });
        if chance.one_in(4) {
            let delta = gltf.vectors(&vec![[0.1, 0.0, 0.0]; soup.positions.len()], chance);
            primitive["targets"] = json!([{ "POSITION": delta }]);
        }
        if chance.one_in(3) {
            primitive["material"] = gltf.material(image).into();
        }
        push(&mut gltf.json["meshes"][0]["primitives"], primitive);
    }
    for instance in 0..1 + chance.below(3) * chance.below(2) {
        let mut node = json!({ "mesh": 0, "name": format!("node {instance}") });
        if instance > 0 || chance.one_in(3) {
            node["translation"] = json!([instance as f64 * 40.0, 0.5, 0]);
            node["scale"] = json!(*chance.of(&[[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [2.0, 0.5, 1.0]]));
        }
        let node = push(&mut gltf.json["nodes"], node);
        push(&mut gltf.json["scenes"][0]["nodes"], node.into());
    }
    gltf.buffers.retain(|buffer| !buffer.is_empty());
    gltf.json["buffers"] = gltf
        .buffers
        .iter()
        .map(|buffer| json!({ "byteLength": buffer.len() }))
        .collect();
    gltf
}

impl Gltf {
    /// Adds a view of new bytes to one of the buffers, aligned to four bytes.
    fn view(&mut self, bytes: &[u8], chance: &mut Chance) -> usize {
        // A buffer is used only after the one before it, so that no empty one is left between two others.
        let used = self.buffers.iter().filter(|buffer| !buffer.is_empty()).count();
        let buffer = chance.below(self.buffers.len().min(used + 1));
        let at = self.buffers[buffer].len().next_multiple_of(4);
        self.buffers[buffer].resize(at, 0);
        self.buffers[buffer].extend_from_slice(bytes);
        let view = json!({ "buffer": buffer, "byteOffset": at, "byteLength": bytes.len() });
        push(&mut self.json["bufferViews"], view)
    }

    /// Adds an accessor of vectors, tightly packed or with a stride.
    fn vectors(&mut self, vectors: &[[f64; 3]], chance: &mut Chance) -> usize {
        let padding = 4 * (chance.below(3) * chance.below(2));
        let mut bytes = Vec::with_capacity(vectors.len() * (12 + padding));
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for vector in vectors {
            let vector = vector.map(|number| number as f32);
            for axis in 0..3 {
                low[axis] = low[axis].min(vector[axis]);
                high[axis] = high[axis].max(vector[axis]);
            }
            bytes.extend(vector.iter().flat_map(|number| number.to_le_bytes()));
            bytes.resize(bytes.len() + padding, 0xab);
        }
        let view = self.view(&bytes, chance);
        if padding > 0 {
            self.json["bufferViews"][view]["byteStride"] = (12 + padding).into();
        }
        push(
            &mut self.json["accessors"],
            json!({ "bufferView": view, "componentType": 5126, "count": vectors.len(), "type": "VEC3", "min": low, "max": high }),
        )
    }

    /// Adds an accessor of indices, of the smallest type that holds them or a larger one.
    fn indices(&mut self, indices: &[u32], chance: &mut Chance) -> usize {
        let most = indices.iter().max().copied().unwrap_or(0);
        let (kind, bytes): (u32, Vec<u8>) = if most < 255 && chance.one_in(2) {
            (5121, indices.iter().map(|&index| index as u8).collect())
        } else if most < 65535 && chance.one_in(2) {
            (
                5123,
                indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect(),
            )
        } else {
            (5125, indices.iter().flat_map(|index| index.to_le_bytes()).collect())
        };
        let view = self.view(&bytes, chance);
        push(
            &mut self.json["accessors"],
            json!({ "bufferView": view, "componentType": kind, "count": indices.len(), "type": "SCALAR" }),
        )
    }

    /// Adds a material with its own image.
    fn material(&mut self, image: &[u8]) -> usize {
        let number = self.images.len();
        self.images.push(image.to_vec());
        for (section, value) in [("images", json!({})), ("textures", json!({ "source": number }))] {
            if self.json[section].is_null() {
                self.json[section] = json!([]);
            }
            push(&mut self.json[section], value);
        }
        if self.json["materials"].is_null() {
            self.json["materials"] = json!([]);
        }
        push(
            &mut self.json["materials"],
            json!({ "name": "skin", "pbrMetallicRoughness": { "baseColorTexture": { "index": number } } }),
        )
    }

    /// The file as a GLB whose first buffer is the binary chunk. Other buffers and images must have URIs.
    pub fn glb(&self) -> Vec<u8> {
        glb(self.json.to_string().as_bytes(), &self.buffers[0])
    }
}

/// A GLB of the two chunks.
pub fn glb(text: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut out = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, content, padding) in [(b"JSON", text, b' '), (b"BIN\0", bin, 0)] {
        out.extend((content.len().next_multiple_of(4) as u32).to_le_bytes());
        out.extend(kind);
        out.extend(content);
        out.resize(out.len().next_multiple_of(4), padding);
    }
    let length = (out.len() as u32).to_le_bytes();
    out[8..12].copy_from_slice(&length);
    out
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
