//! A result that single precision can't hold is refused, with the same words in every format.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::open;
use glam::DVec3;
use pliant_io::{Format, MorphTarget, Placement, Save, SaveError, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};

const OFF: &[u8] = b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n";

/// The same square in each format.
fn sources() -> Vec<SceneAndDrawn> {
    let square = open(OFF, Format::Off);
    let other = |format| open(&saved(&square, &square.drawn.positions, format).unwrap(), format);
    let doubles = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
         element face 2\nproperty list uchar uint vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n";
    vec![
        open(OFF, Format::Off),
        other(Format::Glb),
        other(Format::Obj),
        other(Format::Ply),
        other(Format::Stl),
        open(doubles.as_bytes(), Format::Ply),
    ]
}

fn saved(opened: &SceneAndDrawn, positions: &[DVec3], format: Format) -> Result<Vec<u8>, SaveError> {
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions,
        format,
        name: "out",
        placement: Placement::OtherFolder,
    };
    let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new());
    saved.map(|mut saved| saved.files.swap_remove(0).bytes)
}

#[test]
fn a_vertex_moved_beyond_it_is_refused_in_every_format_alike() {
    for source in sources() {
        for beyond in [1e39, -1e300, f64::INFINITY, f64::NAN] {
            let mut positions = source.drawn.positions.clone();
            positions[2].y = beyond;
            let file_vertex = source.drawn.file_vertex[2].0;
            for format in Format::ALL {
                let refused = saved(&source, &positions, format);
                assert_eq!(
                    refused,
                    Err(SaveError::NotFinite { file_vertex }),
                    "{beyond} from {} to {format}",
                    source.scene.format()
                );
            }
        }
        // The largest representable value is saved, and read back.
        let mut positions = source.drawn.positions.clone();
        positions[2].y = f64::from(f32::MAX);
        for format in [Format::Ply, Format::Obj, Format::Off, Format::Stl] {
            let bytes = saved(&source, &positions, format).unwrap();
            let again = open(&bytes, format);
            assert!(again.drawn.positions.iter().any(|p| p.y as f32 == f32::MAX), "{format}");
        }
    }
}

#[test]
fn what_a_file_holds_beyond_it_is_refused_in_every_other_kind_of_file_alike() {
    let far = open(
        b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1e39 0\n1 1 0\n3 0 1 2\n3 1 3 2\n",
        Format::Off,
    );
    for format in Format::ALL.into_iter().filter(|format| *format != Format::Off) {
        let refused = saved(&far, &far.drawn.positions, format);
        assert_eq!(refused, Err(SaveError::NotFinite { file_vertex: 2 }), "{format}");
    }
    // The file's own bytes keep it, as long as they are kept.
    let mut positions = far.drawn.positions.clone();
    positions[0].x = -1.0;
    assert!(saved(&far, &positions, Format::Off).is_ok());
}

#[test]
fn a_morph_target_whose_way_is_beyond_it_is_refused() {
    let square = open(OFF, Format::Off);
    let mut positions = square.drawn.positions.clone();
    positions[2].y = -3e38;
    let glb = open(&saved(&square, &positions, Format::Glb).unwrap(), Format::Glb);
    let mut positions = glb.drawn.positions.clone();
    let far = positions.iter().position(|p| p.y < -1e38).unwrap();
    positions[far].y = 3e38;
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &glb.drawn,
        positions: &positions,
        format: Format::Glb,
        name: "out.glb",
        placement: Placement::OtherFolder,
    };
    let target = MorphTarget { name: "x", weight: 1.0 };
    let refused = glb
        .scene
        .save_as_morph(&save, &target, &Progress::new(), &Cancel::new());
    assert!(matches!(refused, Err(SaveError::NotFinite { .. })), "{refused:?}");
}
