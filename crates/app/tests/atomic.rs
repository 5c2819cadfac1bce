//! A save is complete or absent: cut off at every step, on a full disk, in a folder that can't be written.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use glam::DVec3;
use pliant_engine::files::{Staged, Staging};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded};
use pliant_mesh::{Cancel, Progress, WeldOptions};

/// A square of four vertices as `a scan.gltf` with its buffer and an image beside it.
fn write_scan(folder: &Path) {
    let mut bin: Vec<u8> = Vec::new();
    for position in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        bin.extend(position.iter().flat_map(|x| x.to_le_bytes()));
    }
    bin.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let text = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
 "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
 "accessors": [
  { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
  { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" } ],
 "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 12 }],
 "buffers": [{ "byteLength": 60, "uri": "a%20scan.bin" }] }"#;
    fs::write(folder.join("a scan.bin"), bin).unwrap();
    fs::write(folder.join("a scan.gltf"), text).unwrap();
}

fn load(path: &Path) -> Loaded {
    pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap()
}

fn stage(loaded: &Loaded, positions: &[DVec3], out: &Path) -> Result<Staged, EngineError> {
    stage_unless(loaded, positions, out, &Cancel::new())
}

fn stage_unless(loaded: &Loaded, positions: &[DVec3], out: &Path, cancel: &Cancel) -> Result<Staged, EngineError> {
    let save = SaveAs::shape(positions, out);
    let saved = saving::stage(loaded, &save, &Staging::default(), &Progress::new(), cancel);
    saved.map(|saved| saved.staged)
}

fn lifted(positions: &[DVec3]) -> Vec<DVec3> {
    positions.iter().map(|p| *p + DVec3::Z * (1.0 + p.x)).collect()
}

/// Saves the scan over itself and is cut off before the given step: this is not a test by itself.
#[test]
#[ignore = "a part of the one below, in a process of its own"]
fn the_one_that_is_cut_off() {
    let (Some(scan), Some(cut)) = (std::env::var_os("SCAN"), std::env::var("CUT").ok()) else {
        return;
    };
    let scan = Path::new(&scan);
    let loaded = load(scan);
    let positions = lifted(&loaded.model.rest_positions());
    let staged = stage(&loaded, &positions, scan).unwrap();
    let mut left: usize = cut.parse().unwrap();
    let mut cut_off = || {
        if left == 0 {
            std::process::abort();
        }
        left -= 1;
    };
    staged.commit_watched(&mut cut_off).unwrap();
}

#[test]
fn cut_off_at_any_step_the_old_file_or_the_new_one_stands_there_whole() {
    let mut states = Vec::new();
    for cut in 0..100 {
        let folder = tempfile::tempdir().unwrap();
        write_scan(folder.path());
        let scan = folder.path().join("a scan.gltf");
        let before = load(&scan).model.rest_positions();
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["the_one_that_is_cut_off", "--exact", "--ignored"])
            .env("SCAN", &scan)
            .env("CUT", cut.to_string())
            .output()
            .unwrap();
        let after = load(&scan).model.rest_positions();
        let is_new = after == lifted(&before);
        assert!(is_new || after == before, "cut off before step {cut}: {after:?}");
        // A file that was cut off can be saved again.
        let loaded = load(&scan);
        let staged = stage(&loaded, &lifted(&after), &scan).unwrap();
        staged.commit().unwrap();
        assert_eq!(load(&scan).model.rest_positions(), lifted(&after));
        states.push(is_new);
        if child.status.success() {
            assert!(is_new);
            let mut names: Vec<_> = fs::read_dir(folder.path())
                .unwrap()
                .map(|entry| entry.unwrap().file_name())
                .collect();
            names.sort();
            assert_eq!(names, ["a scan.bin", "a scan.gltf"], "nothing is left behind");
            break;
        }
    }
    // Temporary name, bridge, buffer, file, and removal of the temporary name: cut off before each, and not at all.
    assert_eq!(states, [false, false, true, true, true, true]);
}

#[test]
fn what_waits_for_its_place_has_no_more_rights_than_what_it_replaces() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    write_scan(folder.path());
    let scan = folder.path().join("a scan.gltf");
    for name in ["a scan.gltf", "a scan.bin"] {
        fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(0o600)).unwrap();
    }
    let loaded = load(&scan);
    let staged = stage(&loaded, &lifted(&loaded.model.rest_positions()), &scan).unwrap();
    let waiting: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.file_name().to_string_lossy().ends_with(".tmp"))
        .map(|entry| entry.metadata().unwrap().permissions().mode() & 0o777)
        .collect();
    assert_eq!(waiting, [0o600; 3], "the buffer, the file and its bridge");
    staged.commit().unwrap();
}

#[test]
fn stopped_at_any_look_every_file_is_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    write_scan(folder.path());
    let contents = || {
        let entries = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> = entries.map(|path| (fs::read(&path).unwrap(), path)).collect();
        files.sort();
        files
    };
    let before = contents();
    let scan = folder.path().join("a scan.gltf");
    let loaded = load(&scan);
    let positions = lifted(&loaded.model.rest_positions());
    let mut looks = 0;
    let staged = loop {
        match stage_unless(&loaded, &positions, &scan, &Cancel::after_looks(looks)) {
            Ok(staged) => break staged,
            Err(EngineError::Interrupted) => assert!(contents() == before, "stopped at look {looks}"),
            Err(error) => panic!("{error}"),
        }
        looks += 1;
    };
    // Before its bytes are made, during that, and as each of the two files is begun, written and synced.
    assert!(looks > 8, "it looked {looks} times");
    assert_ne!(contents(), before, "staged, the files stand beside their targets");
    staged.commit().unwrap();
    assert_eq!(load(&scan).model.rest_positions(), positions);
}

/// Runs the program with files limited to so many blocks. Beyond them the system sends SIGXFSZ, which ends a program
/// that does not expect it.
fn with_files_of_at_most(blocks: usize, arguments: &[&Path]) -> Output {
    Command::new("sh")
        .arg("-c")
        .arg(format!("ulimit -f {blocks}; exec \"$0\" \"$@\""))
        .arg(env!("CARGO_BIN_EXE_pliant"))
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn where_the_bytes_find_no_room_the_old_file_stays() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mut off = String::from("OFF\n10000 9998 0\n");
    (0..10_000).for_each(|v| off += &format!("{} {} {}\n", v % 100, v / 100, (v * v) % 7));
    (0..9_998).for_each(|v| off += &format!("3 {v} {} {}\n", v + 1, v + 2));
    fs::write(at("in.off"), off).unwrap();
    let edit = r#"{ "version": 1, "method": { "name": "bilaplacian" } }"#;
    fs::write(at("edit.json"), edit).unwrap();
    for out in ["out.glb", "out.gltf", "out.ply"] {
        fs::write(at(out), "old").unwrap();
        let (file, output) = (at("in.off"), at(out));
        let edit = at("edit.json");
        let arguments = [
            "apply".as_ref(),
            file.as_path(),
            "--edit".as_ref(),
            &edit,
            "--output".as_ref(),
            &output,
        ];
        let before: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        let ended = with_files_of_at_most(16, &arguments);
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{said}");
        assert!(said.lines().count() == 1 && said.contains("can't be written"), "{said}");
        assert_eq!(fs::read(&output).unwrap(), b"old");
        let after: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        assert_eq!(after.len(), before.len(), "{after:?}");
    }
}

#[test]
fn a_folder_that_can_not_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_scan(folder.path());
    let loaded = load(&folder.path().join("a scan.gltf"));
    // Nobody can make a file there, with any rights.
    let out = Path::new("/proc/out.glb");
    let refused = stage(&loaded, &lifted(&loaded.model.rest_positions()), out);
    let said = refused.map(|_| ()).unwrap_err().to_string();
    assert!(
        said.contains("/proc/out.glb can't be written") && !said.contains('\n'),
        "{said}"
    );
}
