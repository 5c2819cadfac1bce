//! A new glTF from the triangles of another: its materials have all members of the old ones, and other data that it
//! lacks is named.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::gltf_maker::{Maker, grid, open, split};
use pliant_io::{Format, SceneAndDrawn, UnsavedShape};
use pliant_mesh::{Cancel, Progress};
use serde_json::{Value, json};

/// The shape of a file as a new GLB.
fn anew(opened: &SceneAndDrawn) -> Vec<u8> {
    let drawn = &opened.drawn;
    let shape = UnsavedShape {
        positions: &drawn.positions,
        triangles: &drawn.triangles,
        polygons: None,
        file_vertex: &drawn.file_vertex,
        file_vertex_count: drawn.file_vertex_count,
        appearance: opened.scene.appearance_with_originals(),
    };
    let saved = shape
        .save(Format::Glb, "new.glb", &Progress::new(), &Cancel::new())
        .unwrap();
    saved.files[0].bytes.clone()
}

fn root(glb: &[u8]) -> Value {
    serde_json::from_str(&split(glb).0).unwrap()
}

/// A file with one shape in a material of this JSON, two textures, and two sets of texture coordinates.
fn file(material: &Value) -> Maker {
    let shape = grid(3);
    let mut maker = Maker::default();
    let mut primitive = maker.primitive(&shape);
    primitive["attributes"]["TEXCOORD_1"] = maker.floats(&shape.uvs).into();
    primitive["material"] = 0.into();
    maker.mesh_of(vec![primitive]);
    maker.node(json!({ "mesh": 0 }));
    let images = [b"\x89PNG\r\n\x1a\none", b"\x89PNG\r\n\x1a\ntwo"].map(|bytes| maker.view(bytes));
    let image = |view: usize| json!({ "bufferView": view, "mimeType": "image/png" });
    maker.root["images"] = images.map(image).to_vec().into();
    maker.root["samplers"] = json!([{ "magFilter": 9728, "minFilter": 9984, "wrapS": 33071, "name": "near" }]);
    maker.root["textures"] = json!([
        { "source": 0 }, { "source": 1, "sampler": 0, "name": "fine", "extras": { "scale": [2, 3] } },
    ]);
    maker.root["materials"] = json!([material]);
    maker
}

/// A material with members of every kind that refers to textures by this function.
fn rich(texture: impl Fn(usize, Value) -> Value) -> Value {
    json!({
        "name": "lacquer",
        "pbrMetallicRoughness": { "baseColorTexture": texture(0, json!({})), "roughnessFactor": 0.3 },
        "normalTexture": texture(1, json!({ "scale": 0.5 })),
        "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {
            "KHR_materials_ior": { "ior": 1.7 },
            "KHR_materials_clearcoat": {
                "clearcoatFactor": 0.8,
                "clearcoatTexture": texture(1, json!({ "extensions": {
                    "KHR_texture_transform": { "offset": [0.25, 0.5], "scale": [2.0, 3.0] },
                } })),
            },
            "KHR_materials_transmission": { "transmissionTexture": texture(1, json!({ "texCoord": 1 })) },
        },
        "extras": { "shop": { "index": 7, "someTexture": { "index": 1 } } },
    })
}

fn reference(texture: usize, mut further: Value) -> Value {
    further["index"] = texture.into();
    further
}

#[test]
fn a_material_has_all_of_its_members_in_the_new_file() {
    let mut material = rich(reference);
    // This set of texture coordinates is used by a plain image, too, so that it is drawn.
    material["occlusionTexture"] = json!({ "index": 0, "texCoord": 1 });
    let mut maker = file(&material);
    maker.root["extensionsRequired"] = json!(["KHR_materials_transmission"]);
    let (old, first) = (maker.glb(), anew(&open(&maker.glb())));
    let root = root(&first);
    assert_eq!(resolved(&root), resolved(&self::root(&old)));
    let used = [
        "KHR_materials_clearcoat",
        "KHR_materials_ior",
        "KHR_materials_transmission",
        "KHR_texture_transform",
    ];
    assert_eq!(root["extensionsUsed"], json!(used));
    assert_eq!(root["extensionsRequired"], json!(["KHR_materials_transmission"]));
    assert_eq!(root["images"].as_array().unwrap().len(), 2);
    // The new file is its own new file.
    assert_eq!(self::root(&anew(&open(&first))), root);
}

/// The materials of a file, with textures in place of their numbers, and images in place of theirs.
fn resolved(root: &Value) -> Value {
    fn resolve(value: &mut Value, root: &Value) {
        for (name, member) in value.as_object_mut().into_iter().flatten() {
            if name.ends_with("Texture") {
                let mut texture = root["textures"][member["index"].as_u64().unwrap() as usize].clone();
                if let Some(sampler) = texture.get("sampler").and_then(Value::as_u64) {
                    texture["sampler"] = root["samplers"][sampler as usize].clone();
                }
                let image = texture["source"].as_u64().unwrap() as usize;
                texture["source"] = root["bufferViews"][root["images"][image]["bufferView"].as_u64().unwrap() as usize]
                    ["byteLength"]
                    .clone();
                member["index"] = texture;
            } else if name != "extras" {
                resolve(member, root);
            }
        }
    }
    let mut materials = root["materials"].clone();
    let list = materials.as_array_mut().unwrap();
    list.iter_mut().for_each(|material| resolve(material, root));
    materials
}

/// The base colour's transform is applied to the drawn vertices' coordinates, so other images turn back.
#[test]
fn images_lie_where_they_did_under_a_transform_of_the_base_colour() {
    let turned = json!({ "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.0], "scale": [2.0, 2.0] } } });
    let material = rich(|texture, further| match texture {
        0 => reference(0, turned.clone()),
        _ => reference(texture, further),
    });
    let old = open(&file(&material).glb());
    let new = anew(&old);
    let material = &root(&new)["materials"][0];
    assert!(
        material["pbrMetallicRoughness"]["baseColorTexture"]
            .get("extensions")
            .is_none()
    );
    let of_normals = &material["normalTexture"]["extensions"]["KHR_texture_transform"];
    assert_eq!(
        (&of_normals["offset"], &of_normals["scale"]),
        (&json!([-0.25, 0.0]), &json!([0.5, 0.5]))
    );
    let (before, after) = (old.scene.appearance(), open(&new).scene.appearance());
    assert_eq!(before.uvs, after.uvs);
    let lies = |look: &pliant_io::Appearance| look.materials[0].normal_map.unwrap().transform;
    assert_eq!(lies(&before), lies(&after));
}

#[test]
fn data_that_the_new_file_lacks_is_named() {
    let mut material = rich(reference);
    material["extensions"]["ACME_lacquer"] = json!({ "recipe": 4 });
    let mut maker = file(&material);
    let named = |maker: &Maker, format: Format| open(&maker.glb()).scene.lost_in_new_shape(format, false).join(" ");
    maker.root["meshes"][0]["primitives"][0]["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("TANGENT");
    let plain = named(&maker, Format::Glb);
    assert_eq!(
        plain,
        "The new shape leaves out the attribute TEXCOORD_1, ACME_lacquer, images with a third set of texture \
         coordinates: keep the .glb for them."
    );
    let as_obj = named(&maker, Format::Obj);
    assert!(
        as_obj.contains("KHR_materials_clearcoat") && as_obj.contains("the extras of materials"),
        "{as_obj}"
    );

    let attribute = maker.floats(&grid(3).normals);
    maker.root["meshes"][0]["primitives"][0]["attributes"]["_HEAT"] = attribute.into();
    maker.root["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_materials_variants": { "mappings": [] } });
    maker.root["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    maker.root["extensions"] = json!({
        "KHR_lights_punctual": { "lights": [{ "type": "point" }] },
        "KHR_materials_variants": { "variants": [{ "name": "red" }] },
    });
    maker.root["asset"]["copyright"] = "A. Scanner".into();
    maker.root["nodes"][0]["translation"] = json!([1.0, 0.0, 0.0]);
    maker.root["meshes"][0]["extras"] = json!({ "made": "by hand" });
    maker.mesh(&grid(2));
    let full = named(&maker, Format::Glb);
    for part in [
        "cameras",
        "lights",
        "the tree of nodes with its transforms",
        "meshes that are not shown",
        "the copyright note",
        "the attributes TEXCOORD_1, _HEAT",
        "the extension KHR_materials_variants",
        "the extras of meshes",
    ] {
        assert!(full.contains(part), "{part} is not in {full}");
    }
}
