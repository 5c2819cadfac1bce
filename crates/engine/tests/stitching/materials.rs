//! Materials of glTFs that are cut and joined.

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_engine::load;
use pliant_engine::watch::Watch;
use pliant_io::{Appearance, Format, Group, Image, Material, Origin, UnsavedShape};
use pliant_mesh::{Cancel, Progress, WeldOptions, shapes};

use crate::made::{cut_out, merged, paths};

/// A tube with a picture, as a `.gltf` whose material has a refractive index and a texture of its clearcoat.
fn lacquered_tube(path: &Path, bytes: &[u8], ior: f64) {
    let tube = shapes::tube(24, 12, 4.0);
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let shape = UnsavedShape {
        positions: &tube.positions,
        triangles: &tube.triangles,
        polygons: None,
        file_vertex: &tube.file_vertex,
        file_vertex_count: tube.file_vertex_count,
        appearance: Appearance {
            uvs: Some(tube.positions.iter().map(|p| [p.x as f32, p.z as f32]).collect()),
            groups: vec![Group {
                triangles: 0..tube.triangles.len() as u32,
                material: 0,
                node_name: "tube".to_owned(),
            }],
            materials: vec![Material {
                name: name.clone(),
                base_colour_image: Some(0),
                ..Material::default()
            }],
            images: vec![Image {
                name: String::new(),
                encoded: bytes.to_vec().into(),
                origin: Origin::Inside,
            }],
            ..Appearance::default()
        },
    };
    let saved = shape
        .save(Format::Gltf, &name, &Progress::new(), &Cancel::new())
        .unwrap();
    for file in &saved.files {
        fs::write(path.with_file_name(&file.name), &file.bytes).unwrap();
    }
    let mut root: serde_json::Value = serde_json::from_slice(&saved.files[0].bytes).unwrap();
    root["materials"][0]["extensions"] = serde_json::json!({
        "KHR_materials_ior": { "ior": ior },
        "KHR_materials_clearcoat": { "clearcoatTexture": { "index": 0 } },
    });
    root["cameras"] = serde_json::json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    fs::write(path, root.to_string()).unwrap();
}

/// The materials of a glTF with its images' bytes.
fn materials(path: &Path) -> Vec<(serde_json::Value, Vec<u8>)> {
    let loaded = load(path, &WeldOptions::default(), &Watch::default()).unwrap();
    let root: serde_json::Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let look = loaded.scene.appearance();
    let all = root["materials"].as_array().unwrap().iter().zip(&look.materials);
    let of_material = |(value, material): (&serde_json::Value, &Material)| {
        let image = material.base_colour_image.unwrap();
        // Both references lead to one texture.
        let textures = [
            &value["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"],
            &value["pbrMetallicRoughness"]["baseColorTexture"],
        ];
        assert_eq!(textures[0], textures[1]);
        (
            value["extensions"]["KHR_materials_ior"].clone(),
            look.images[image].encoded.to_vec(),
        )
    };
    all.map(of_material).collect()
}

#[test]
fn both_parts_keep_their_whole_materials_with_their_own_images() {
    let (_folder, [first, second, selector, cut, joins, joined]) = paths([
        "first.gltf",
        "second.gltf",
        "cut.json",
        "cut.gltf",
        "joins.json",
        "joined.gltf",
    ]);
    let pictures = [&b"\x89PNG\r\n\x1a\none"[..], &b"\x89PNG\r\n\x1a\nother"[..]];
    lacquered_tube(&first, pictures[0], 1.25);
    lacquered_tube(&second, pictures[1], 1.75);
    let own = |ior: f64, picture: &[u8]| (serde_json::json!({ "ior": ior }), picture.to_vec());
    fs::write(&selector, r#"{"slab": {"axis": "z", "from": 0.8, "to": 1}}"#).unwrap();
    let warnings = cut_out(&first, &selector, &cut).unwrap();
    assert!(
        warnings.iter().any(|warning| warning.contains("cameras")),
        "{warnings:?}"
    );
    assert_eq!(materials(&cut), [own(1.25, pictures[0])]);

    let request = serde_json::json!({ "version": 1, "b": { "transform": { "translation": DVec3::Z.to_array() } } });
    fs::write(&joins, request.to_string()).unwrap();
    merged([&cut, &second], &joins, &joined).unwrap();
    assert_eq!(materials(&joined), [own(1.25, pictures[0]), own(1.75, pictures[1])]);
}
