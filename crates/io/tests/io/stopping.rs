//! Laws of a watched save: it reports its progress all along, stops at any point on request, and produces the same
//! bytes as an unwatched one.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::{open, save_as};
use glam::DVec3;
use pliant_io::{Format, MorphTarget, Placement, Save, SaveError, Saved, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress, shapes};

const KINDS: [Format; 6] = [
    Format::Glb,
    Format::Gltf,
    Format::Obj,
    Format::Ply,
    Format::Stl,
    Format::Off,
];

#[derive(Clone, Copy, Debug)]
enum Normals {
    None,
    Own,
}

/// A sheet with so many vertices that every loop over them checks several times, with or without normals.
fn sheet(normals: Normals) -> SceneAndDrawn {
    let sheet = shapes::grid(200, 200);
    let mut off = format!("OFF\n{} {} 0\n", sheet.positions.len(), sheet.triangles.len());
    for p in &sheet.positions {
        off += &format!("{} {} {}\n", p.x, p.y, (3.0 * p.x).sin());
    }
    for [a, b, c] in &sheet.triangles {
        off += &format!("3 {} {} {}\n", a.0, b.0, c.0);
    }
    let plain = open(off.as_bytes(), Format::Off);
    match normals {
        Normals::None => plain,
        // New glTF has normals, from any source.
        Normals::Own => open(
            &save_as(&plain, &plain.drawn.positions, Format::Glb).files[0].bytes,
            Format::Glb,
        ),
    }
}

fn bent(positions: &[DVec3]) -> Vec<DVec3> {
    positions.iter().map(|p| *p + DVec3::Z * p.x * p.x).collect()
}

/// The progress of a save that was stopped at each of its checks, in their order, and its final result.
fn stopped_everywhere(save: impl Fn(&Progress, &Cancel) -> Result<Saved, SaveError>) -> (Vec<f32>, Saved) {
    let mut shares = Vec::new();
    loop {
        let progress = Progress::new();
        let cancel = Cancel::after_looks(shares.len());
        match save(&progress, &cancel) {
            Ok(saved) => {
                assert_eq!(progress.get(), 1.0, "what is done is told so");
                return (shares, saved);
            }
            Err(error) => {
                assert!(matches!(error, SaveError::Cancelled(_)), "{error}");
                shares.push(progress.get());
            }
        }
    }
}

/// Shares rise, and no two are far apart.
#[track_caller]
fn assert_told(shares: &[f32], what: &str) {
    let ends = shares.iter().copied().chain([1.0]);
    for (before, after) in shares.iter().zip(ends.skip(1)) {
        assert!(before <= &after && after - before < 0.3, "{what}: {shares:?}");
    }
}

#[test]
fn a_save_as_any_kind_stops_wherever_it_is_told_to_and_tells_its_way() {
    let of_both = |normals| KINDS.map(|kind| (normals, kind));
    for (normals, from) in [Normals::None, Normals::Own].into_iter().flat_map(of_both) {
        let sheet = sheet(normals);
        let bytes = save_as(&sheet, &sheet.drawn.positions, from);
        if from == Format::Gltf {
            continue;
        }
        let opened = open(&bytes.files[0].bytes, from);
        let positions = bent(&opened.drawn.positions);
        // Patched files, and new ones of each other format.
        for to in KINDS.into_iter().filter(|to| *to == from || from == Format::Ply) {
            let name = format!("out.{}", to.extension());
            let request = Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn: &opened.drawn,
                positions: &positions,
                format: to,
                name: &name,
                placement: Placement::SameFolder,
            };
            let (shares, saved) = stopped_everywhere(|progress, cancel| opened.scene.save(&request, progress, cancel));
            assert_told(&shares, &format!("{from} as {to}, {normals:?}"));
            assert_eq!(saved, save_as(&opened, &positions, to));
        }
    }
}

#[test]
fn a_morph_target_stops_wherever_it_is_told_to() {
    let opened = sheet(Normals::None);
    let positions = bent(&opened.drawn.positions);
    let request = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions: &positions,
        format: Format::Glb,
        name: "out.glb",
        placement: Placement::SameFolder,
    };
    let target = MorphTarget {
        name: "bent",
        weight: 1.0,
    };
    let (shares, _) =
        stopped_everywhere(|progress, cancel| opened.scene.save_as_morph(&request, &target, progress, cancel));
    assert_told(&shares, "a morph target");
}
