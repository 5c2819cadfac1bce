//! Links, devices, names, rights, attributes, and leftovers of a killed save.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit};

use crate::{apply, download, lift, names, replace_in, saved, shape, warnings};

/// Law: a save follows links, its neighbours with it, and the links stay.
#[test]
fn links_are_followed_and_stay() {
    let folder = Folder::new();
    let file = saved(&folder, "a", 8);
    fs::create_dir(folder.at("links")).unwrap();
    fs::create_dir(folder.at("target")).unwrap();
    let link = folder.at("links/out.gltf");
    symlink("../target/real.gltf", &link).unwrap();
    for _ in 0..2 {
        folder.apply(&file, &lift(1.0), &link, &[]).done();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(names(&folder.at("links")), ["out.gltf"]);
        assert_eq!(names(&folder.at("target")), ["a.bin", "real.gltf"]);
        assert_eq!(shape(&link), shape(&folder.at("target/real.gltf")));
    }
    // A link that leads to the input is a save in place.
    let before = shape(&file);
    let own = folder.at("links/own.gltf");
    symlink("../a/a.gltf", &own).unwrap();
    folder.apply(&file, &lift(1.0), &own, &[]).done();
    assert_eq!(names(&folder.at("a")), ["a.bin", "a.gltf"]);
    assert_ne!(shape(&file), before);
    folder.apply(&own, &lift(1.0), &own, &[]).done();
    assert_eq!(names(&folder.at("a")), ["a.bin", "a.gltf"]);
}

/// Law: an object that is not a file is neither opened nor replaced.
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
    let file = saved(&folder, "a", 8);
    fs::rename(folder.at("a/a.bin"), folder.at("elsewhere.bin")).unwrap();
    symlink("../elsewhere.bin", folder.at("a/a.bin")).unwrap();
    let before = fs::read(folder.at("elsewhere.bin")).unwrap();
    folder.apply(&file, &lift(1.0), &file, &[]).done();
    assert_eq!(fs::read(folder.at("elsewhere.bin")).unwrap(), before);
    assert_eq!(names(&folder.at("a")), ["a-2.bin", "a.bin", "a.gltf"]);
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
    // As a neighbour it is saved under its name.
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

/// Law: the readers of a file can read its replacement, and nobody else can; its other names stay its names.
#[test]
fn rights_and_names_of_a_replaced_file_are_kept() {
    let folder = Folder::new();
    let file = saved(&folder, "a", 8);
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
    let set = |path: &Path, mode: u32| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    let bin = folder.at("a/a.bin");
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
    // Other names in other folders can't be found: a warning says so.
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

/// Law: the next save removes the leftovers of a killed one, and nothing that is in use.
#[test]
fn leftovers_go_with_the_next_save_unless_somebody_lives_on_them() {
    let folder = Folder::new();
    let file = saved(&folder, "a", 8);
    let passing = ".pliant-0123456789abcdef-a.bin";
    fs::rename(folder.at("a/a.bin"), folder.at("a").join(passing)).unwrap();
    replace_in(&file, "a.bin", passing);
    let lives = shape(&file);
    let stranger = folder.at("a/stranger.off");
    fs::rename(folder.write_mesh("mesh.off", &shapes::torus(12, 8)), &stranger).unwrap();
    for left in [
        ".pliant-abcdef.tmp",
        ".pliant-abcdef.old",
        ".pliant-00000000000000ff-a.bin",
    ] {
        folder.write(&format!("a/{left}"), "left");
    }
    // A lock is empty.
    folder.write("a/.pliant.lock", "");
    // A save of another file there.
    folder.apply(&stranger, &lift(1.0), &stranger, &[]).done();
    assert_eq!(names(&folder.at("a")), [passing, "a.gltf", "stranger.off"]);
    assert_eq!(shape(&file), lives);
    // A save of the file that was cut off: it gets its neighbour's name back, edited or not.
    let out = folder.at("kept");
    fs::create_dir(&out).unwrap();
    fs::copy(&file, out.join("a.gltf")).unwrap();
    fs::copy(folder.at("a").join(passing), out.join(passing)).unwrap();
    for (file, edit) in [(file, lift(1.0)), (out.join("a.gltf"), bare_edit())] {
        folder.apply(&file, &edit, &file, &[]).done();
        let left = names(file.parent().unwrap());
        assert!(
            left.contains(&"a.bin".into()) && !left.contains(&passing.into()),
            "{left:?}"
        );
        assert_eq!(shape(&file) == lives, edit == bare_edit());
    }
}
