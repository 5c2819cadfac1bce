//! What a save may write over, where it goes, and what it keeps: nothing of anybody's is lost.

#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says what it skips"
)]

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::DVec3;
use pliant_mesh::shapes;
use pliant_tests::{Ended, Folder, bare_edit, bend, open, run};
use serde_json::{Value, json};

fn lift(by: f64) -> Value {
    bend(&json!({ "translation": [0, 0, by] }))
}

/// A glTF of a torus in a folder of its own, its buffer called `scene.bin`, as downloads of one place are.
fn download(folder: &Folder, name: &str, sides: usize) -> PathBuf {
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, sides));
    fs::create_dir(folder.at(name)).unwrap();
    let gltf = folder.at(&format!("{name}/{name}.gltf"));
    folder.apply(&mesh, &bare_edit(), &gltf, &[]).done();
    fs::remove_file(mesh).unwrap();
    fs::rename(gltf.with_extension("bin"), gltf.with_file_name("scene.bin")).unwrap();
    replace_in(&gltf, &format!("{name}.bin"), "scene.bin");
    gltf
}

fn replace_in(path: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(old), "{old} is not in {text}");
    fs::write(path, text.replace(old, new)).unwrap();
}

fn shape(path: &Path) -> Vec<DVec3> {
    open(path).model.rest_positions()
}

/// Every file below a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut out = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let metadata = fs::symlink_metadata(&path).unwrap();
        if metadata.is_dir() {
            out.extend(contents(&path));
        } else if metadata.is_file() {
            out.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    out
}

fn names(folder: &Path) -> Vec<OsString> {
    let mut names: Vec<OsString> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    names
}

fn warnings(report: &Path) -> String {
    let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    report["warnings"].to_string()
}

fn apply(file: &Path, edit: &Path, out: &Path, more: &[&OsStr]) -> Ended {
    let mut words: Vec<OsString> = ["apply".into(), file.into(), "--edit".into(), edit.into()].into();
    words.extend(["--output".into(), out.into()]);
    words.extend(more.iter().map(Into::into));
    run(words)
}

/// Law: an output is never a file that is read or written otherwise, by whatever path, and nothing is written then.
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
        apply(&gltf, &edit, &out, &["--report".as_ref(), report.as_ref()]).refused(2, &["--report", "as well"]);
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

/// Law: of two documents saved into one folder both keep their shape, whatever their buffers are called, and a save
/// that is done again writes the same files.
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
    // Another document over the first one's name: its neighbour is nobody's business.
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

/// Law: a buffer that another file in the folder names as well is not edited under that file.
#[test]
fn a_buffer_that_two_files_share_is_edited_for_one_alone() {
    let folder = Folder::new();
    let a = download(&folder, "a", 8);
    let twin = a.with_file_name("twin.gltf");
    fs::copy(&a, &twin).unwrap();
    let before = shape(&twin);
    folder.apply(&a, &lift(1.0), &a, &[]).done();
    assert_eq!(shape(&twin), before);
    assert_ne!(shape(&a), before);
    folder.apply(&a, &lift(1.0), &a, &[]).done();
    assert_eq!(
        names(&folder.at("a")),
        ["a.gltf", "scene-2.bin", "scene.bin", "twin.gltf"]
    );
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
    // An OBJ's library and texture likewise.
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

/// Law: two buffers that are one place on the disk, in whatever spelling, never lose one of their edits.
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

/// Law: a save goes where links lead, its neighbours with it, and the links stay.
#[test]
fn links_are_followed_and_stay() {
    let folder = Folder::new();
    let file = download(&folder, "a", 8);
    fs::create_dir(folder.at("links")).unwrap();
    fs::create_dir(folder.at("target")).unwrap();
    let link = folder.at("links/out.gltf");
    symlink("../target/real.gltf", &link).unwrap();
    for _ in 0..2 {
        folder.apply(&file, &lift(1.0), &link, &[]).done();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(names(&folder.at("links")), ["out.gltf"]);
        assert_eq!(names(&folder.at("target")), ["real.gltf", "scene.bin"]);
        assert_eq!(shape(&link), shape(&folder.at("target/real.gltf")));
    }
    // One that leads to the input is a save in place.
    let before = shape(&file);
    let own = folder.at("links/own.gltf");
    symlink("../a/a.gltf", &own).unwrap();
    folder.apply(&file, &lift(1.0), &own, &[]).done();
    assert_eq!(names(&folder.at("a")), ["a.gltf", "scene.bin"]);
    assert_ne!(shape(&file), before);
    folder.apply(&own, &lift(1.0), &own, &[]).done();
    assert_eq!(names(&folder.at("a")), ["a.gltf", "scene.bin"]);
}

/// Law: what is no file is neither opened nor replaced.
#[test]
fn devices_pipes_sockets_and_folders_are_refused_unopened() {
    let folder = Folder::new();
    let file = download(&folder, "a", 8);
    let edit = folder.write("edit.json", lift(1.0).to_string());
    fs::create_dir(folder.at("out")).unwrap();
    let out = folder.at("out/a.gltf");
    let _socket = std::os::unix::net::UnixListener::bind(folder.at("socket.gltf")).unwrap();
    assert!(
        Command::new("mkfifo")
            .arg(folder.at("pipe.gltf"))
            .status()
            .unwrap()
            .success()
    );
    symlink("/dev/null", folder.at("device.gltf")).unwrap();
    fs::create_dir(folder.at("folder.gltf")).unwrap();
    for what in ["socket.gltf", "pipe.gltf", "device.gltf", "folder.gltf"] {
        let path = folder.at(what);
        apply(&file, &edit, &path, &[]).refused(1, &[what]);
        apply(&file, &edit, &out, &["--report".as_ref(), path.as_ref()]).refused(1, &[what]);
        assert!(
            !fs::metadata(&path).unwrap().is_file() && names(&folder.at("out")).is_empty(),
            "{what}"
        );
    }
    // In a neighbour's place it stays, and the neighbour gets another name.
    assert!(
        Command::new("mkfifo")
            .arg(folder.at("out/scene.bin"))
            .status()
            .unwrap()
            .success()
    );
    apply(&file, &edit, &out, &[]).done();
    assert_eq!(names(&folder.at("out")), ["a.gltf", "scene-2.bin", "scene.bin"]);
    assert!(shape(&out).iter().any(|p| p.z > 0.9));
}

/// Law: a neighbour is not written through a link that leads out of the folder.
#[test]
fn a_neighbour_is_not_written_through_a_link() {
    let folder = Folder::new();
    let file = download(&folder, "a", 8);
    fs::rename(folder.at("a/scene.bin"), folder.at("elsewhere.bin")).unwrap();
    symlink("../elsewhere.bin", folder.at("a/scene.bin")).unwrap();
    let before = fs::read(folder.at("elsewhere.bin")).unwrap();
    folder.apply(&file, &lift(1.0), &file, &[]).done();
    assert_eq!(fs::read(folder.at("elsewhere.bin")).unwrap(), before);
    assert_eq!(names(&folder.at("a")), ["a.gltf", "scene-2.bin", "scene.bin"]);
    assert!(shape(&file).iter().any(|p| p.z > 0.9));
}

/// Law: names keep their bytes, whether they are UTF-8 or not.
#[test]
fn names_that_are_not_utf_8_stay_what_they_are() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let edit = folder.write("edit.json", lift(1.0).to_string());
    let named = |name: &[u8]| folder.path().join(OsStr::from_bytes(name));
    for kind in ["glb", "gltf"] {
        let out = named(&[b"caf\xe9.".as_slice(), kind.as_bytes()].concat());
        let report = named(b"r\xe9port.json");
        apply(&mesh, &edit, &out, &["--report".as_ref(), report.as_ref()]).done();
        assert!(shape(&out).iter().any(|p| p.z > 0.9));
        assert!(report.is_file());
        assert_eq!(named(b"caf\xe9.bin").is_file(), kind != "glb");
        apply(&out, &edit, &out, &[]).done();
    }
    // As a neighbour it comes along under its name.
    fs::create_dir(folder.at("out")).unwrap();
    let out = folder.at("out/plain.gltf");
    apply(&named(b"caf\xe9.gltf"), &edit, &out, &[]).done();
    assert!(
        folder
            .path()
            .join("out")
            .join(OsStr::from_bytes(b"caf\xe9.bin"))
            .is_file()
    );
    assert!(shape(&out).iter().any(|p| p.z > 2.7));
}

#[test]
fn a_name_that_looks_like_an_address_can_be_read_back() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    for out in [
        "12:30.gltf",
        "data:x.gltf",
        "a:b.gltf",
        "a\\b.gltf",
        "100%.gltf",
        "a b#c?d.gltf",
        "\u{1b}[31m.gltf",
    ] {
        let out = folder.at(out);
        folder.apply(&mesh, &lift(1.0), &out, &[]).done();
        assert!(shape(&out).iter().any(|p| p.z > 0.9));
        folder.apply(&out, &lift(1.0), &out, &[]).done();
        assert!(shape(&out).iter().any(|p| p.z > 1.8));
    }
}

/// Law: whoever could read a file can read what replaces it, and nobody else; other names of it stay names of it.
#[test]
fn rights_and_names_of_a_replaced_file_are_kept() {
    let folder = Folder::new();
    let file = download(&folder, "a", 8);
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
    let set = |path: &Path, mode: u32| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    let bin = folder.at("a/scene.bin");
    set(&file, 0o600);
    set(&bin, 0o6640);
    let second = folder.at("a/second.glb");
    fs::hard_link(&file, &second).unwrap();
    folder.apply(&file, &lift(1.0), &file, &[]).done();
    assert_eq!((mode(&file), mode(&bin)), (0o600, 0o640), "setuid and setgid go");
    assert_eq!(fs::metadata(&file).unwrap().ino(), fs::metadata(&second).unwrap().ino());
    // A new neighbour of a private file is private.
    fs::remove_file(&bin).unwrap();
    let glb = folder.at("x.glb");
    folder
        .apply(
            &folder.write_mesh("mesh.off", &shapes::torus(12, 8)),
            &bare_edit(),
            &glb,
            &[],
        )
        .done();
    folder.apply(&glb, &bare_edit(), &file, &[]).done();
    assert_eq!((mode(&file), mode(&folder.at("a/a.bin"))), (0o600, 0o600));
    // Other names in other folders can't be found: that is told.
    fs::hard_link(&glb, folder.at("a/far.glb")).unwrap();
    let report = folder.at("report.json");
    folder
        .apply(&glb, &lift(1.0), &glb, &["--report", report.to_str().unwrap()])
        .done();
    assert!(warnings(&report).contains("hard links"), "{}", warnings(&report));
}

#[test]
fn extended_attributes_are_kept_where_there_are_any() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let set = Command::new("setfattr")
        .args(["-n", "user.origin", "-v", "scanner"])
        .arg(&mesh)
        .status();
    if !set.is_ok_and(|status| status.success()) {
        eprintln!("skipped: extended attributes can't be set here");
        return;
    }
    folder.apply(&mesh, &lift(1.0), &mesh, &[]).done();
    let got = Command::new("getfattr")
        .args(["--only-values", "-n", "user.origin"])
        .arg(&mesh)
        .output()
        .unwrap();
    assert_eq!(got.stdout, b"scanner");
}

/// Law: the next save clears away what a killed one has left, and nothing that somebody lives on.
#[test]
fn leftovers_go_with_the_next_save_unless_somebody_lives_on_them() {
    let folder = Folder::new();
    let file = download(&folder, "a", 8);
    let passing = ".pliant-0123456789abcdef-scene.bin";
    fs::rename(folder.at("a/scene.bin"), folder.at("a").join(passing)).unwrap();
    replace_in(&file, "scene.bin", passing);
    let lives = shape(&file);
    let stranger = folder.at("a/stranger.off");
    fs::rename(folder.write_mesh("mesh.off", &shapes::torus(12, 8)), &stranger).unwrap();
    for left in [
        ".pliant-abcdef.tmp",
        ".pliant-abcdef.old",
        ".pliant-00000000000000ff-scene.bin",
        ".pliant.lock",
    ] {
        folder.write(&format!("a/{left}"), "left");
    }
    // A save of another file there.
    folder.apply(&stranger, &lift(1.0), &stranger, &[]).done();
    assert_eq!(names(&folder.at("a")), [passing, "a.gltf", "stranger.off"]);
    assert_eq!(shape(&file), lives);
    // And one of the file that was cut off: it gets its neighbour's name back, edited or not.
    let out = folder.at("kept");
    fs::create_dir(&out).unwrap();
    fs::copy(&file, out.join("a.gltf")).unwrap();
    fs::copy(folder.at("a").join(passing), out.join(passing)).unwrap();
    for (file, edit) in [(file, lift(1.0)), (out.join("a.gltf"), bare_edit())] {
        folder.apply(&file, &edit, &file, &[]).done();
        let left = names(file.parent().unwrap());
        assert!(
            left.contains(&"scene.bin".into()) && !left.contains(&passing.into()),
            "{left:?}"
        );
        assert_eq!(shape(&file) == lives, edit == bare_edit());
    }
}

#[test]
fn foreign_text_neither_steers_the_terminal_nor_fills_it() {
    let folder = Folder::new();
    let edit = folder.write("edit.json", bare_edit().to_string());
    let evil = format!("\u{1b}]0;x\u{7}\u{202e}{}.off", "y".repeat(150));
    let long = "z".repeat(1_000_000) + ".off";
    for name in [evil, long] {
        let ended = apply(&folder.at(&name), &edit, &folder.at("out.off"), &[]).refused(1, &["can't be read"]);
        assert!(
            !ended
                .err
                .trim_end()
                .chars()
                .any(|letter| letter.is_control() || letter == '\u{202e}')
        );
        assert!(
            ended.err.chars().count() < 500,
            "{} characters",
            ended.err.chars().count()
        );
    }
    let endless = "--".to_owned() + &"x".repeat(1_000_000);
    let ended = run(["apply", &endless]).refused(2, &["--help"]);
    assert!(ended.err.chars().count() < 1200);
}

#[test]
fn more_threads_than_make_sense_are_refused() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let most = 4 * std::thread::available_parallelism().unwrap().get();
    let (out, more) = (folder.at("out.off"), (most + 1).to_string());
    folder
        .apply(&mesh, &bare_edit(), &out, &["--threads", &more])
        .refused(2, &["--threads", "cores"]);
    folder
        .apply(&mesh, &bare_edit(), &out, &["--threads", &most.to_string()])
        .done();
}
