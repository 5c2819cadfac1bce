//! The common code of the glTF tests: tiny files made in code, opening and saving them without a file system, and the
//! differences between two of them.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    reason = "a test fails by panicking, and uses what it needs"
)]

use std::collections::BTreeMap;

use base64::Engine as _;
use glam::{DQuat, DVec3, Vec3};
use pliant_io::{Bytes, Format, Placement, ReadError, Resolver, Save, SaveError, Saved, SceneAndDrawn, read};
use pliant_mesh::{Cancel, Progress};
use serde_json::{Value, json};

/// Neighbours in memory.
#[derive(Clone, Default)]
pub struct Folder(pub BTreeMap<String, Vec<u8>>);

impl Resolver for Folder {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        self.0
            .get(uri)
            .cloned()
            .map(Bytes::from)
            .ok_or_else(|| "no such file".to_owned())
    }
}

/// A triangle mesh with everything that an edit carries along.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub tangents: Vec<[f32; 4]>,
    pub uvs: Vec<[f32; 2]>,
    pub triangles: Vec<[u32; 3]>,
}

/// One shape of each class: with boundary, closed with hard edges and seams, closed and smooth with poles, several
/// components, non-manifold, degenerate.
pub fn shapes() -> Vec<(&'static str, Shape)> {
    let mut several = sphere(6);
    several.join(&grid(3), Vec3::X * 3.0);
    let mut non_manifold = grid(2);
    let fin = non_manifold.positions.len() as u32;
    non_manifold.push_vertex([0.5, 0.5, 1.0], [1.0, 0.0, 0.0]);
    non_manifold.triangles.extend([[0, 4, fin], [4, 0, fin]]);
    let mut degenerate = grid(2);
    degenerate.triangles.extend([[0, 0, 1], [0, 1, 2], [4, 4, 4]]);
    vec![
        ("boundary", grid(4)),
        ("closed, hard edges", cube()),
        ("closed, smooth", sphere(8)),
        ("several components", several),
        ("non-manifold", non_manifold),
        ("degenerate", degenerate),
    ]
}

/// A curved square of n × n cells, with smooth normals.
pub fn grid(n: u32) -> Shape {
    let mut shape = Shape::default();
    for y in 0..=n {
        for x in 0..=n {
            let [u, v] = [x as f32 / n as f32, y as f32 / n as f32];
            let slope = [0.6 * (3.0 * u).cos(), -0.4 * (2.0 * v).sin()];
            let normal = Vec3::new(-slope[0], -slope[1], 1.0).normalize();
            shape.push_vertex([u, v, 0.2 * (3.0 * u).sin() + 0.2 * (2.0 * v).cos()], normal.to_array());
        }
    }
    for y in 0..n {
        for x in 0..n {
            let a = y * (n + 1) + x;
            shape
                .triangles
                .extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    shape
}

/// A cube of 24 vertices: hard edges.
pub fn cube() -> Shape {
    let mut shape = Shape::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0_f32] {
            let first = shape.positions.len() as u32;
            for [a, b] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f32]] {
                let mut position = [0.0; 3];
                position[axis] = sign;
                position[(axis + 1) % 3] = a;
                position[(axis + 2) % 3] = b;
                let mut normal = [0.0; 3];
                normal[axis] = sign;
                shape.push_vertex(position, normal);
            }
            let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
            shape.triangles.extend(if sign > 0.0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, c, b], [a, d, c]]
            });
        }
    }
    shape
}

/// A sphere of rings, with a texture seam: the first and last meridian are twins of equal position and normal.
pub fn sphere(n: u32) -> Shape {
    let mut shape = Shape::default();
    for ring in 0..=n {
        for step in 0..=2 * n {
            let latitude = ring as f32 / n as f32 * std::f32::consts::PI;
            let longitude = (step % (2 * n)) as f32 / n as f32 * std::f32::consts::PI;
            let sin = if ring % n == 0 { 0.0 } else { latitude.sin() };
            let p = Vec3::new(sin * longitude.cos(), sin * longitude.sin(), latitude.cos());
            shape.push_vertex(p.to_array(), p.normalize().to_array());
            shape.uvs.last_mut().unwrap()[0] = step as f32 / (2 * n) as f32;
        }
    }
    for ring in 0..n {
        for step in 0..2 * n {
            let a = ring * (2 * n + 1) + step;
            let b = a + 2 * n + 1;
            if ring > 0 {
                shape.triangles.push([a, b, a + 1]);
            }
            if ring + 1 < n {
                shape.triangles.push([a + 1, b, b + 1]);
            }
        }
    }
    shape
}

impl Shape {
    pub fn push_vertex(&mut self, position: [f32; 3], normal: [f32; 3]) {
        let side = Vec3::from(normal).any_orthonormal_vector();
        self.positions.push(position);
        self.normals.push(normal);
        self.tangents.push(
            side.extend(if self.positions.len().is_multiple_of(2) {
                1.0
            } else {
                -1.0
            })
            .to_array(),
        );
        self.uvs.push([position[0], position[1]]);
    }

    pub fn join(&mut self, other: &Self, by: Vec3) {
        let first = self.positions.len() as u32;
        self.positions
            .extend(other.positions.iter().map(|&p| (Vec3::from(p) + by).to_array()));
        self.normals.extend(&other.normals);
        self.tangents.extend(&other.tangents);
        self.uvs.extend(&other.uvs);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|corner| corner + first)));
    }
}

/// A glTF under construction.
#[derive(Clone, Debug)]
pub struct Maker {
    pub root: Value,
    pub bin: Vec<u8>,
}

impl Default for Maker {
    fn default() -> Self {
        Self {
            root: json!({
                "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }],
                "nodes": [], "meshes": [], "accessors": [], "bufferViews": [], "buffers": [{ "byteLength": 0 }],
            }),
            bin: Vec::new(),
        }
    }
}

impl Maker {
    /// A file that shows `shape` through one node.
    pub fn of(shape: &Shape) -> Self {
        let mut maker = Self::default();
        maker.mesh(shape);
        maker.node(json!({ "mesh": 0 }));
        maker
    }

    fn push(&mut self, section: &str, value: Value) -> usize {
        let list = self.root[section].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() });
        self.bin.extend_from_slice(bytes);
        self.root["buffers"][0]["byteLength"] = self.bin.len().into();
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, accessor: Value) -> usize {
        self.push("accessors", accessor)
    }

    /// An accessor of f32 in its own view, with min and max.
    pub fn floats<const N: usize>(&mut self, elements: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = elements
            .iter()
            .flatten()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N)
                .map(|lane| elements.iter().map(|element| element[lane]).reduce(pick).unwrap())
                .collect()
        };
        self.accessor(json!({
            "bufferView": view, "componentType": 5126, "count": elements.len(), "type": format!("VEC{N}"),
            "min": bound(f32::min), "max": bound(f32::max),
        }))
    }

    pub fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(json!({ "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR" }))
    }

    /// A primitive with all of the shape's attributes.
    pub fn primitive(&mut self, shape: &Shape) -> Value {
        let attributes = json!({
            "POSITION": self.floats(&shape.positions), "NORMAL": self.floats(&shape.normals),
            "TANGENT": self.floats(&shape.tangents), "TEXCOORD_0": self.floats(&shape.uvs),
        });
        json!({ "attributes": attributes, "indices": self.indices(shape.triangles.as_flattened()) })
    }

    pub fn mesh(&mut self, shape: &Shape) -> usize {
        let primitive = self.primitive(shape);
        self.mesh_of(vec![primitive])
    }

    pub fn mesh_of(&mut self, primitives: Vec<Value>) -> usize {
        self.push("meshes", json!({ "primitives": primitives }))
    }

    /// A node of the default scene.
    pub fn node(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        self.root["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(node.into());
        node
    }

    /// A node of no scene.
    pub fn loose_node(&mut self, node: Value) -> usize {
        self.push("nodes", node)
    }

    pub fn glb(&self) -> Vec<u8> {
        glb(self.root.to_string().as_bytes(), &self.bin)
    }

    /// A `.gltf` whose buffer is the neighbour `uri`.
    pub fn gltf(&self, uri: &str) -> Vec<u8> {
        let mut root = self.root.clone();
        root["buffers"][0]["uri"] = uri.into();
        format!("{root:#}\n").into_bytes()
    }

    /// A `.gltf` that contains its buffer.
    pub fn embedded(&self) -> Vec<u8> {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bin);
        self.gltf(&format!("data:application/octet-stream;base64,{data}"))
    }
}

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

/// The JSON and the BIN chunk of a GLB.
pub fn split(glb: &[u8]) -> (String, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    let json_end = 20 + word(12);
    assert_eq!(word(8), glb.len(), "the header tells the length");
    assert_eq!(json_end % 4, 0);
    let bin = glb.get(json_end + 8..json_end + 8 + word(json_end)).unwrap();
    (String::from_utf8(glb[20..json_end].to_vec()).unwrap(), bin.to_vec())
}

pub fn try_open(bytes: &[u8], format: Format, folder: &Folder) -> Result<SceneAndDrawn, ReadError> {
    let name = format!("test.{}", format.extension());
    read(bytes.to_vec(), format, &name, folder, &Progress::new(), &Cancel::new())
}

pub fn open(glb: &[u8]) -> SceneAndDrawn {
    try_open(glb, Format::Glb, &Folder::default()).unwrap()
}

/// The message of a refused GLB.
pub fn refusal(glb: &[u8]) -> String {
    match try_open(glb, Format::Glb, &Folder::default()) {
        Ok(opened) => panic!("was read: {:?}", opened.drawn),
        Err(error) => error.to_string(),
    }
}

pub fn try_save(
    opened: &SceneAndDrawn,
    positions: &[DVec3],
    name: &str,
    placement: Placement,
) -> Result<Saved, SaveError> {
    let format = Format::of_name(name).unwrap();
    opened.scene.save(
        &Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions,
            format,
            name,
            placement,
        },
        &Progress::new(),
        &Cancel::new(),
    )
}

/// The GLB of an edited GLB.
pub fn saved_glb(opened: &SceneAndDrawn, positions: &[DVec3]) -> Vec<u8> {
    let saved = try_save(opened, positions, "out.glb", Placement::OtherFolder).unwrap();
    assert_eq!(saved.files.len(), 1);
    saved.files[0].bytes.clone()
}

/// New positions: those of the drawn vertices for which `which` is true, moved.
pub fn moved(opened: &SceneAndDrawn, which: impl Fn(usize) -> bool, to: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
    let one = |(v, &p): (usize, &DVec3)| if which(v) { to(p) } else { p };
    opened.drawn.positions.iter().enumerate().map(one).collect()
}

/// A smooth bend that turns every normal.
pub fn bent(p: DVec3) -> DVec3 {
    DQuat::from_rotation_x(0.4 * p.y + 0.3) * p + DVec3::new(0.1 * p.y * p.y, 0.0, 0.2 * p.x)
}

/// Asserts that positions are equal to f32's rounding of numbers of size `size`.
pub fn assert_near(found: &[DVec3], wanted: &[DVec3], size: f64) {
    assert_eq!(found.len(), wanted.len());
    for (v, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        assert!(
            found.distance(*wanted) <= 3e-7 * size,
            "vertex {v} is at {found}, not at {wanted}"
        );
    }
}
