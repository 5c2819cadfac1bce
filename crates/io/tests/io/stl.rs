//! STL: both kinds are recognised, and saving changes only the moved corners and their facets' normals.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::{changed_bytes, changed_lines, moved, open, refusal, save, save_as};
use glam::DVec3;
use pliant_io::Format;

const ASCII: &str = "solid a thing facet\r\n  facet normal 0 0 1\r\n    outer loop\r\n      vertex 0 0 0\r\n      vertex 1.50 0 0\r\n\
      vertex 0 1 0\r\n    endloop\r\n  endfacet\r\n  FACET NORMAL nan 0 0 OUTER LOOP VERTEX 5 5 5 VERTEX 6 5 5\r\nVERTEX 5 6 5 ENDLOOP ENDFACET\r\n\
endsolid a thing\r\nsolid\r\nendsolid\r\n";

fn binary(header: &[u8], facets: u32) -> Vec<u8> {
    let mut out = header.to_vec();
    out.resize(80, 0xee);
    out.extend(facets.to_le_bytes());
    for facet in 0..facets {
        for number in [0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, facet as f32] {
            out.extend(f32::to_le_bytes(number));
        }
        out.extend([facet as u8, 0xab]);
    }
    out
}

#[test]
fn a_moved_corner_of_an_ascii_facet_changes_its_line_and_the_normal() {
    let opened = open(ASCII.as_bytes(), Format::Stl);
    assert_eq!((opened.drawn.file_vertex_count, opened.drawn.triangles.len()), (6, 2));
    assert_eq!(save(&opened, &opened.drawn.positions), ASCII.as_bytes());
    let bytes = save(&opened, &moved(&opened, |corner| corner == 1, |p| p - DVec3::Z * 1.5));
    let expected = ASCII
        .replace("normal 0 0 1", "normal 0.70710677 0 0.70710677")
        .replace("1.50 0 0", "1.50 0 -1.5");
    assert_eq!(String::from_utf8(bytes).unwrap(), expected);
    let bytes = save(&opened, &moved(&opened, |corner| corner > 2, |p| p + DVec3::X));
    assert_eq!(changed_lines(ASCII.as_bytes(), &bytes), [8, 9]);
    assert!(String::from_utf8(bytes).unwrap().contains("NORMAL 0 0 1 OUTER"));
}

#[test]
fn binary_files_are_told_by_their_length_even_when_they_begin_with_solid() {
    for header in [b"solid really binary".as_slice(), b"", b"  SOLID"] {
        let bytes = binary(header, 3);
        let opened = open(&bytes, Format::Stl);
        assert_eq!(opened.drawn.triangles.len(), 3);
        let notes = opened.scene.notes();
        assert!(notes.len() == 1 && notes[0].contains("attribute bytes"), "{notes:?}");
        let positions = moved(&opened, |corner| corner == 5, |p| p * 2.0);
        let after = save(&opened, &positions);
        let changed = changed_bytes(&bytes, &after);
        assert!(
            changed.iter().all(|at| (84 + 50..84 + 98).contains(at)),
            "attribute bytes stay: {changed:?}"
        );
        let again = open(&after, Format::Stl);
        assert_eq!(again.drawn.positions, positions);
        let normal = |k: usize| f32::from_le_bytes(after[134 + 4 * k..138 + 4 * k].try_into().unwrap());
        let length = (normal(0).powi(2) + normal(1).powi(2) + normal(2).powi(2)).sqrt();
        assert!((length - 1.0).abs() < 1e-6);
    }
}

#[test]
fn bytes_behind_the_facets_are_kept_whatever_the_header_begins_with() {
    for header in [b"solid facet".as_slice(), b"x"] {
        let mut bytes = binary(header, 3);
        bytes.extend(b"endsolid facet\n");
        let opened = open(&bytes, Format::Stl);
        assert_eq!(opened.drawn.triangles.len(), 3);
        assert!(
            opened.scene.notes()[0].contains("15 bytes after"),
            "{:?}",
            opened.scene.notes()
        );
        let after = save(&opened, &moved(&opened, |corner| corner == 5, |p| p * 2.0));
        assert_eq!(after[bytes.len() - 15..], bytes[bytes.len() - 15..]);
    }
    // A text is as long as it is.
    let long = ASCII.to_owned() + &"\n".repeat(100_000);
    assert_eq!(
        open(long.as_bytes(), Format::Stl).drawn.triangles.len(),
        open(ASCII.as_bytes(), Format::Stl).drawn.triangles.len()
    );
}

#[test]
fn a_wrong_count_is_refused_when_too_large_and_noted_when_too_small() {
    let mut bytes = binary(b"x", 3);
    bytes[80] = 4;
    assert!(refusal(&bytes, Format::Stl).contains("4 facets but has only 3"));
    bytes[80] = 2;
    let opened = open(&bytes, Format::Stl);
    assert_eq!(opened.drawn.triangles.len(), 2);
    assert!(opened.scene.notes()[0].contains("50 bytes after"));
    let after = save(&opened, &moved(&opened, |_| true, |p| p + 1.0));
    assert_eq!(after[184..], bytes[184..]);
    bytes[80..84].fill(0xff);
    assert!(refusal(&bytes, Format::Stl).contains("cut short"));
}

#[test]
fn broken_ascii_is_refused_by_its_line() {
    for (text, what) in [
        (
            "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0",
            "line 5",
        ),
        (
            "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop",
            "line 6",
        ),
        (
            "solid\nhello\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 2 0 0",
            "'hello'",
        ),
        ("solid\nfacet normal 0 0 1", "the file ends"),
        ("", "84 bytes"),
        ("hello", "84 bytes"),
    ] {
        let message = refusal(text.as_bytes(), Format::Stl);
        assert!(message.contains(what) && !message.contains('\n'), "{message}");
    }
    assert!(
        open(b"solid Empty\nendsolid Empty", Format::Stl)
            .drawn
            .triangles
            .is_empty()
    );
}

#[test]
fn a_new_file_says_what_it_leaves_out() {
    let off = "COFF\n4 1 0\n0 0 0 255 0 0\n1 0 0 0 128 0\n1 1 0 0 0 255\n0 1 0 9 99 199\n4 0 1 2 3\n";
    let opened = open(off.as_bytes(), Format::Off);
    let saved = save_as(&opened, &opened.drawn.positions, Format::Stl);
    let expected = "STL output leaves out the colours: save as .glb to keep them.";
    assert_eq!(saved.warnings[0], expected);
    assert!(saved.warnings[1].contains("polygons were cut"));
    let again = open(&saved.files[0].bytes, Format::Stl);
    let corners = opened
        .drawn
        .triangles
        .iter()
        .flatten()
        .map(|corner| opened.drawn.positions[corner.index()]);
    assert_eq!(again.drawn.positions, corners.collect::<Vec<_>>());
    let far = moved(&opened, |_| true, |p| p + DVec3::X * 4.5e6);
    let warnings = save_as(&opened, &far, Format::Stl).warnings;
    assert!(warnings[2].contains("32-bit numbers"), "{warnings:?}");
}
