//! Real scans and broken files in `PLIANT_DATA`: each is read or refused in one line, comes back byte for byte when
//! nothing moved, and differs only where something did. The tests are skipped by name if the folder is missing.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a test fails by panicking and says what it skips"
)]

use std::time::Instant;

use crate::text::{changed_bytes, changed_lines, data, moved, save, try_open};
use glam::DVec3;
use pliant_io::{Format, SceneAndDrawn};

/// Calls `check` with every file of a folder that one of these formats reads.
fn each(folder: &str, mut check: impl FnMut(&str, Format, &[u8])) {
    let Some(files) = data(folder) else {
        eprintln!("skipped: the shared data folder {folder} is absent");
        return;
    };
    for (path, bytes) in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        if let Ok(format) = Format::of_name(name)
            && !matches!(format, Format::Glb | Format::Gltf)
        {
            check(name, format, &bytes);
        }
    }
}

/// The file vertices that the tests move: every seventh.
fn is_moved(file: u32) -> bool {
    file % 7 == 3
}

/// Checks that only moved vertices' numbers (and normals) differ.
fn check_edit(name: &str, opened: &SceneAndDrawn, before: &[u8]) {
    let drawn = &opened.drawn;
    let used = |file: u32| is_moved(file) && drawn.positions[file as usize].is_finite();
    let positions = moved(opened, used, |p| p + DVec3::new(0.125, -0.5, 0.25));
    let after = save(opened, &positions);
    let is_text = !before[..before.len().min(2000)].contains(&0);
    if opened.scene.format() == Format::Stl || !is_text {
        let changed = changed_bytes(before, &after);
        let (start, stride) = layout(opened, before);
        for at in changed {
            let record = (at - start) / stride;
            let may_move = match opened.scene.format() {
                Format::Stl => (0..3).any(|k| used(3 * record as u32 + k)),
                _ => used(record as u32),
            };
            assert!(may_move, "{name}: byte {at} of record {record} changed");
        }
    } else {
        let (before, after) = match opened.scene.format() {
            Format::Obj => (without_normals(before), without_normals(&after)),
            _ => (before.to_vec(), after),
        };
        let vertices = vertex_lines(opened, &before);
        let expected: Vec<usize> = (0..drawn.file_vertex_count as u32)
            .filter(|&v| used(v))
            .map(|v| vertices[v as usize])
            .collect();
        let positions = changed_lines(&before, &after);
        assert_eq!(positions, expected, "{name}");
    }
}

/// An OBJ without its `vn` lines and the corners' references to them, which an edit may add to.
fn without_normals(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    for line in text
        .split_inclusive(|&byte| byte == b'\n')
        .filter(|line| !line.starts_with(b"vn"))
    {
        if !line.starts_with(b"f ") {
            out.extend_from_slice(line);
            continue;
        }
        for word in line.split_inclusive(|&byte| byte == b' ') {
            let end = word
                .iter()
                .enumerate()
                .filter(|(_, byte)| **byte == b'/')
                .nth(1)
                .map(|(place, _)| place);
            out.extend_from_slice(&word[..end.unwrap_or(word.len())]);
            out.extend(end.map(|_| b' '));
        }
    }
    out
}

/// The start of a binary file's records and their distance.
fn layout(opened: &SceneAndDrawn, bytes: &[u8]) -> (usize, usize) {
    if opened.scene.format() == Format::Stl {
        return (84, 50);
    }
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let head = String::from_utf8_lossy(&bytes[..start]).into_owned();
    (start, 4 * head.matches("property float ").count())
}

/// The line of each file vertex in a text file.
fn vertex_lines(opened: &SceneAndDrawn, bytes: &[u8]) -> Vec<usize> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text.lines().enumerate();
    let numbered: Vec<usize> = match opened.scene.format() {
        Format::Obj => lines
            .filter(|(_, line)| line.starts_with("v "))
            .map(|(number, _)| number)
            .collect(),
        Format::Off => (2..).take(opened.drawn.file_vertex_count).collect(),
        _ => {
            let end = text.lines().position(|line| line.starts_with("end_header")).unwrap();
            (end + 1..).take(opened.drawn.file_vertex_count).collect()
        }
    };
    assert_eq!(numbered.len(), opened.drawn.file_vertex_count);
    numbered
}

#[test]
fn every_scan_opens_comes_back_and_changes_only_where_it_moved() {
    for folder in ["scans", "survey"] {
        each(folder, |name, format, bytes| {
            let start = Instant::now();
            let opened = try_open(bytes, format).unwrap();
            let open_ms = start.elapsed().as_secs_f64() * 1e3;
            assert!(!opened.drawn.triangles.is_empty(), "{name}");
            assert!(save(&opened, &opened.drawn.positions) == bytes, "{name}");
            let start = Instant::now();
            check_edit(name, &opened, bytes);
            let edit_ms = start.elapsed().as_secs_f64() * 1e3;
            let (vertices, triangles) = (opened.drawn.file_vertex_count, opened.drawn.triangles.len());
            eprintln!(
                "{name}: {vertices} vertices, {triangles} triangles, read in {open_ms:.0} ms, edit checked in {edit_ms:.0} ms"
            );
            for note in opened.scene.notes() {
                eprintln!("  {note}");
            }
        });
    }
}

#[test]
fn every_broken_file_is_read_or_refused_in_one_line() {
    each("bad", |name, format, bytes| match try_open(bytes, format) {
        Ok(opened) => {
            eprintln!(
                "{name}: {} triangles {:?}",
                opened.drawn.triangles.len(),
                opened.scene.notes()
            );
            assert!(save(&opened, &opened.drawn.positions) == bytes, "{name}");
            check_edit(name, &opened, bytes);
        }
        Err(error) => {
            let message = error.to_string();
            eprintln!("{message}");
            assert!(!message.contains('\n') && message.len() < 300, "{message}");
        }
    });
}
