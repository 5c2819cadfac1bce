//! Small files that ask for much: one maker for each way in which reading, showing or saving could cost more than the
//! file's bytes justify. Each takes a size, to which its bytes are proportional, so that costs at one size and at twice
//! that size show whether they are proportional, too.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    reason = "a test fails by panicking, and uses what it needs"
)]

use std::fmt::Write as _;

use pliant_io::Format;

/// A file, and the contents of its neighbours: each has these bytes, under any name.
pub struct Hostile {
    pub format: Format,
    pub bytes: Vec<u8>,
    pub beside: Vec<u8>,
}

impl Hostile {
    fn new(format: Format, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            format,
            bytes: bytes.into(),
            beside: Vec::new(),
        }
    }
}

/// A maker of files, by size.
pub type Maker = fn(usize) -> Hostile;

/// Every maker with its name and the size that the tests take.
pub const MAKERS: [(&str, Maker, usize); 34] = [
    ("primitives with accessors of their own", many_primitives, 4000),
    ("primitives of one accessor", shared_primitives, 4000),
    ("lines beside one triangle", lines, 4000),
    ("morph targets through instances", morphs_through_instances, 150),
    ("morph targets by the nodes' own weights", morphs_by_nodes, 150),
    ("one strip through instances", strip_through_instances, 4000),
    ("one mesh through instances", instances, 4000),
    ("sparse elements of one place", sparse, 4000),
    ("accessors without bytes beside images", zeros_beside_images, 4000),
    ("a long name over primitives", long_name, 2000),
    ("empty primitives through instances", empty_pieces, 1000),
    ("images of one view", images_of_one_view, 2000),
    ("missing images", missing_images, 4000),
    ("images of one neighbour", images_of_one_neighbour, 2000),
    ("buffers of one neighbour", buffers_of_one_neighbour, 1000),
    ("a material with much beside it", laden_material, 3000),
    ("a long chain of nodes", chain, 4000),
    ("flat nodes", flat_nodes, 4000),
    ("animations of many meshes", animations, 1000),
    ("members of one object", members, 8000),
    ("nested lists", nested, 8000),
    ("interleaved accessors", interleaved, 3000),
    ("polygons of 256 corners", gons, 100),
    ("stars of 256 corners", stars, 100),
    ("a face of many corners, OBJ", obj_face, 20_000),
    ("a face of many corners, OFF", off_face, 20_000),
    ("a face of many corners, PLY", ply_face, 20_000),
    ("materials and groups, OBJ", obj_groups, 8000),
    ("spellings of one image, OBJ", obj_images, 2000),
    ("libraries, OBJ", obj_libraries, 4000),
    ("properties, PLY", ply_properties, 8000),
    ("elements, PLY", ply_elements, 8000),
    ("solids, STL", stl_solids, 20_000),
    ("equal triangles, OFF", duplicates, 20_000),
];

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// `count` texts from their numbers, with commas between.
fn list(count: usize, text: impl Fn(usize) -> String) -> String {
    (0..count).map(text).collect::<Vec<_>>().join(",")
}

/// A GLB from JSON members and a buffer.
fn glb(members: &str, bin: &[u8]) -> Hostile {
    let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},{members}}}");
    let mut out = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, content, padding) in [(b"JSON", text.as_bytes(), b' '), (b"BIN\0", bin, 0)] {
        out.extend((content.len().next_multiple_of(4) as u32).to_le_bytes());
        out.extend(kind);
        out.extend(content);
        out.resize(out.len().next_multiple_of(4), padding);
    }
    let length = (out.len() as u32).to_le_bytes();
    out[8..12].copy_from_slice(&length);
    Hostile::new(Format::Glb, out)
}

fn buffer(bin: &[u8]) -> String {
    let length = bin.len();
    format!("\"buffers\":[{{\"byteLength\":{length}}}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":{length}}}]")
}

const POSITIONS: &str = "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}";

/// `n` primitives, each with its own accessor over the same bytes.
pub fn many_primitives(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let primitives = list(n, |k| format!("{{\"attributes\":{{\"POSITION\":{k}}}}}"));
    let accessors = list(n, |_| POSITIONS.to_owned());
    let buffer = buffer(&bin);
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\"accessors\":[{accessors}],{buffer}"
    );
    glb(&text, &bin)
}

/// `n` primitives that all name the same accessor, which has as many elements, sparse ones among them.
pub fn shared_primitives(n: usize) -> Hostile {
    let bin = floats(&vec![1.0; 4 * n]);
    let primitives = list(n, |_| "{\"attributes\":{\"POSITION\":0},\"indices\":1}".to_owned());
    let buffer = buffer(&bin);
    let sparse = format!(
        "{{\"count\":{n},\"indices\":{{\"bufferView\":0,\"componentType\":5121}},\"values\":{{\"bufferView\":0}}}}"
    );
    let accessors = format!(
        "{{\"bufferView\":0,\"componentType\":5126,\"count\":{n},\"type\":\"VEC3\",\"sparse\":{sparse}}},\
         {{\"bufferView\":0,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}}"
    );
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\"accessors\":[{accessors}],{buffer}"
    );
    glb(&text, &bin)
}

/// One triangle, and `n` primitives of lines that name their own accessors.
pub fn lines(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let primitives = list(n, |k| {
        let mode = if k + 1 == n { 4 } else { 1 };
        format!("{{\"attributes\":{{\"POSITION\":{k}}},\"mode\":{mode}}}")
    });
    let accessors = list(n, |_| POSITIONS.to_owned());
    let buffer = buffer(&bin);
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\"accessors\":[{accessors}],{buffer}"
    );
    glb(&text, &bin)
}

fn morphs(vertices: usize, targets: usize, nodes: &str, mesh_weights: &str) -> Hostile {
    let bin = floats(&vec![0.5; 3 * vertices]);
    let targets = list(targets, |_| "{\"POSITION\":0,\"NORMAL\":0}".to_owned());
    let buffer = buffer(&bin);
    let text = format!(
        "\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"NORMAL\":0}},\
         \"targets\":[{targets}]}}]{mesh_weights}}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":{vertices},\"type\":\"VEC3\"}}],{buffer}"
    );
    glb(&text, &bin)
}

/// A mesh of `9 n` vertices and `4 n` targets that its own weights apply, through `4 n` nodes.
pub fn morphs_through_instances(n: usize) -> Hostile {
    let nodes = list(4 * n, |_| "{\"mesh\":0}".to_owned());
    let weights = list(4 * n, |_| "1".to_owned());
    morphs(9 * n, 4 * n, &nodes, &format!(",\"weights\":[{weights}]"))
}

/// A mesh of `9 n` vertices and `4 n` targets, through a dozen nodes, each with its own weights.
pub fn morphs_by_nodes(n: usize) -> Hostile {
    let nodes = list(12, |node| {
        format!(
            "{{\"mesh\":0,\"weights\":[{}]}}",
            list(4 * n, |_| (node + 1).to_string())
        )
    });
    morphs(9 * n, 4 * n, &nodes, "")
}

/// A strip of `15 n` corners of a byte each over 250 vertices, through `n / 16` nodes.
pub fn strip_through_instances(n: usize) -> Hostile {
    let count = 15 * n;
    let mut bin = floats(&(0..750).map(|k| (k * k % 101) as f32).collect::<Vec<_>>());
    let start = bin.len();
    bin.extend((0..count).map(|k| (k % 250) as u8));
    let nodes = list(n / 16, |node| format!("{{\"mesh\":0,\"translation\":[{node},0,0]}}"));
    let text = format!(
        "\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"indices\":1,\"mode\":5}}]}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":250,\"type\":\"VEC3\"}},\
         {{\"bufferView\":0,\"byteOffset\":{start},\"componentType\":5121,\"count\":{count},\"type\":\"SCALAR\"}}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// One triangle through `n` nodes, which turn it.
pub fn instances(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let nodes = list(n, |k| {
        format!(
            "{{\"mesh\":0,\"translation\":[{k},0,0],\"rotation\":[0,0,0.{},1]}}",
            k + 1
        )
    });
    let text = format!(
        "\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` primitives of an accessor of one element that declares `n` sparse ones.
pub fn sparse(n: usize) -> Hostile {
    let bin = vec![0; 4 * n + 12];
    let primitives = list(n, |_| "{\"attributes\":{\"POSITION\":0}}".to_owned());
    let sparse = format!(
        "{{\"count\":{},\"indices\":{{\"bufferView\":0,\"componentType\":5121}},\"values\":{{\"bufferView\":0}}}}",
        n / 3
    );
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\",\"sparse\":{sparse}}}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` accessors of zeros beside as many images.
pub fn zeros_beside_images(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let primitives = list(n, |k| format!("{{\"attributes\":{{\"POSITION\":{k}}}}}"));
    let accessors = list(n, |_| {
        "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}".to_owned()
    });
    let images = list(n, |_| "{\"uri\":\"data:,\"}".to_owned());
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\"accessors\":[{accessors}],\"images\":[{images}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` primitives under a node, a mesh and a material with names of `40 n` letters.
pub fn long_name(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let name = "n".repeat(40 * n);
    let primitives = list(n, |_| "{\"attributes\":{\"POSITION\":0},\"material\":0}".to_owned());
    let text = format!(
        "\"nodes\":[{{\"name\":\"{name}\",\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\
         \"materials\":[{{\"name\":\"{name}\"}}],\"accessors\":[{POSITIONS}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` primitives without a triangle through as many nodes.
pub fn empty_pieces(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let primitives = list(n, |_| "{\"attributes\":{\"POSITION\":0},\"indices\":1}".to_owned());
    let nodes = list(n, |_| "{\"mesh\":0}".to_owned());
    let text = format!(
        "\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\
         \"accessors\":[{POSITIONS},{{\"bufferView\":0,\"componentType\":5121,\"count\":2,\"type\":\"SCALAR\"}}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` images that are all of the same `40 n` bytes.
pub fn images_of_one_view(n: usize) -> Hostile {
    let mut bin = floats(&TRIANGLE);
    bin.resize(40 * n, 0);
    let images = list(n, |_| "{\"bufferView\":0,\"mimeType\":\"image/png\"}".to_owned());
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\
         \"accessors\":[{POSITIONS}],\"images\":[{images}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` images that are nowhere.
pub fn missing_images(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let images = list(n, |k| format!("{{\"uri\":\"https://x.org/{k}.png\"}}"));
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\
         \"accessors\":[{POSITIONS}],\"images\":[{images}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

fn gltf(members: &str, beside: Vec<u8>) -> Hostile {
    Hostile {
        beside,
        ..Hostile::new(Format::Gltf, format!("{{\"asset\":{{\"version\":\"2.0\"}},{members}}}"))
    }
}

/// `n` images, each shown by a material, that are the same neighbour of `100 n` bytes in other spellings.
pub fn images_of_one_neighbour(n: usize) -> Hostile {
    let images = list(n, |k| format!("{{\"uri\":\"{}a.png\"}}", "./".repeat(k % 7)));
    let mut beside = floats(&TRIANGLE);
    beside.resize(100 * n, 0);
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],\
         \"buffers\":[{{\"byteLength\":36,\"uri\":\"a.bin\"}}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}}],\
         \"images\":[{images}],\"textures\":[{}],\"materials\":[{}]",
        list(n, |k| format!("{{\"source\":{k}}}")),
        list(n, |k| format!(
            "{{\"pbrMetallicRoughness\":{{\"baseColorTexture\":{{\"index\":{k}}}}}}}"
        )),
    );
    gltf(&text, beside)
}

/// `n` buffers, each with a primitive, that are the same neighbour of `100 n` bytes in other spellings.
pub fn buffers_of_one_neighbour(n: usize) -> Hostile {
    let mut beside = floats(&TRIANGLE);
    beside.resize(100 * n, 0);
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{}]}}],\"accessors\":[{}],\"buffers\":[{}],\"bufferViews\":[{}]",
        list(n, |k| format!("{{\"attributes\":{{\"POSITION\":{k}}}}}")),
        list(n, |k| format!(
            "{{\"bufferView\":{k},\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}}"
        )),
        list(n, |k| format!(
            "{{\"byteLength\":36,\"uri\":\"{}a.bin\"}}",
            "./".repeat(k % 7)
        )),
        list(n, |k| format!("{{\"buffer\":{k},\"byteLength\":36}}")),
    );
    gltf(&text, beside)
}

/// `n` primitives of a material with `n` members.
pub fn laden_material(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let members = list(n, |k| format!("\"{k}\":0"));
    let primitives = list(n, |_| "{\"attributes\":{\"POSITION\":0},\"material\":0}".to_owned());
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{primitives}]}}],\"accessors\":[{POSITIONS}],\
         \"materials\":[{{\"extensions\":{{{members}}},\"pbrMetallicRoughness\":{{}}}}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// Nodes, each the child of the one before.
pub fn chain(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let nodes = list(n, |k| match k + 1 {
        next if next < n => format!("{{\"mesh\":0,\"children\":[{next}]}}"),
        _ => "{\"mesh\":0}".to_owned(),
    });
    let text = format!(
        "\"nodes\":[{nodes}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// Nodes that flatten their meshes, each of which could cause a message.
pub fn flat_nodes(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let nodes = list(n, |_| "{\"mesh\":0,\"scale\":[1,1,0]}".to_owned());
    let text = format!(
        "\"nodes\":[{nodes},{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` meshes with a node each, and an animation of the weights of each node.
pub fn animations(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let text = format!(
        "\"nodes\":[{}],\"meshes\":[{}],\"accessors\":[{POSITIONS},\
         {{\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"SCALAR\"}}],\
         \"animations\":[{{\"samplers\":[{{\"input\":1,\"output\":1}}],\"channels\":[{}]}}],{}",
        list(n, |k| format!("{{\"mesh\":{k}}}")),
        list(n, |_| {
            "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]}]}".to_owned()
        }),
        list(n, |k| format!(
            "{{\"sampler\":0,\"target\":{{\"node\":{k},\"path\":\"weights\"}}}}"
        )),
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// An object with `n` members.
pub fn members(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let members = list(n, |k| format!("\"{k}\":{k}"));
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],\
         \"extras\":{{{members}}},{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// Lists in lists, `n` deep.
pub fn nested(n: usize) -> Hostile {
    let bin = floats(&TRIANGLE);
    let (open, close) = ("[".repeat(n), "]".repeat(n));
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{POSITIONS}],\
         \"extras\":{open}{close},{}",
        buffer(&bin)
    );
    glb(&text, &bin)
}

/// `n` accessors of 3 interleaved elements, each moved separately.
pub fn interleaved(n: usize) -> Hostile {
    let numbers: Vec<f32> = (0..9 * n).map(|k| (k % 7) as f32 + (k / (3 * n)) as f32).collect();
    let bin = floats(&numbers);
    let text = format!(
        "\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{}]}}],\"accessors\":[{}],\
         \"buffers\":[{{\"byteLength\":{length}}}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":{length},\"byteStride\":{}}}]",
        list(n, |k| format!("{{\"attributes\":{{\"POSITION\":{k}}}}}")),
        list(n, |k| format!(
            "{{\"bufferView\":0,\"byteOffset\":{},\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}}",
            12 * k
        )),
        12 * n,
        length = bin.len()
    );
    glb(&text, &bin)
}

fn ply(vertices: &[[f32; 2]], faces: usize) -> Hostile {
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list ushort uchar vertex_indices\nend_header\n",
        vertices.len()
    )
    .into_bytes();
    for [x, y] in vertices {
        out.extend(floats(&[*x, *y, 0.0]));
    }
    for _ in 0..faces {
        out.extend((vertices.len() as u16).to_le_bytes());
        out.extend((0..vertices.len()).map(|k| k as u8));
    }
    Hostile::new(Format::Ply, out)
}

fn around(k: usize, radius: f32) -> [f32; 2] {
    let angle = k as f32 / 256.0 * std::f32::consts::TAU;
    [radius * angle.cos(), radius * angle.sin()]
}

/// `n` convex polygons.
pub fn gons(n: usize) -> Hostile {
    ply(&(0..256).map(|k| around(k, 1.0)).collect::<Vec<_>>(), n)
}

/// `n` polygons with every other corner reflex.
pub fn stars(n: usize) -> Hostile {
    ply(
        &(0..256).map(|k| around(k, 1.0 + (k % 2) as f32)).collect::<Vec<_>>(),
        n,
    )
}

pub fn obj_face(n: usize) -> Hostile {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf".to_owned();
    (0..n).for_each(|k| write!(text, " {}", k % 3 + 1).unwrap());
    Hostile::new(Format::Obj, text + "\n")
}

pub fn off_face(n: usize) -> Hostile {
    let mut text = format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{n}");
    (0..n).for_each(|k| write!(text, " {}", k % 3).unwrap());
    Hostile::new(Format::Off, text + "\n")
}

pub fn ply_face(n: usize) -> Hostile {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uint uint vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n{n}"
    );
    (0..n).for_each(|k| write!(text, " {}", k % 3).unwrap());
    Hostile::new(Format::Ply, text + "\n")
}

/// A material and a group before every face.
pub fn obj_groups(n: usize) -> Hostile {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    (0..n).for_each(|k| write!(text, "usemtl {k}\ng {k}\nf 1 2 3\n").unwrap());
    Hostile::new(Format::Obj, text)
}

/// Materials that all show one image of `100 n` bytes, in as many spellings.
pub fn obj_images(n: usize) -> Hostile {
    let mut text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n".to_owned();
    (0..n).for_each(|k| write!(text, "usemtl {k}\nf 1/1 2/1 3/1\n").unwrap());
    let mut library = String::new();
    // The library is also the image: every name has the same bytes.
    (0..n).for_each(|k| write!(library, "newmtl {k}\nmap_Kd {}a.png\n", "./".repeat(k % 40)).unwrap());
    Hostile {
        beside: library.into_bytes(),
        ..Hostile::new(Format::Obj, text)
    }
}

/// Lines that name a library of `20 n` bytes in other spellings.
pub fn obj_libraries(n: usize) -> Hostile {
    let mut text = String::new();
    (0..n).for_each(|k| writeln!(text, "mtllib {}a.mtl", "./".repeat(k % 300)).unwrap());
    text += "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    Hostile {
        beside: "newmtl a\nKd 1 1 1\n".repeat(n).into_bytes(),
        ..Hostile::new(Format::Obj, text)
    }
}

pub fn ply_properties(n: usize) -> Hostile {
    let properties: String = (0..n).map(|k| format!("property uchar p{k}\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}\
         element face 1\nproperty list uchar uint vertex_indices\nend_header\n"
    );
    let row = " 1".repeat(n);
    Hostile::new(
        Format::Ply,
        text + &format!("0 0 0{row}\n1 0 0{row}\n0 1 0{row}\n3 0 1 2\n"),
    )
}

pub fn ply_elements(n: usize) -> Hostile {
    let elements: String = (0..n).map(|k| format!("element e{k} 1\nproperty uchar p\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\n{elements}element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar uint vertex_indices\nend_header\n{}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "1\n".repeat(n)
    );
    Hostile::new(Format::Ply, text)
}

pub fn stl_solids(n: usize) -> Hostile {
    let facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
    Hostile::new(
        Format::Stl,
        "solid a\nendsolid\n".repeat(n) + "solid b\n" + facet + "endsolid\n",
    )
}

/// `n` equal triangles, and as many on one edge.
pub fn duplicates(n: usize) -> Hostile {
    let mut text = format!("OFF\n{} {} 0\n0 0 0\n1 0 0\n", n + 2, 2 * n);
    (0..n).for_each(|k| writeln!(text, "0 1 {k}").unwrap());
    (0..n).for_each(|k| write!(text, "3 0 1 2\n3 0 1 {}\n", k + 2).unwrap());
    Hostile::new(Format::Off, text)
}
