//! OFF: its variants and layouts, and that saving changes only the moved vertices' numbers.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::{changed_lines, moved, open, refusal, save};
use glam::{DQuat, DVec3};
use pliant_io::Format;

const ODD: &str = "# a file\nOFF # here\n# counts\n4 3\t6\n\n0 0 0\n1.50 0 0 255 0 0 # red\n  1 1 0\r\n0 1 0\n# faces\n4 0 1 2 3 0.5 0.5 0.5\n3 0 1 2\n2 0 1";

#[test]
fn comments_colours_and_line_ends_stay() {
    let opened = open(ODD.as_bytes(), Format::Off);
    assert_eq!((opened.drawn.positions.len(), opened.drawn.triangles.len()), (4, 3));
    assert_eq!(save(&opened, &opened.drawn.positions), ODD.as_bytes());
    let bytes = save(&opened, &moved(&opened, |file| file == 1, |p| p + DVec3::Z / 3.0));
    assert_eq!(
        String::from_utf8(bytes).unwrap(),
        ODD.replace("1.50 0 0 255", "1.50 0 0.3333333333333333 255")
    );
    assert!(opened.scene.notes()[0].starts_with("1 face "));
}

#[test]
fn the_variants_hold_normals_colours_and_texture_coordinates() {
    let text =
        "STCNOFF 3 1 0\n0 0 0 0 0 1 255 0 0 255 0 0\n1 0 0 0 0 1 0 255 0 0 1 0\n0 1 0 0 0 1 0 0 255 255 0 1\n3 0 1 2\n";
    let opened = open(text.as_bytes(), Format::Off);
    let look = opened.scene.appearance();
    assert_eq!(
        look.srgb_colours().unwrap(),
        [[255, 0, 0, 255], [0, 255, 0, 0], [0, 0, 255, 255]]
    );
    assert_eq!(look.normals.unwrap(), [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(look.uvs.unwrap(), [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]);
    let turn = DQuat::from_rotation_x(0.5);
    let bytes = save(&opened, &moved(&opened, |_| true, |p| turn * p + DVec3::ONE));
    assert_eq!(changed_lines(text.as_bytes(), &bytes), [1, 2, 3]);
    for normal in open(&bytes, Format::Off).scene.appearance().normals.unwrap() {
        assert!(glam::Vec3::from(normal).as_dvec3().distance(turn * DVec3::Z) < 1e-6);
    }
    let few = open(
        b"COFF\n3 1\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2",
        Format::Off,
    );
    assert_eq!(few.scene.appearance().srgb_colours().unwrap()[1], [0, 255, 0, 255]);
}

#[test]
fn the_keyword_may_be_missing() {
    assert_eq!(
        open(b"3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", Format::Off)
            .drawn
            .triangles
            .len(),
        1
    );
}

#[test]
fn what_cannot_be_read_is_refused_in_one_line() {
    for (text, what) in [
        ("OFF BINARY\n\0\0", "binary kind"),
        ("4OFF\n1 0 0\n0 0 0 1", "three dimensions"),
        ("nOFF\n3\n1 0 0\n0 0 0", "three dimensions"),
        ("hello", "'hello'"),
        ("", "vertices"),
        ("OFF\n3 1.0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "faces is missing"),
        ("OFF\n1000000000 0 0\n0 0 0\n", "cut short"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n900 0 1\n", "900 corners"),
        ("OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "'x'"),
        ("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "cut short"),
    ] {
        let message = refusal(text.as_bytes(), Format::Off);
        assert!(message.contains(what) && !message.contains('\n'), "{text}: {message}");
    }
}
