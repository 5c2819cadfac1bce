//! A mesh as the bytes of a GLB (glTF 2.0): positions, normals, colours and indices in one buffer, one node.

use super::mesh::Mesh;
use super::vector::Vec3;

/// The file's bytes. `name` names the mesh and its node.
///
/// Positions are rounded to f32, colours to 8 bits, linear. Indices are 16-bit if they fit.
pub fn write(mesh: &Mesh, name: &str) -> Vec<u8> {
    let count = mesh.positions.len();
    let mut buffer = Vec::new();
    let mut views = Vec::new();
    let mut view = |buffer: &mut Vec<u8>, from: usize, target: u32| {
        let length = buffer.len() - from;
        buffer.resize(buffer.len().next_multiple_of(4), 0);
        views.push(format!(
            r#"{{"buffer":0,"byteOffset":{from},"byteLength":{length},"target":{target}}}"#
        ));
        buffer.len()
    };

    let range = push(&mut buffer, &mesh.positions);
    let normals_at = view(&mut buffer, 0, 34962);
    push(&mut buffer, &mesh.normals());
    let colours_at = view(&mut buffer, normals_at, 34962);
    for c in &mesh.colours {
        buffer.extend(c.array().map(byte));
        buffer.push(255);
    }
    let indices_at = view(&mut buffer, colours_at, 34962);
    let short = count < 65_535;
    for i in mesh.triangles.iter().flatten() {
        if short {
            buffer.extend((*i as u16).to_le_bytes());
        } else {
            buffer.extend(i.to_le_bytes());
        }
    }
    let mut targets_at = view(&mut buffer, indices_at, 34963);
    let mut ranges = Vec::new();
    for (_, displacements) in &mesh.targets {
        ranges.push(push(&mut buffer, displacements));
        targets_at = view(&mut buffer, targets_at, 34962);
    }
    // Accessors have the same numbers as their views.
    let (mut morphs, mut extras, mut accessors) = (String::new(), String::new(), String::new());
    if !mesh.targets.is_empty() {
        let own = (0..mesh.targets.len()).map(|target| format!(r#"{{"POSITION":{}}}"#, 4 + target));
        morphs = format!(r#","targets":[{}]"#, own.collect::<Vec<_>>().join(","));
        let names = mesh.targets.iter().map(|(name, _)| format!("{name:?}"));
        extras = format!(
            r#","extras":{{"targetNames":[{}]}}"#,
            names.collect::<Vec<_>>().join(",")
        );
    }
    for (target, [low, high]) in ranges.iter().enumerate() {
        accessors += &format!(
            r#",{{"bufferView":{},"componentType":5126,"count":{count},"type":"VEC3","min":{low:?},"max":{high:?}}}"#,
            4 + target
        );
    }

    let index_type = if short { 5123 } else { 5125 };
    let json = format!(
        concat!(
            r#"{{"asset":{{"version":"2.0","generator":"Pliant xtask assets"}},"scene":0,"#,
            r#""scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"{name}"}}],"#,
            r#""meshes":[{{"name":"{name}","primitives":[{{"attributes":"#,
            r#"{{"POSITION":0,"NORMAL":1,"COLOR_0":2}},"indices":3,"material":0{morphs}}}]{extras}}}],"#,
            r#""materials":[{{"name":"skin","pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.8}}}}],"#,
            r#""accessors":["#,
            r#"{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3","min":{low:?},"max":{high:?}}},"#,
            r#"{{"bufferView":1,"componentType":5126,"count":{count},"type":"VEC3"}},"#,
            r#"{{"bufferView":2,"componentType":5121,"normalized":true,"count":{count},"type":"VEC4"}},"#,
            r#"{{"bufferView":3,"componentType":{index_type},"count":{indices},"type":"SCALAR"}}{accessors}],"#,
            r#""bufferViews":[{views}],"buffers":[{{"byteLength":{bytes}}}]}}"#
        ),
        name = name,
        count = count,
        low = range[0],
        high = range[1],
        morphs = morphs,
        extras = extras,
        accessors = accessors,
        index_type = index_type,
        indices = mesh.triangles.len() * 3,
        views = views.join(","),
        bytes = buffer.len(),
    );
    container(json.into_bytes(), &buffer)
}

/// Appends vectors rounded to f32; returns the least and the largest number along each axis.
fn push(buffer: &mut Vec<u8>, vectors: &[Vec3]) -> [[f32; 3]; 2] {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for vector in vectors {
        for (axis, number) in vector.array().into_iter().enumerate() {
            let number = number as f32;
            low[axis] = low[axis].min(number);
            high[axis] = high[axis].max(number);
            buffer.extend(number.to_le_bytes());
        }
    }
    [low, high]
}

/// Header, JSON chunk padded with spaces, binary chunk (a multiple of four already).
fn container(mut json: Vec<u8>, buffer: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + buffer.len();
    let mut out = Vec::with_capacity(total);
    out.extend(b"glTF");
    for number in [2, total as u32, json.len() as u32] {
        out.extend(number.to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(&json);
    out.extend((buffer.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(buffer);
    out
}

/// A number from 0 to 1 as a rounded byte.
fn byte(share: f64) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::super::vector::v;
    use super::*;

    #[test]
    fn chunks_are_aligned_and_lengths_add_up() {
        let mesh = Mesh {
            positions: vec![v(0.0, 0.0, 0.5), v(1.0, 0.0, 0.0), v(0.0, -2.0, 0.0)],
            colours: vec![v(0.0, 0.5, 1.0); 3],
            triangles: vec![[0, 1, 2]],
            targets: Vec::new(),
        };
        let bytes = write(&mesh, "one");
        let word = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize;
        assert_eq!(word(8), bytes.len());
        assert_eq!(word(12) % 4, 0);
        assert_eq!(20 + word(12) + 8 + word(20 + word(12)), bytes.len());
        let json = String::from_utf8_lossy(&bytes[20..20 + word(12)]).into_owned();
        assert!(
            json.contains(r#""min":[0.0, -2.0, 0.0],"max":[1.0, 0.0, 0.5]"#),
            "{json}"
        );
        assert!(
            json.contains(&format!(r#""byteLength":{}}}]"#, word(20 + word(12)))),
            "{json}"
        );
    }
}
