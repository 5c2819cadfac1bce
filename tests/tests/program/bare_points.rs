//! Points and lines without triangles: methods of space bend and save them in every format, surface methods move them
//! along or name methods that bend them, and the rest of the file stays.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_deform::{METHODS, Needs};
use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, open, run};
use serde_json::{Value, json};

/// The methods that bend points, by name.
fn methods_of_space() -> impl Iterator<Item = &'static str> {
    let methods = METHODS
        .iter()
        .filter(|declaration| (declaration.default)().needs() == Needs::Points);
    methods
        .map(|declaration| declaration.name)
        .filter(|name| *name != "identity")
}

/// The points of a slanted tube, in steps that are exact in single precision.
fn cloud() -> Vec<DVec3> {
    let exact = |x: f64| (x * 1024.0).round() / 1024.0;
    let tube = shapes::tube(12, 20, 6.0).positions;
    tube.into_iter()
        .map(|p| DVec3::from_array(p.to_array().map(exact)))
        .collect()
}

/// One end is held, the other turned and moved.
fn edit(method: &str) -> Value {
    let slab = |from: f64, to: f64| json!({ "slab": { "axis": "longest", "from": from, "to": to } });
    let mut edit = bare_edit();
    edit["method"] = json!({ "name": method });
    edit["fixed"] = slab(0.0, 0.1);
    edit["handles"] = json!([{
        "name": "end", "select": slab(0.9, 1.0),
        "transform": { "translation": [0.25, 0.5, 1.0], "rotation": [0.25, 0.0, 0.0, 0.968] },
    }]);
    edit
}

/// The finite points of a text or binary file of these points, as each format writes them.
fn files(folder: &Folder) -> Vec<std::path::PathBuf> {
    let lines = |prefix: &str| -> String {
        let line = |p: &DVec3| format!("{prefix}{} {} {}\n", p.x, p.y, p.z);
        cloud().iter().map(line).collect()
    };
    let count = cloud().len();
    let header = "property float x\nproperty float y\nproperty float z\nend_header\n";
    vec![
        folder.write("cloud.obj", format!("# a cloud\no tube\n{}p 1 2 3\n", lines("v "))),
        folder.write("cloud.off", format!("OFF\n{count} 0 0\n{}", lines(""))),
        folder.write(
            "cloud.ply",
            format!("ply\nformat ascii 1.0\nelement vertex {count}\n{header}{}", lines("")),
        ),
        folder.write("cloud.glb", glb(&points_and_lines(Beside::Nothing))),
    ]
}

/// The other content of a glTF of points.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    /// A tube of triangles, on whose vertices the points are.
    Tube,
}

/// A glTF's JSON and its buffer: points with colours, a line strip over the same accessor, and separate lines.
fn points_and_lines(beside: Beside) -> (Value, Vec<u8>) {
    let cloud = cloud();
    let mut bin: Vec<u8> = Vec::new();
    let (mut views, mut accessors) = (Vec::new(), Vec::new());
    let mut add = |bytes: Vec<u8>, mut accessor: Value| {
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
        bin.extend(bytes);
        accessor["bufferView"] = (views.len() - 1).into();
        accessors.push(accessor);
        accessors.len() - 1
    };
    let mut positions = |points: &[DVec3]| {
        let bytes = points
            .iter()
            .flat_map(|p| p.as_vec3().to_array())
            .flat_map(f32::to_le_bytes)
            .collect();
        let bound = |best: fn(DVec3, DVec3) -> DVec3| points.iter().copied().reduce(best).unwrap().as_vec3().to_array();
        add(
            bytes,
            json!({
                "componentType": 5126, "count": points.len(), "type": "VEC3",
                "min": bound(DVec3::min), "max": bound(DVec3::max),
            }),
        )
    };
    let all = positions(&cloud);
    let own = positions(&cloud[100..120]);
    let tube = (beside == Beside::Tube).then(|| positions(&cloud));
    let colours = cloud
        .iter()
        .enumerate()
        .flat_map(|(v, _)| [v as u8, 7, 9, 255])
        .collect();
    let colours = add(
        colours,
        json!({ "componentType": 5121, "normalized": true, "count": cloud.len(), "type": "VEC4" }),
    );
    let mut primitives = vec![
        json!({ "attributes": { "POSITION": all, "COLOR_0": colours }, "mode": 0 }),
        json!({ "attributes": { "POSITION": all }, "mode": 3, "extras": { "kept": [1, 2] } }),
        json!({ "attributes": { "POSITION": own }, "mode": 1 }),
    ];
    if let Some(tube) = tube {
        let corners = shapes::tube(12, 20, 6.0).triangles.into_iter().flatten();
        let bytes: Vec<u8> = corners.flat_map(|v| v.0.to_le_bytes()).collect();
        let count = bytes.len() / 4;
        let indices = add(
            bytes,
            json!({ "componentType": 5125, "count": count, "type": "SCALAR" }),
        );
        primitives.push(json!({ "attributes": { "POSITION": tube }, "indices": indices }));
    }
    let root = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": [0, 0, 2] }],
        "meshes": [{ "primitives": primitives, "name": "cloud" }],
        "buffers": [{ "byteLength": bin.len() }], "bufferViews": views, "accessors": accessors,
    });
    (root, bin)
}

fn glb((root, bin): &(Value, Vec<u8>)) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut padded = bin.clone();
    padded.resize(padded.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let mut out = [*b"glTF", word(2), word(28 + text.len() + padded.len())].concat();
    out.extend([word(text.len()), *b"JSON"].concat());
    out.extend(text);
    out.extend([word(padded.len()), *b"BIN\0"].concat());
    out.extend(padded);
    out
}

/// The JSON and the buffer of a GLB.
fn split(bytes: &[u8]) -> (Value, Vec<u8>) {
    let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let text = length(12);
    let bin = 28 + text;
    let root = serde_json::from_slice(&bytes[20..20 + text]).unwrap();
    (root, bytes[bin..bin + length(20 + text)].to_vec())
}

fn apply(folder: &Folder, file: &Path, edit: &Value, out: &Path) -> Value {
    let report = folder.at("report.json");
    folder
        .apply(file, edit, out, &["--report", report.to_str().unwrap()])
        .done();
    serde_json::from_slice(&fs::read(report).unwrap()).unwrap()
}

#[test]
fn every_method_of_space_bends_a_cloud_of_every_format_alike() {
    assert_eq!(methods_of_space().count(), 6);
    for method in methods_of_space() {
        let folder = Folder::new();
        let mut moved: Vec<Vec<DVec3>> = Vec::new();
        for file in files(&folder) {
            let before = open(&file);
            let out = folder.at(&format!("out-{}", file.file_name().unwrap().to_str().unwrap()));
            let report = apply(&folder, &file, &edit(method), &out);
            assert_eq!(report["welded_vertices"], cloud().len());
            assert!(report["free_vertices"].as_u64().unwrap() > 100);
            let after = open(&out);
            let shift = before.model.rest_positions()[0] - cloud()[0];
            let rest = before.model.rest_positions().into_iter();
            let bent: Vec<DVec3> = after.model.rest_positions().into_iter().take(cloud().len()).collect();
            let ways = rest.zip(&bent).map(|(rest, bent)| bent.distance(rest));
            let (still, far) = ways.fold((0, 0), |(still, far), way| {
                (still + usize::from(way == 0.0), far + usize::from(way > 0.8))
            });
            assert!(
                still >= 24 && far >= 24,
                "{method} {file:?}: {still} rest, {far} are far"
            );
            moved.push(bent.iter().map(|p| *p - shift).collect());
        }
        for other in &moved[1..] {
            let off = moved[0]
                .iter()
                .zip(other)
                .map(|(a, b)| a.distance(*b))
                .fold(0.0, f64::max);
            assert!(off < 2e-5, "{method}: {off:e}");
        }
    }
}

#[test]
fn all_else_of_a_gltf_of_points_and_lines_stays() {
    let folder = Folder::new();
    for beside in [Beside::Nothing, Beside::Tube] {
        let source = points_and_lines(beside);
        let file = folder.write("cloud.glb", glb(&source));
        let out = folder.at("out.glb");
        apply(&folder, &file, &edit("rbf"), &out);
        let (mut root, bin) = split(&fs::read(&out).unwrap());
        let mut wanted = source.0;
        let is_position = |accessor: &Value| accessor.get("min").is_some();
        let mut ranges = Vec::new();
        let accessors = wanted["accessors"].as_array_mut().unwrap();
        for (old, new) in accessors.iter_mut().zip(root["accessors"].as_array_mut().unwrap()) {
            if is_position(old) {
                assert_ne!(old["max"], new["max"], "the bounds are those of the bent points");
                for accessor in [old, new] {
                    accessor
                        .as_object_mut()
                        .unwrap()
                        .retain(|key, _| key != "min" && key != "max");
                }
            } else {
                ranges.push(old["bufferView"].as_u64().unwrap() as usize);
            }
        }
        assert_eq!(root, wanted, "nothing else changes, and nothing is copied");
        for view in ranges {
            let view = &wanted["bufferViews"][view];
            let [start, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
            assert_eq!(bin[start..start + length], source.1[start..start + length]);
        }
    }
}

#[test]
fn points_on_a_surface_stay_on_it_whatever_the_method() {
    for method in METHODS
        .iter()
        .map(|declaration| declaration.name)
        .filter(|name| *name != "identity")
    {
        let folder = Folder::new();
        let file = folder.write("tube.glb", glb(&points_and_lines(Beside::Tube)));
        let out = folder.at("out.glb");
        let report = apply(&folder, &file, &edit(method), &out);
        assert_eq!(
            report["welded_vertices"],
            cloud().len(),
            "{method}: the points are the tube's vertices"
        );
        let bent = open(&out).model.rest_positions();
        // The tube's vertices are drawn first, then the points and lines.
        let (tube, points) = bent.split_at(cloud().len());
        assert_eq!(points[..tube.len()], *tube, "{method}");
        assert_eq!(points[tube.len()..], tube[100..120], "{method}");
    }
}

#[test]
fn surface_methods_are_refused_on_points_alone_with_methods_of_space_as_the_remedy() {
    for declaration in METHODS.iter().filter(|declaration| declaration.name != "identity") {
        if (declaration.default)().needs() == Needs::Points {
            continue;
        }
        let folder = Folder::new();
        for file in files(&folder) {
            let out = folder.at("out.obj");
            let name = file.file_name().unwrap().to_str().unwrap();
            folder
                .apply(&file, &edit(declaration.name), &out, &[])
                .refused(1, &[name, "no triangle", declaration.name, "take `rbf` or"]);
            assert!(!out.exists());
        }
    }
}

#[test]
fn a_cloud_that_does_not_move_keeps_its_bytes() {
    let folder = Folder::new();
    for file in files(&folder) {
        let out = folder.at(&format!("out-{}", file.file_name().unwrap().to_str().unwrap()));
        let mut still = edit("rbf");
        still["handles"][0]["transform"] = json!({});
        apply(&folder, &file, &still, &out);
        assert_eq!(fs::read(&out).unwrap(), fs::read(&file).unwrap(), "{file:?}");
    }
}

#[test]
fn info_tells_of_points_that_no_triangle_uses() {
    let folder = Folder::new();
    for file in files(&folder) {
        let told: Value = serde_json::from_str(&run(["info", file.to_str().unwrap(), "--json"]).done().out).unwrap();
        assert_eq!(
            (&told["points"], &told["triangles"]),
            (&json!(cloud().len()), &json!(0))
        );
        assert_eq!(told["components"], json!([]));
        assert!(told["bounding_box"]["min"].is_array());
        let text = run(["info", file.to_str().unwrap()]).done().out;
        assert!(text.contains("that no triangle uses") && text.contains("rbf"), "{text}");
    }
    let beside = folder.write("tube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n");
    let told: Value = serde_json::from_str(&run(["info", beside.to_str().unwrap(), "--json"]).done().out).unwrap();
    assert_eq!((&told["points"], &told["welded_vertices"]), (&json!(1), &json!(4)));
    assert_eq!(told["bounding_box"]["max"], json!([1.0, 1.0, 0.0]));
    assert_eq!(told["components"].as_array().unwrap().len(), 1);
}

/// The number of pixels that are drawn in a picture without background.
fn shown(path: &Path) -> (usize, image::RgbaImage) {
    let picture = image::open(path).unwrap().into_rgba8();
    (picture.pixels().filter(|pixel| pixel.0[3] > 0).count(), picture)
}

#[test]
fn a_picture_shows_points_and_lines_at_rest_and_bent() {
    if pliant_render::Headless::new().is_err() {
        return;
    }
    let folder = Folder::new();
    for file in files(&folder) {
        let render = |name: &str, more: &[&str]| {
            let out = folder.at(name);
            let line = ["render", file.to_str().unwrap(), "--output", out.to_str().unwrap()];
            let line = line.into_iter().chain(["--size", "200x150", "--transparent"]);
            (run(line.chain(more.iter().copied()).map(ToOwned::to_owned)), out)
        };
        let (ended, out) = render("rest.png", &[]);
        ended.done();
        let (count, at_rest) = shown(&out);
        assert!(count > cloud().len(), "{file:?}: {count} pixels");
        let edit_of = |method: &str| folder.write(&format!("{method}.json"), edit(method).to_string());
        let (ended, out) = render("bent.png", &["--edit", edit_of("mls").to_str().unwrap()]);
        ended.done();
        let (count, bent) = shown(&out);
        assert!(count > cloud().len() && bent != at_rest, "{file:?}: {count} pixels");
        let (ended, _) = render("no.png", &["--edit", edit_of("arap").to_str().unwrap()]);
        ended.refused(1, &["no triangle", "arap", "rbf"]);
    }
}
