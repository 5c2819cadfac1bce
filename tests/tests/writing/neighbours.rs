//! Files that are read and written together: none is lost, even if several files share it.

use std::fs;
use std::os::unix::fs::symlink;

use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, open, run};
use serde_json::{Value, json};

use crate::{apply, contents, download, lift, names, saved, shape, warnings};

/// Law: an output is never a file that is read or written otherwise, by any path, and nothing is written then.
#[test]
fn no_output_may_be_a_file_that_is_read_or_written_otherwise() {
    let folder = Folder::new();
    let gltf = download(&folder, "a", 8);
    let edit = folder.write("edit.json", lift(1.0).to_string());
    symlink(gltf.with_file_name("scene.bin"), folder.at("soft.json")).unwrap();
    fs::hard_link(gltf.with_file_name("scene.bin"), folder.at("hard.json")).unwrap();
    fs::hard_link(&edit, folder.at("edit.gltf")).unwrap();
    let before = contents(folder.path());
    let out = folder.at("out.gltf");
    for report in [
        "a/scene.bin",
        "a/../a/scene.bin",
        "soft.json",
        "hard.json",
        "edit.json",
        "a/a.gltf",
        "out.gltf",
        "./scene.bin",
    ] {
        let report = folder.at(report);
        apply(&gltf, &edit, &out, &["--report".as_ref(), report.as_ref()]).refused(2, &["--report", "is also"]);
        assert_eq!(contents(folder.path()), before, "{}", report.display());
    }
    apply(&gltf, &edit, &folder.at("edit.gltf"), &[]).refused(2, &["--output", "--edit"]);
    // A picture, refused before anything is drawn.
    let picture = |out: &str, edit: &str| {
        let (out, edit) = (folder.at(out), folder.at(edit));
        let words = [
            "render".as_ref(),
            gltf.as_os_str(),
            "--output".as_ref(),
            out.as_ref(),
            "--edit".as_ref(),
            edit.as_ref(),
        ];
        run(words)
    };
    symlink(&edit, folder.at("edit.png")).unwrap();
    symlink(gltf.with_file_name("scene.bin"), folder.at("bin.png")).unwrap();
    picture("edit.png", "edit.json").refused(2, &["--output", "--edit"]);
    picture("bin.png", "edit.json").refused(2, &["--output", "FILE needs"]);
    assert_eq!(contents(folder.path()), before);
    // In place is no clash.
    apply(&gltf, &edit, &gltf, &[]).done();
}

/// Law: no output replaces an image that a material library names, even if nothing draws the image.
#[test]
fn no_output_may_be_an_image_that_is_named_but_not_drawn() {
    let folder = Folder::new();
    let model = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl used\nf 1 2 3\n";
    let model = folder.write("m.obj", model);
    let library = "map_Kd early.png\nnewmtl used\nKd 1 1 1\nmap_Bump -bm 2 my bumps.png\nnorm far/away/bare.png\n\
                   newmtl unused\nmap_Kd -clamp on maps/unused.png\n";
    folder.write("m.mtl", library);
    fs::create_dir(folder.at("maps")).unwrap();
    let images = ["early.png", "my bumps.png", "bare.png", "maps/unused.png"];
    for image in images {
        folder.write(image, "an artist's image");
    }
    let before = contents(folder.path());
    for image in images {
        let out = folder.at(image);
        let words = ["render".as_ref(), model.as_os_str(), "--output".as_ref(), out.as_ref()];
        run(words).refused(2, &["--output", "that the model names"]);
        assert_eq!(contents(folder.path()), before, "{image}");
    }
}

/// Law: two documents saved into one folder both keep their shape, for any names of their buffers, and a repeated save
/// writes the same files.
#[test]
fn two_downloads_in_one_folder_keep_both_shapes() {
    let folder = Folder::new();
    let (a, b) = (download(&folder, "a", 8), download(&folder, "b", 10));
    fs::create_dir(folder.at("out")).unwrap();
    let (out_a, out_b, report) = (
        folder.at("out/a.gltf"),
        folder.at("out/b.gltf"),
        folder.at("report.json"),
    );
    for round in 1..4 {
        let (up, down) = (lift(f64::from(round)), lift(-f64::from(round)));
        folder.apply(&a, &up, &out_a, &[]).done();
        let first = shape(&out_a);
        folder
            .apply(&b, &down, &out_b, &["--report", report.to_str().unwrap()])
            .done();
        assert!(warnings(&report).contains("scene-2.bin"), "{}", warnings(&report));
        assert_eq!(shape(&out_a), first, "the first keeps its shape");
        assert_ne!(shape(&out_b).len(), first.len());
        assert_eq!(
            names(&folder.at("out")),
            ["a.gltf", "b.gltf", "scene-2.bin", "scene.bin"],
            "round {round}"
        );
    }
    // Another document over the first one's name: its neighbour must not change.
    let bytes = fs::read(folder.at("out/scene.bin")).unwrap();
    folder.apply(&b, &lift(1.0), &out_a, &[]).done();
    assert_eq!(fs::read(folder.at("out/scene.bin")).unwrap(), bytes);
    assert_eq!(shape(&out_a).len(), shape(&b).len());
}

#[test]
fn what_a_new_gltf_unpacks_overwrites_nobody() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let glb = folder.at("x.glb");
    folder.apply(&mesh, &bare_edit(), &glb, &[]).done();
    folder.write("x.bin", "another model's");
    for _ in 0..2 {
        for (source, out) in [(&glb, "x.gltf"), (&mesh, "y.gltf")] {
            folder.apply(source, &lift(1.0), &folder.at(out), &[]).done();
            assert_eq!(fs::read(folder.at("x.bin")).unwrap(), b"another model's");
            assert!(shape(&folder.at(out)).iter().any(|p| p.z > 0.9));
        }
    }
    assert_eq!(
        folder.names(),
        ["mesh.off", "x-2.bin", "x.bin", "x.glb", "x.gltf", "y.bin", "y.gltf"]
    );
}

/// Law: a buffer that another file in the folder also names is not changed for that file.
#[test]
fn a_buffer_that_two_files_share_is_edited_for_one_alone() {
    let folder = Folder::new();
    let a = saved(&folder, "a", 8);
    let twin = a.with_file_name("twin.gltf");
    fs::copy(&a, &twin).unwrap();
    let before = shape(&twin);
    folder.apply(&a, &lift(1.0), &a, &[]).done();
    assert_eq!(shape(&twin), before);
    assert_ne!(shape(&a), before);
    folder.apply(&a, &lift(1.0), &a, &[]).done();
    assert_eq!(names(&folder.at("a")), ["a-2.bin", "a.bin", "a.gltf", "twin.gltf"]);
}

#[test]
fn images_are_shared_where_they_are_the_same_and_kept_apart_where_they_are_not() {
    let folder = Folder::new();
    let a = download(&folder, "a", 8);
    let mut json: Value = serde_json::from_str(&fs::read_to_string(&a).unwrap()).unwrap();
    json["images"] = json!([{ "uri": "tex/skin.png" }]);
    fs::write(&a, json.to_string()).unwrap();
    fs::create_dir(folder.at("a/tex")).unwrap();
    folder.write("a/tex/skin.png", "ours");
    fs::create_dir_all(folder.at("out/tex")).unwrap();
    folder.write("out/tex/skin.png", "another's");
    let out = folder.at("out/a.gltf");
    for _ in 0..2 {
        folder.apply(&a, &lift(1.0), &out, &[]).done();
        assert_eq!(fs::read(folder.at("out/tex/skin.png")).unwrap(), b"another's");
        assert_eq!(fs::read(folder.at("out/tex/skin-2.png")).unwrap(), b"ours");
        assert!(open(&out).scene.notes().is_empty());
    }
    assert_eq!(names(&folder.at("out/tex")), ["skin-2.png", "skin.png"]);
    // The same holds for an OBJ's library and texture.
    let obj = folder.write(
        "a/s.obj",
        "mtllib s.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    );
    folder.write("a/s.mtl", "newmtl m\nmap_Kd tex/skin.png\n");
    folder.write("out/s.mtl", "another's");
    let out = folder.at("out/s.obj");
    for _ in 0..2 {
        folder.apply(&obj, &lift(1.0), &out, &[]).done();
        assert_eq!(fs::read(folder.at("out/s.mtl")).unwrap(), b"another's");
        assert!(open(&out).scene.notes().is_empty(), "{:?}", open(&out).scene.notes());
        assert_eq!(open(&out).scene.summary().images, 1);
    }
    assert_eq!(
        names(&folder.at("out")),
        ["a.gltf", "s-2.mtl", "s.mtl", "s.obj", "scene.bin", "tex"]
    );
}

/// Law: two buffers that are one place on the disk, in any spelling, never lose one of their edits.
#[test]
fn buffers_that_share_a_place_keep_both_edits() {
    for (first, second) in [
        ("a.bin", "a.bin"),
        ("a.bin", "./a.bin"),
        ("a.bin", "%61.bin"),
        ("b/../a.bin", "a.bin"),
        ("./a.bin", "b/../a.bin"),
    ] {
        let folder = Folder::new();
        for made in ["in/b", "out"] {
            fs::create_dir_all(folder.at(made)).unwrap();
        }
        let mut bin: Vec<u8> = Vec::new();
        for p in [
            [0.0_f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [5.0, 0.0, 0.0],
            [6.0, 0.0, 0.0],
            [6.0, 1.0, 0.0],
        ] {
            bin.extend(p.iter().flat_map(|x| x.to_le_bytes()));
        }
        folder.write("in/a.bin", &bin);
        let gltf = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
            "nodes": [{ "mesh": 0 }, { "mesh": 1 }],
            "meshes": [
                { "primitives": [{ "attributes": { "POSITION": 0 } }] }, { "primitives": [{ "attributes": { "POSITION": 1 } }] }
            ],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
                { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [5, 0, 0], "max": [6, 1, 0] },
            ],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 1, "byteOffset": 36, "byteLength": 36 }],
            "buffers": [{ "byteLength": 72, "uri": first }, { "byteLength": 72, "uri": second }],
        });
        let file = folder.write("in/scan.gltf", gltf.to_string());
        let edit = json!({ "version": 1, "method": { "name": "bilaplacian" },
            "handles": [{ "select": "all", "transform": { "translation": [0, 0, 1] } }] });
        let other = folder.at("out/scan.gltf");
        folder.apply(&file, &bare_edit(), &other, &[]).done();
        assert_eq!(shape(&other), shape(&file), "{first} and {second}, unedited");
        for out in [&other, &file] {
            folder.apply(&file, &edit, out, &[]).done();
            assert!(
                shape(out).iter().all(|p| p.z == 1.0),
                "{first} and {second}: {:?}",
                shape(out)
            );
        }
    }
}
