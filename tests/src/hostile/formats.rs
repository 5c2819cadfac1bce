//! Writes a mesh in each format that has no neighbours, or only a material library.

use std::fmt::Write as _;

use super::meshes::Soup;
use crate::trials::Chance;

/// An OBJ that names the material library `library`, and a material from it.
pub fn obj(soup: &Soup, library: &str, chance: &mut Chance) -> Vec<u8> {
    let mut text = format!("# made by chance\nmtllib {library}\no part\n");
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
    }
    text += "vt 0 0\nvt 1 0\nvn 0 0 1\nusemtl skin\n";
    // Polygons and negative indices are as valid as triangles.
    let backwards = chance.one_in(3);
    let count = soup.positions.len() as i64;
    for (i, triangle) in soup.triangles.iter().enumerate() {
        if i == soup.triangles.len() / 2 {
            text += "g second\ns off\nusemtl other\n";
        }
        let [a, b, c] = triangle.map(|corner| {
            if backwards {
                i64::from(corner) - count
            } else {
                i64::from(corner) + 1
            }
        });
        match i % 3 {
            0 => writeln!(text, "f {a} {b} {c}"),
            1 => writeln!(text, "f {a}/1 {b}/2 {c}/1"),
            _ => writeln!(text, "f {a}//1 {b}//1 {c}//1"),
        }
        .unwrap();
    }
    text.into_bytes()
}

/// A material library for [`obj`].
pub fn mtl(image: &str) -> Vec<u8> {
    format!("newmtl skin\nKd 0.8 0.4 0.2\nmap_Kd {image}\nnewmtl other\nKd 1 1 1\nd 0.5\n").into_bytes()
}

/// The mesh as OFF.
pub fn off(soup: &Soup) -> Vec<u8> {
    let mut text = format!("OFF\n{} {} 0\n", soup.positions.len(), soup.triangles.len());
    for [x, y, z] in &soup.positions {
        writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
    }
    for [a, b, c] in &soup.triangles {
        writeln!(text, "3 {a} {b} {c}").unwrap();
    }
    text.into_bytes()
}

/// The mesh as PLY, as text or in either byte order, in single or double precision.
pub fn ply(soup: &Soup, chance: &mut Chance) -> Vec<u8> {
    let encoding = *chance.of(&["ascii", "binary_little_endian", "binary_big_endian"]);
    let number = *chance.of(&["float", "double"]);
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\ncomment made by chance\nelement vertex {}\nproperty {number} x\n\
         property {number} y\nproperty {number} z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        soup.positions.len(),
        soup.triangles.len()
    )
    .into_bytes();
    if encoding == "ascii" {
        let text = String::from_utf8(off(soup)).unwrap();
        bytes.extend(text.lines().skip(2).flat_map(|line| [line, "\n"].concat().into_bytes()));
        return bytes;
    }
    let is_little = encoding == "binary_little_endian";
    for value in soup.positions.as_flattened() {
        match (number, is_little) {
            ("float", true) => bytes.extend((*value as f32).to_le_bytes()),
            ("float", false) => bytes.extend((*value as f32).to_be_bytes()),
            (_, true) => bytes.extend(value.to_le_bytes()),
            (_, false) => bytes.extend(value.to_be_bytes()),
        }
    }
    for triangle in &soup.triangles {
        bytes.push(3);
        for corner in triangle {
            bytes.extend(if is_little {
                corner.to_le_bytes()
            } else {
                corner.to_be_bytes()
            });
        }
    }
    bytes
}

/// The mesh as STL, as text or binary.
pub fn stl(soup: &Soup, chance: &mut Chance) -> Vec<u8> {
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| soup.positions[corner as usize].map(|n| n as f32));
    if chance.one_in(2) {
        let mut text = "solid chance\n".to_owned();
        for triangle in &soup.triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in corners(triangle) {
                writeln!(text, "vertex {x:?} {y:?} {z:?}").unwrap();
            }
            text += "endloop\nendfacet\n";
        }
        return (text + "endsolid chance\n").into_bytes();
    }
    let mut bytes = vec![b' '; 80];
    bytes.extend((soup.triangles.len() as u32).to_le_bytes());
    for triangle in &soup.triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners(triangle).as_flattened().iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}
