//! Broken files: a parser reads or refuses any bytes, and a file that it reads comes back.
//!
//! The mutations follow the structure of such files: they drop, repeat and swap lines, replace possible numbers by
//! impossible ones, flip bytes, cut and stretch. The seeds are fixed, so a failure repeats.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use std::io::Write;

use crate::fuzzing::{Chance, change_lines};
use crate::text::{folder, moved, open_in, same_bits, save};
use glam::DVec3;
use pliant_io::{Format, Placement, Save};
use pliant_mesh::{Cancel, Progress};

const STRANGE: [&str; 16] = [
    "0",
    "-1",
    "-0",
    "1",
    "2",
    "255",
    "65536",
    "4294967295",
    "-9223372036854775808",
    "18446744073709551616",
    "1e308",
    "nan",
    "-inf",
    "x",
    "",
    "1/2/3//",
];

/// One of the mutations, applied.
fn mutate(bytes: &mut Vec<u8>, chance: &mut Chance) {
    if bytes.is_empty() {
        return;
    }
    let at = chance.below(bytes.len());
    match chance.below(9) {
        0 => bytes[at] ^= 1 << chance.below(8),
        1 => bytes[at] = chance.next() as u8,
        2 => bytes.truncate(at),
        3 => {
            let end = bytes.len().min(at + chance.below(40));
            bytes.drain(at..end);
        }
        4 => {
            let end = bytes.len().min(at + chance.below(40));
            let copy = bytes[at..end].to_vec();
            let target = chance.below(bytes.len());
            bytes.splice(target..target, copy);
        }
        5 => change_lines(bytes, chance),
        6 => {
            // The number (or word) around a place becomes a strange one.
            let is_word = |byte: &u8| !byte.is_ascii_whitespace();
            let start = bytes[..at]
                .iter()
                .rposition(|byte| !is_word(byte))
                .map_or(0, |space| space + 1);
            let end = bytes[at..]
                .iter()
                .position(|byte| !is_word(byte))
                .map_or(bytes.len(), |space| at + space);
            let strange = STRANGE[chance.below(STRANGE.len())];
            bytes.splice(start..end.max(start), strange.bytes());
        }
        7 => {
            let end = bytes.len().min(at + 4);
            let fill = [0x00, 0xff, 0x7f, 0x80][chance.below(4)];
            bytes[at..end].fill(fill);
        }
        _ => {
            let noise: Vec<u8> = (0..chance.below(9)).map(|_| chance.next() as u8).collect();
            bytes.splice(at..at, noise);
        }
    }
}

/// Mutates `seeds` `runs` times and puts every file that is still read through every kind of saving.
fn survive(format: Format, seeds: &[&[u8]], runs: usize) {
    survive_packed(format, seeds, runs, |bytes| bytes);
}

/// The same for the text in a file that `packed` makes of it.
fn survive_packed(format: Format, seeds: &[&[u8]], runs: usize, packed: impl Fn(Vec<u8>) -> Vec<u8>) {
    let library = "newmtl red\nKd 1 0 0\nmap_Kd -s 1 1 tex.png\nnewmtl b\nd 0.5\nTr 1\n";
    let mut chance = Chance(0x0001_5eed ^ format.extension().len() as u64);
    let mut read_count = 0;
    for run in 0..runs {
        let mut bytes = seeds[run % seeds.len()].to_vec();
        (0..=chance.below(3)).for_each(|_| mutate(&mut bytes, &mut chance));
        let bytes = packed(bytes);
        let mut mtl = library.as_bytes().to_vec();
        mutate(&mut mtl, &mut chance);
        let mut files = folder(&[("tex.png", "png")]);
        files.0.insert("red.mtl".to_owned(), mtl);
        let Ok(opened) = open_in(&bytes, format, &files) else {
            continue;
        };
        read_count += 1;
        let drawn = &opened.drawn;
        let count = drawn.positions.len() as u32;
        assert!(drawn.triangles.iter().flatten().all(|corner| corner.0 < count));
        assert!(
            drawn
                .file_vertex
                .iter()
                .all(|vertex| vertex.index() < drawn.file_vertex_count)
        );
        let look = opened.scene.appearance();
        assert!(look.groups.iter().all(|group| group.material < look.materials.len()));
        let covered = look.groups.iter().map(|group| group.triangles.len()).sum::<usize>();
        assert_eq!(covered, drawn.triangles.len());
        assert!(look.uvs.is_none_or(|uvs| uvs.len() == drawn.positions.len()));
        assert_eq!(save(&opened, &drawn.positions), bytes, "unmoved: byte for byte");

        let shift = |p: DVec3| {
            if p.is_finite() {
                p * 0.5 + DVec3::new(0.25, -1.0, 3.0)
            } else {
                p
            }
        };
        let positions = moved(&opened, |file| file % 2 == 0, shift);
        for target in Format::ALL
            .into_iter()
            .filter(|target| !matches!(target, Format::Glb | Format::Gltf))
        {
            let name = format!("out.{}", target.extension());
            let request = Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn,
                positions: &positions,
                format: target,
                name: &name,
                placement: Placement::OtherFolder,
            };
            let Ok(saved) = opened.scene.save(&request, &Progress::new(), &Cancel::new()) else {
                continue;
            };
            let again = open_in(&saved.files[0].bytes, target, &files)
                .unwrap_or_else(|error| panic!("{error}: {:?}", String::from_utf8_lossy(&saved.files[0].bytes)));
            assert_eq!(again.drawn.triangles.len(), drawn.triangles.len());
            if target == format && target == Format::Obj {
                // Corners whose normals come to differ are drawn separately.
                assert!(same_bits(
                    &of_file(&again.drawn, &again.drawn.positions),
                    &of_file(drawn, &positions)
                ));
            }
        }
    }
    assert!(
        read_count > runs / 20,
        "the mutations are so rough that only {read_count} of {runs} files were read"
    );
}

/// The position of each file vertex.
fn of_file(drawn: &pliant_mesh::Drawn, positions: &[DVec3]) -> Vec<DVec3> {
    let mut out = vec![DVec3::ZERO; drawn.file_vertex_count];
    let each = drawn.file_vertex.iter().zip(positions);
    each.for_each(|(vertex, position)| out[vertex.index()] = *position);
    out
}

const OBJ: &[u8] = b"# made\nmtllib red.mtl\no one\nv 0 0 0 1 0 0\r\nv 1 0 0\nv 1 1 \\\n0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nvn 1 0 0\n\
usemtl red\nf 1/1/1 2/2/1 3/1/2 4\nf -1 -3 -2\ng two\nusemtl b\nf 1//1 3//1 4//2\nv 2 2 2\nf 1 3 5 4 2\ns 1\n";

const PLY: &[u8] = b"ply\nformat ascii 1.0\ncomment made\nelement vertex 5\nproperty float x\nproperty double y\nproperty float z\n\
property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
element face 3\nproperty list uchar int vertex_indices\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n\
0 0 0 0 0 1 1 2 3\n1 0 0 0 0 1 1 2 3\n1 1 0.5 0 0 1 1 2 3\n0 1 0 0 0 1 1 2 3\n2 2 2 1 0 0 9 9 9\n3 0 1 2\n4 0 1 2 3\n5 0 1 4 2 3\n6 0 1 2 -1 3 4\n";

fn binary_ply(order: &str) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty list uchar uchar marks\nelement face 2\nproperty list uchar ushort vertex_indices\nend_header\n"
    )
    .into_bytes();
    let is_big = order == "big";
    for position in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]] {
        for number in position {
            out.extend(if is_big {
                number.to_be_bytes()
            } else {
                number.to_le_bytes()
            });
        }
        out.extend([7, 2, 1, 2]);
    }
    for face in [[0u16, 1, 2], [0, 2, 3]] {
        out.push(3);
        for corner in face {
            out.extend(if is_big {
                corner.to_be_bytes()
            } else {
                corner.to_le_bytes()
            });
        }
    }
    out
}

fn binary_stl() -> Vec<u8> {
    let mut out = vec![b' '; 80];
    out.extend(2u32.to_le_bytes());
    for number in 0..2 {
        (0..12).for_each(|k| out.extend((k as f32 * 0.25 + number as f32).to_le_bytes()));
        out.extend([1, 2]);
    }
    out
}

const STL: &[u8] = b"solid made\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e-2 0\n endloop\nendfacet\n\
facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 1 0\n  vertex 0 1 0\n endloop\nendfacet\nendsolid made\n";

const OFF: &[u8] =
    b"OFF # made\n5 3 0\n0 0 0\n1 0 0 # one\n1 1 0.5\n0 1 0\n2 2 2\n3 0 1 2 255 0 0\n4 0 1 2 3\n5 0 1 4 2 3\n";

const NOFF: &[u8] = b"STCNOFF\n3 1 0\n0 0 0 0 0 1 1 0 0 0 0\n1 0 0 0 0 1 1 0 0 0 1\n0 1 0 0 0 1 1 0 0 1 1\n3 0 1 2\n";

#[test]
fn obj_survives() {
    survive(Format::Obj, &[OBJ], 6000);
}

#[test]
fn ply_survives() {
    survive(Format::Ply, &[PLY, &binary_ply("little"), &binary_ply("big")], 6000);
}

#[test]
fn stl_survives() {
    survive(Format::Stl, &[STL, &binary_stl()], 4000);
}

#[test]
fn off_survives() {
    survive(Format::Off, &[OFF, NOFF], 6000);
}

const MODEL: &[u8] = b"<model xmlns:m=\"m\">\n<resources>\n<m:colorgroup id=\"2\">\n<m:color color=\"#00FF00\"/>\n\
<m:color color=\"#0000FF80\"/>\n</m:colorgroup>\n<object id=\"1\" name=\"one\" pid=\"2\" pindex=\"0\">\n<mesh>\n<vertices>\n\
<vertex x=\"0\" y=\"0\" z=\"0\"/>\n<vertex x=\"1\" y=\"0\" z=\"0\"/>\n<vertex x=\"1\" y=\"1\" z=\"0.5\"/>\n\
<vertex x=\"0\" y=\"1\" z=\"0\"/>\n</vertices>\n<triangles>\n<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>\n\
<triangle v1=\"0\" v2=\"2\" v3=\"3\" pid=\"2\" p1=\"0\" p2=\"1\" p3=\"1\"/>\n</triangles>\n</mesh>\n</object>\n\
<object id=\"3\">\n<components>\n<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 2 0 0\"/>\n</components>\n\
</object>\n</resources>\n<build>\n<item objectid=\"3\"/>\n</build>\n</model>\n";

/// An archive with this model part.
fn threemf(model: &[u8]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    zip.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default())
        .unwrap();
    zip.write_all(model).unwrap();
    zip.finish().unwrap().into_inner()
}

#[test]
fn threemf_survives_in_its_model_and_in_its_archive() {
    survive_packed(Format::Threemf, &[MODEL], 4000, |model| threemf(&model));
    let whole = threemf(MODEL);
    let mut chance = Chance(11);
    for _ in 0..4000 {
        let mut bytes = whole.clone();
        (0..=chance.below(3)).for_each(|_| mutate(&mut bytes, &mut chance));
        if let Ok(opened) = open_in(&bytes, Format::Threemf, &folder(&[])) {
            assert_eq!(save(&opened, &opened.drawn.positions), bytes);
        }
    }
}

const LAYER: &[u8] = b"#usda 1.0\n( upAxis = \"Y\" )\ndef Xform \"R\"\n{\n double3 xformOp:translate = (1, 0, 0)\n\
uniform token[] xformOpOrder = [\"xformOp:translate\"]\n def Mesh \"A\" (\n  kind = \"component\"\n )\n {\n\
int[] faceVertexCounts = [3, 4]\n int[] faceVertexIndices = [0, 1, 2, 0, 2, 3, 4]\n\
point3f[] points = [ (0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0), (0, 0.5, 0) ]\n\
normal3f[] normals = [ (0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1) ]\n\
color3f[] primvars:displayColor = [ (1, 0, 0), (0, 1, 0) ] (\n interpolation = \"uniform\"\n )\n\
rel material:binding = </R/M>\n def GeomSubset \"S\"\n {\n int[] indices = [ 1 ]\n rel material:binding = </R/M>\n }\n }\n\
def Material \"M\"\n {\n token outputs:surface.connect = </R/M/P.outputs:surface>\n def Shader \"P\"\n {\n\
color3f inputs:diffuseColor = (1, 0, 0.5)\n token outputs:surface\n }\n }\n}\n";

fn usdz(layer: &[u8]) -> Vec<u8> {
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    zip.start_file("m.usda", stored).unwrap();
    zip.write_all(layer).unwrap();
    zip.finish().unwrap().into_inner()
}

#[test]
fn usdz_survives_in_its_layer() {
    survive_packed(Format::Usdz, &[LAYER], 3000, |layer| usdz(&layer));
}

#[test]
fn bytes_of_any_kind_survive() {
    let mut chance = Chance(7);
    for run in 0..4000 {
        let mut bytes: Vec<u8> = (0..chance.below(300)).map(|_| chance.next() as u8).collect();
        let starts: [&[u8]; 6] = [b"", b"ply\n", b"solid ", b"OFF ", b"v ", b"f 1 "];
        bytes.splice(0..0, starts[run % 6].iter().copied());
        for format in [Format::Obj, Format::Ply, Format::Stl, Format::Off] {
            if let Ok(opened) = open_in(&bytes, format, &folder(&[])) {
                assert_eq!(save(&opened, &opened.drawn.positions), bytes);
            }
        }
    }
}
