//! Reading glTF: the drawn set, its numbering, and refusals.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Folder, Maker, Shape, cube, grid, open, refusal, shapes, sphere, split, try_open};
use glam::{DMat4, DQuat, DVec3};
use pliant_io::Format;
use pliant_mesh::geometry::face_normal;
use serde_json::{Value, json};

fn corners(opened: &pliant_io::SceneAndDrawn) -> Vec<[DVec3; 3]> {
    let drawn = &opened.drawn;
    drawn
        .triangles
        .iter()
        .map(|t| t.map(|corner| drawn.positions[corner.index()]))
        .collect()
}

#[test]
fn every_class_of_mesh_is_read_as_it_stands_from_every_container() {
    for (name, shape) in shapes() {
        let maker = Maker::of(&shape);
        let mut folder = Folder::default();
        folder.0.insert("a b.bin".to_owned(), maker.bin.clone());
        let files = [
            (maker.glb(), Format::Glb),
            (maker.embedded(), Format::Gltf),
            (maker.gltf("a%20b.bin"), Format::Gltf),
        ];
        for (bytes, format) in files {
            let opened = try_open(&bytes, format, &folder).unwrap();
            let wanted: Vec<DVec3> = shape
                .positions
                .iter()
                .map(|&p| glam::Vec3::from(p).as_dvec3())
                .collect();
            assert_eq!(opened.drawn.positions, wanted, "{name}");
            let triangles: Vec<[u32; 3]> = opened
                .drawn
                .triangles
                .iter()
                .map(|t| t.map(|corner| corner.0))
                .collect();
            assert_eq!(triangles, shape.triangles, "{name}");
            assert_eq!(opened.drawn.file_vertex_count, shape.positions.len());
            let looks = opened.scene.appearance();
            assert_eq!(looks.uvs.as_ref(), Some(&shape.uvs));
            assert_eq!(looks.groups.len(), 1);
            assert!(opened.scene.notes().is_empty());
        }
    }
}

#[test]
fn index_types_strides_strips_and_fans_say_the_same_triangles() {
    let shape = grid(1);
    let wanted = corners(&open(&Maker::of(&shape).glb()));
    let with = |edit: &dyn Fn(&mut Maker, &mut Value)| {
        let mut maker = Maker::default();
        let mut primitive = maker.primitive(&shape);
        edit(&mut maker, &mut primitive);
        maker.mesh_of(vec![primitive]);
        maker.node(json!({ "mesh": 0 }));
        corners(&open(&maker.glb()))
    };
    let flat: Vec<u32> = shape.triangles.as_flattened().to_vec();
    let short: Vec<u8> = flat.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect();
    let byte: Vec<u8> = flat.iter().map(|&index| index as u8).collect();
    for (bytes, kind) in [(short, 5123), (byte, 5121)] {
        let found = with(&|maker, primitive| {
            let view = maker.view(&bytes);
            let accessor = json!({ "bufferView": view, "componentType": kind, "count": 6, "type": "SCALAR" });
            primitive["indices"] = maker.accessor(accessor).into();
        });
        assert_eq!(found, wanted, "component type {kind}");
    }
    let interleaved = with(&|maker, primitive| {
        let element = |k: usize| [shape.normals[k], shape.positions[k]].concat();
        let bytes: Vec<u8> = (0..4)
            .flat_map(element)
            .flat_map(|number: f32| number.to_le_bytes())
            .collect();
        let view = maker.view(&bytes);
        maker.root["bufferViews"][view]["byteStride"] = 24.into();
        let position =
            json!({ "bufferView": view, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC3" });
        primitive["attributes"]["POSITION"] = maker.accessor(position).into();
    });
    assert_eq!(interleaved, wanted);
    let unindexed = with(&|maker, primitive| {
        let positions: Vec<[f32; 3]> = flat.iter().map(|&index| shape.positions[index as usize]).collect();
        let position = maker.floats(&positions);
        *primitive = json!({ "attributes": { "POSITION": position } });
    });
    assert_eq!(unindexed, wanted);
    let same_faces = |found: Vec<[DVec3; 3]>| {
        assert_eq!(found.len(), 2);
        for (found, wanted) in found.into_iter().zip(&wanted) {
            assert!(
                (0..3).any(|turn| (0..3).all(|k| found[(k + turn) % 3] == wanted[k])),
                "{found:?}"
            );
        }
    };
    // The grid's corners are 0 1 / 2 3, its triangles 0 1 3 and 0 3 2. The strip has a stitch at its end.
    same_faces(with(&|maker, primitive| {
        primitive["indices"] = maker.indices(&[1, 3, 0, 2, 2]).into();
        primitive["mode"] = 5.into();
    }));
    same_faces(with(&|maker, primitive| {
        primitive["indices"] = maker.indices(&[0, 1, 3, 2]).into();
        primitive["mode"] = 6.into();
    }));
}

#[test]
fn nodes_place_their_meshes_and_mirrored_ones_keep_the_outside_out() {
    let shape = sphere(6);
    let mut maker = Maker::of(&shape);
    let child = maker.loose_node(json!({ "mesh": 0, "scale": [-1.0, 2.0, 0.5], "rotation": [0.6, 0.0, 0.0, 0.8] }));
    let translation = [4_500_000.123456, 0.25, -7.0];
    maker.node(json!({ "translation": translation, "children": [child] }));
    let opened = open(&maker.glb());
    let count = shape.positions.len();
    assert_eq!(opened.drawn.positions.len(), 2 * count);
    assert_eq!(opened.drawn.file_vertex_count, count);
    assert_eq!(opened.drawn.file_vertex[count + 3], opened.drawn.file_vertex[3]);
    let rotation = DQuat::from_xyzw(0.6, 0.0, 0.0, 0.8);
    let world = DMat4::from_translation(DVec3::from(translation))
        * DMat4::from_scale_rotation_translation(DVec3::new(-1.0, 2.0, 0.5), rotation, DVec3::ZERO);
    for v in 0..count {
        let wanted = world.transform_point3(opened.drawn.positions[v]);
        assert!(opened.drawn.positions[count + v].distance(wanted) < 2e-9);
    }
    for triangle in corners(&opened) {
        let centre = if triangle[0].x > 1e6 {
            DVec3::from(translation)
        } else {
            DVec3::ZERO
        };
        let middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0 - centre;
        assert!(face_normal(triangle).dot(middle) > 0.0, "every triangle looks outwards");
    }
    let normals = opened.scene.appearance().normals.unwrap();
    for triangle in &opened.drawn.triangles {
        let geometric = face_normal(triangle.map(|corner| opened.drawn.positions[corner.index()]));
        for corner in triangle {
            let normal = glam::Vec3::from(normals[corner.index()]).as_dvec3();
            assert!((normal.length() - 1.0).abs() < 1e-6 && normal.dot(geometric) > 0.3);
        }
    }
}

#[test]
fn the_default_scene_counts_and_without_one_all_roots() {
    let mut maker = Maker::of(&grid(1));
    maker.loose_node(json!({ "mesh": 0, "children": [2] }));
    maker.loose_node(json!({ "mesh": 0 }));
    maker.root["scenes"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "name": "no nodes at all" }));
    let drawn = |maker: &Maker| open(&maker.glb()).drawn.positions.len();
    assert_eq!(drawn(&maker), 4);
    maker.root["scene"] = 1.into();
    assert_eq!(drawn(&maker), 0);
    maker.root.as_object_mut().unwrap().remove("scene");
    assert_eq!(drawn(&maker), 12);
    maker.root.as_object_mut().unwrap().remove("scenes");
    assert_eq!(drawn(&maker), 12);
}

#[test]
fn file_vertices_are_counted_in_the_order_in_which_primitives_name_their_accessors() {
    let mut maker = Maker::default();
    let [small, large] = [grid(1), grid(2)];
    let unused = maker.floats(&small.positions);
    let lines = maker.floats(&[[0.0; 3], [1.0; 3]]);
    let large = maker.primitive(&large);
    let small = maker.primitive(&small);
    maker.mesh_of(vec![small.clone()]);
    maker.mesh_of(vec![
        json!({ "attributes": { "POSITION": lines }, "mode": 1 }),
        large.clone(),
        small.clone(),
        large,
    ]);
    maker.node(json!({ "mesh": 1 }));
    maker.node(json!({ "mesh": 0 }));
    assert_eq!(unused, 0);
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.file_vertex_count, 4 + 2 + 9);
    let first: Vec<u32> = opened.drawn.file_vertex.iter().map(|file| file.0).collect();
    // Lines come after the triangles of their mesh.
    let wanted: Vec<u32> = (6..15).chain(0..4).chain(4..6).chain(0..4).collect();
    assert_eq!(
        first, wanted,
        "primitives that name the same attributes share their drawn vertices"
    );
    assert_eq!(opened.scene.summary().primitives, 5);
}

#[test]
fn a_flattened_node_is_left_out_and_named() {
    let mut maker = Maker::of(&grid(1));
    maker.node(json!({ "mesh": 0, "name": "shadow", "scale": [1, 0, 1] }));
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.positions.len(), 4);
    assert!(opened.scene.notes()[0].contains("shadow"), "{:?}", opened.scene.notes());
}

#[test]
fn sparse_and_quantised_positions_are_read() {
    let shape = grid(1);
    let sparse = |maker: &mut Maker| {
        let (indices, values) = (maker.view(&[1, 3]), maker.view(&[[0_u8; 12], [0; 12]].concat()));
        json!({
            "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values },
        })
    };
    let mut maker = Maker::of(&shape);
    let position = maker.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        .as_u64()
        .unwrap() as usize;
    maker.root["accessors"][position]["sparse"] = sparse(&mut maker);
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.positions[1], DVec3::ZERO);
    assert_eq!(
        opened.drawn.positions[2],
        glam::Vec3::from(shape.positions[2]).as_dvec3()
    );

    let mut maker = Maker::of(&shape);
    let bytes: Vec<u8> = [[-128_i8, 127, 0, 0], [0, 64, -127, 0], [1, 2, 3, 0], [4, 5, 6, 0]]
        .as_flattened()
        .iter()
        .map(|byte| byte.cast_unsigned())
        .collect();
    let view = maker.view(&bytes);
    maker.root["bufferViews"][view]["byteStride"] = 4.into();
    let accessor = json!({ "bufferView": view, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3" });
    maker.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = maker.accessor(accessor).into();
    let opened = open(&maker.glb());
    assert_eq!(opened.drawn.positions[0], DVec3::new(-1.0, 1.0, 0.0));
}

#[test]
fn what_can_not_be_read_is_one_sentence() {
    type Break = fn(&mut Maker);
    let cases: Vec<(&str, Break)> = vec![
        ("its own ancestor", |maker| {
            maker.root.as_object_mut().unwrap().remove("scene");
            maker.root["nodes"] = json!([{ "mesh": 0, "children": [1] }, { "children": [0] }]);
        }),
        ("reached twice", |maker| {
            maker.root["nodes"] = json!([{ "children": [0] }])
        }),
        ("mesh 7", |maker| maker.root["nodes"][0]["mesh"] = 7.into()),
        ("scene 3", |maker| maker.root["scene"] = 3.into()),
        ("child -1", |maker| maker.root["nodes"][0]["children"] = json!([-1])),
        ("index 9", |maker| {
            let indices = maker.indices(&[0, 1, 9]);
            maker.root["meshes"][0]["primitives"][0]["indices"] = indices.into();
        }),
        ("declares 4000000000 vertices", |maker| {
            maker.root["accessors"][0]["count"] = 4_000_000_000_u64.into()
        }),
        ("without bytes", |maker| {
            maker.root["accessors"][0]["count"] = 100_000.into();
            maker.root["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        }),
        ("buffer view 99", |maker| {
            maker.root["accessors"][0]["bufferView"] = 99.into()
        }),
        ("more than buffer view", |maker| maker.bin.truncate(20)),
        ("missing Draco data", |maker| {
            maker.root["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            maker.root["meshes"][0]["primitives"][0]["extensions"] =
                json!({ "KHR_draco_mesh_compression": { "attributes": { "POSITION": 0 } } });
        }),
        ("compressed buffer view 0, which has no buffer", |maker| {
            let buffers = maker.root["buffers"].as_array_mut().unwrap();
            buffers.push(json!({ "byteLength": 48 }));
            maker.root["bufferViews"][0]["buffer"] = 1.into();
            maker.root["bufferViews"][0]["extensions"] = json!({ "EXT_meshopt_compression": {} })
        }),
        ("buffers are not a list of objects", |maker| {
            maker.root["buffers"] = json!([true])
        }),
        ("asset.version", |maker| maker.root["asset"] = json!({})),
        ("names gone.bin", |maker| {
            maker.root["buffers"][0]["uri"] = "gone.bin".into()
        }),
        ("not the address of a file", |maker| {
            maker.root["buffers"][0]["uri"] = "https://x.org/a.bin".into()
        }),
    ];
    for (says, break_it) in cases {
        let mut maker = Maker::of(&grid(1));
        break_it(&mut maker);
        let sentence = refusal(&maker.glb());
        assert!(
            sentence.contains(says) && sentence.starts_with("test.glb ") && !sentence.contains('\n'),
            "{sentence}"
        );
    }
    assert!(refusal(b"").contains("does not begin"));
}

#[test]
fn instances_are_held_to_what_the_file_justifies() {
    let mut maker = Maker::of(&sphere(60));
    for _ in 0..3000 {
        maker.node(json!({ "mesh": 0 }));
    }
    assert!(refusal(&maker.glb()).contains("more than a file of its size"));
}

#[test]
fn materials_images_and_colours_come_with_the_looks() {
    let shape = cube();
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&shape);
    let colours: Vec<[f32; 4]> = shape.positions.iter().map(|_| [0.0, 0.5, 1.0, 1.0]).collect();
    primitive["attributes"]["COLOR_0"] = maker.floats(&colours).into();
    primitive["material"] = 0.into();
    let plain = maker.primitive(&Shape {
        uvs: vec![[0.5, 0.25]; 24],
        ..shape
    });
    maker.mesh_of(vec![primitive, plain]);
    maker.node(json!({ "mesh": 0, "name": "cube" }));
    let image = maker.view(b"\x89PNG\r\n\x1a\nnot really");
    maker.root["images"] = json!([{ "bufferView": image, "mimeType": "image/png", "name": "skin" }]);
    maker.root["samplers"] = json!([{ "wrapS": 33071 }]);
    maker.root["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    maker.root["materials"] = json!([{
        "name": "red", "doubleSided": true, "alphaMode": "MASK",
        "pbrMetallicRoughness": {
            "baseColorFactor": [1, 0, 0, 1],
            "baseColorTexture": {
                "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0], "scale": [2, 1] } },
            },
        },
    }]);
    let looks = open(&maker.glb()).scene.appearance();
    assert_eq!(
        looks.materials.len(),
        2,
        "the default material stands behind the file's own"
    );
    assert_eq!(looks.groups[1].material, 1);
    assert_eq!(looks.groups[0].node_name, "cube");
    let red = &looks.materials[0];
    assert_eq!(
        (red.base_colour, red.base_colour_image, red.double_sided),
        ([1.0, 0.0, 0.0, 1.0], Some(0), true)
    );
    assert_eq!(red.alpha, pliant_io::AlphaMode::Mask(0.5));
    assert_eq!(red.wrap, [pliant_io::Wrap::ClampToEdge, pliant_io::Wrap::Repeat]);
    assert!(looks.images[0].encoded.starts_with(b"\x89PNG") && looks.images[0].name == "skin");
    let uvs = looks.uvs.unwrap();
    assert_eq!(uvs[1][0], 2.0 * cube().uvs[1][0] + 0.5);
    assert_eq!(uvs[24], [0.5, 0.25]);
    let colours = looks.colours.unwrap();
    assert_eq!((colours[0], colours[24]), ([0, 32768, 65535, 65535], [65535; 4]));
    assert!(split(&maker.glb()).0.contains("KHR_texture_transform"));
}

#[test]
fn maps_take_the_coordinates_that_their_transforms_say() {
    let shape = cube();
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&shape);
    let second: Vec<[f32; 2]> = shape.uvs.iter().map(|&[u, v]| [v, 3.0 * u]).collect();
    primitive["attributes"]["TEXCOORD_1"] = maker.floats(&second).into();
    primitive["material"] = 0.into();
    maker.mesh_of(vec![primitive]);
    maker.node(json!({ "mesh": 0 }));
    let image = maker.view(b"\x89PNG\r\n\x1a\nnot really");
    maker.root["images"] = json!([{ "bufferView": image, "mimeType": "image/png" }]);
    maker.root["textures"] = json!([{ "source": 0 }, { "source": 9 }]);
    let moved = |offset: [f64; 2], scale: [f64; 2], rotation: f64| json!({ "KHR_texture_transform": { "offset": offset, "scale": scale, "rotation": rotation } });
    maker.root["materials"] = json!([{
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0, "extensions": moved([0.5, 0.0], [2.0, 1.0], 0.0) },
            "metallicRoughnessTexture": { "index": 0, "extensions": moved([0.5, 0.0], [2.0, 1.0], 0.0) },
        },
        "normalTexture": { "index": 0, "scale": 0.5, "extensions": moved([0.0, 0.25], [3.0, 4.0], 0.7) },
        "occlusionTexture": { "index": 0, "texCoord": 1, "strength": 0.75 },
        "emissiveTexture": { "index": 1 },
        "emissiveFactor": [1, 0.5, 0],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 4 }, "KHR_materials_unlit": {} },
    }]);
    let looks = open(&maker.glb()).scene.appearance();
    let material = &looks.materials[0];
    assert_eq!((material.normal_scale, material.occlusion_strength), (0.5, 0.75));
    assert_eq!(material.emissive, [4.0, 2.0, 0.0]);
    assert_eq!(material.lighting, pliant_io::Lighting::Unlit);
    assert_eq!(material.emissive_map, None, "an image that is not there is left out");
    assert_eq!(looks.second_uvs.as_ref(), Some(&second));
    let at = |map: pliant_io::Map, vertex: usize| {
        let [u, v] = match map.set {
            pliant_io::UvSet::Base => looks.uvs.as_ref().unwrap()[vertex],
            pliant_io::UvSet::Second => looks.second_uvs.as_ref().unwrap()[vertex],
        };
        map.transform.map(|[a, b, c]| a * u + b * v + c)
    };
    let same = material.metallic_roughness_map.unwrap();
    assert_eq!(
        same.transform,
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        "equal transforms cancel exactly"
    );
    for vertex in 0..shape.uvs.len() {
        let [u, v] = shape.uvs[vertex];
        // Scaled, turned by 0.7 and shifted, by the extension's matrices.
        let (sin, cos) = 0.7_f32.sin_cos();
        let wanted = [3.0 * u * cos + 4.0 * v * sin, 4.0 * v * cos - 3.0 * u * sin + 0.25];
        let found = at(material.normal_map.unwrap(), vertex);
        assert!(
            (found[0] - wanted[0]).abs() + (found[1] - wanted[1]).abs() < 1e-5,
            "{found:?} {wanted:?}"
        );
        assert_eq!(at(material.occlusion_map.unwrap(), vertex), second[vertex]);
    }
}
