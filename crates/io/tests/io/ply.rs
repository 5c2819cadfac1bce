//! PLY: every encoding, order and type, and that saving changes only the moved vertices' numbers.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::{changed_bytes, changed_lines, moved, open, refusal, save, save_as};
use glam::{DQuat, DVec3};
use pliant_io::{Format, SaveError};
use pliant_mesh::{Cancel, Progress};

const ASCII: &str = "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement camera 1\r\nproperty list uchar float view\r\n\
property int id\r\nelement vertex 5\r\nproperty uchar red\r\nproperty float32 z\r\nproperty list uint8 short marks\r\n\
property double y\r\nproperty float x\r\nproperty uchar green\r\nproperty uchar blue\r\nelement face 3\r\n\
property float quality\r\nproperty list uchar uint vertex_index\r\nelement extra 1\r\nproperty int n\r\nend_header\r\n\
2 0.5 0.5 7\r\n255 0 0 0 0 0 0\r\n0 0.50 2 5 6 0.0 1 255 0\r\n9 0 0 1 1 9 9\r\n9 0 1 -1 1 0 9 9\r\n9 5 0 5 5 9 9\r\n\
0.5 4 0 1 2 3\r\n0.25 3 0 1 2\r\n1 2 0 1\r\n42\r\n";

#[test]
fn properties_and_elements_of_any_kind_and_order_are_read_around() {
    let opened = open(ASCII.as_bytes(), Format::Ply);
    let drawn = &opened.drawn;
    assert_eq!(drawn.positions[1], DVec3::new(1.0, 0.0, 0.5));
    assert_eq!(drawn.positions[3], DVec3::new(0.0, 1.0, 0.0));
    assert_eq!((drawn.positions.len(), drawn.triangles.len()), (5, 3));
    assert_eq!(
        opened.scene.appearance().srgb_colours().unwrap()[..2],
        [[255, 0, 0, 255], [0, 255, 0, 255]]
    );
    assert!(opened.scene.notes()[0].starts_with("1 face with fewer than three"));
    assert_eq!(save(&opened, &drawn.positions), ASCII.as_bytes());
}

#[test]
fn a_moved_ascii_vertex_changes_its_numbers_by_their_types() {
    let opened = open(ASCII.as_bytes(), Format::Ply);
    let bytes = save(
        &opened,
        &moved(&opened, |file| file == 1, |p| p + DVec3::new(1.0 / 3.0, 1.0 / 3.0, 0.0)),
    );
    let text = String::from_utf8(bytes).unwrap();
    let expected = ASCII.replace(
        "0 0.50 2 5 6 0.0 1 255 0",
        "0 0.50 2 5 6 0.3333333333333333 1.3333334 255 0",
    );
    assert_eq!(text, expected);
}

/// A binary file with an element before and after the vertices, in either byte order.
fn binary(is_big: bool) -> Vec<u8> {
    let order = if is_big { "big" } else { "little" };
    let mut out = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement tag 2\nproperty list ushort double values\nelement vertex 4\n\
         property uchar flag\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nelement face 1\nproperty list uchar int vertex_indices\nproperty uchar hue\nelement tail 1\n\
         property int n\nend_header\n"
    )
    .into_bytes();
    macro_rules! put {
        ($number:expr) => {
            out.extend(if is_big {
                $number.to_be_bytes().to_vec()
            } else {
                $number.to_le_bytes().to_vec()
            })
        };
    }
    put!(1u16);
    put!(0.25f64);
    put!(0u16);
    for [x, y] in [[0.0f32, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]] {
        put!(10u8);
        for number in [x, y, 0.0, 0.0, 0.0, 1.0] {
            put!(number);
        }
    }
    put!(4u8);
    (0..4i32).for_each(|corner| put!(corner));
    put!(200u8);
    put!(-7i32);
    out
}

#[test]
fn both_byte_orders_are_read_and_patched_in_place() {
    for is_big in [false, true] {
        let before = binary(is_big);
        let opened = open(&before, Format::Ply);
        assert_eq!(opened.drawn.positions[2], DVec3::new(2.0, 1.0, 0.0));
        assert_eq!(opened.drawn.triangles.len(), 2);
        assert_eq!(save(&opened, &opened.drawn.positions), before);
        let positions = moved(&opened, |file| file == 2, |p| p + DVec3::new(0.5, 0.0, 0.25));
        let after = save(&opened, &positions);
        let vertex = before.len() - 4 - 1 - 17 - 4 * 25 + 2 * 25;
        let changed = changed_bytes(&before, &after);
        assert!(
            changed.iter().all(|at| (vertex + 1..vertex + 25).contains(at)),
            "{changed:?} not in {vertex}"
        );
        assert_eq!(open(&after, Format::Ply).drawn.positions, positions);
    }
}

#[test]
fn normals_of_moved_vertices_turn_with_them() {
    let opened = open(&binary(false), Format::Ply);
    let turn = DQuat::from_rotation_y(0.5);
    let after = open(
        &save(&opened, &moved(&opened, |_| true, |p| turn * p + DVec3::X)),
        Format::Ply,
    );
    for normal in after.scene.appearance().normals.unwrap() {
        assert!(glam::Vec3::from(normal).as_dvec3().distance(turn * DVec3::Z) < 1e-6);
    }
}

#[test]
fn strips_alternate_their_winding_and_end_at_a_negative_number() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n9 0 1 2 3 -1 2 3 4 5\n";
    let opened = open(text.as_bytes(), Format::Ply);
    let corners: Vec<[u32; 3]> = opened
        .drawn
        .triangles
        .iter()
        .map(|triangle| triangle.map(|corner| corner.0))
        .collect();
    assert_eq!(corners, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
    for [a, b, c] in corners
        .iter()
        .map(|triangle| triangle.map(|corner| opened.drawn.positions[corner as usize]))
    {
        assert!((b - a).cross(c - a).z > 0.0);
    }
}

#[test]
fn counts_are_checked_before_anything_is_allocated() {
    let head = |elements: &str| format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n0123456789");
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    for elements in [
        format!("element vertex 4000000000\n{xyz}"),
        format!("element vertex 18446744073709551615\n{xyz}"),
        format!("element vertex 0\n{xyz}element face 1000000000000\nproperty list uchar int vertex_indices\n"),
        format!("element lists 1\nproperty list uint uchar a\nelement vertex 0\n{xyz}"),
        "element vertex 3\nproperty float x\n".to_owned(),
        format!("element vertex 99999999999999999999\n{xyz}"),
    ] {
        let message = refusal(head(&elements).as_bytes(), Format::Ply);
        assert!(!message.contains('\n') && message.len() < 300, "{message}");
    }
    // An element without properties takes no bytes, with any number of records.
    let many = head(&format!(
        "element nothing 18446744073709551615\nelement vertex 0\n{xyz}"
    ));
    assert!(open(many.as_bytes(), Format::Ply).drawn.positions.is_empty());
}

#[test]
fn faces_that_name_missing_vertices_are_refused() {
    let text = |face: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n{face}\n"
        )
    };
    for face in [
        "3 0 1 3",
        "3 0 1 -1",
        "3 0 1 0.5",
        "3 0 1 nan",
        "9 0 1 2",
        "-3 0 1 2",
        "3 0 1",
        "3 0 1 x",
    ] {
        let message = refusal(text(face).as_bytes(), Format::Ply);
        assert!(!message.contains('\n'), "{face}: {message}");
    }
    assert_eq!(
        open(text("3 0 1 2").trim_end().as_bytes(), Format::Ply)
            .drawn
            .triangles
            .len(),
        1
    );
}

#[test]
fn whole_number_positions_are_rounded_or_refused() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n";
    let opened = open(text.as_bytes(), Format::Ply);
    let saved = save_as(
        &opened,
        &moved(&opened, |file| file == 1, |p| p + DVec3::splat(1.4)),
        Format::Ply,
    );
    assert_eq!(changed_lines(text.as_bytes(), &saved.files[0].bytes), [10]);
    assert!(String::from_utf8_lossy(&saved.files[0].bytes).contains("\n10 1 1\n"));
    assert!(saved.warnings[0].contains("whole numbers"));
    let positions = moved(&opened, |file| file == 1, |p| p + DVec3::splat(300.0));
    let save = pliant_io::Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions: &positions,
        format: Format::Ply,
        name: "out.ply",
        placement: pliant_io::Placement::SameFolder,
    };
    assert!(matches!(
        opened.scene.save(&save, &Progress::new(), &Cancel::new()),
        Err(SaveError::CannotHold { .. })
    ));
}

#[test]
fn a_header_of_bare_returns_and_data_that_begins_like_a_line_end_is_read() {
    let mut bytes = b"ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\rproperty uchar y\rproperty uchar z\rend_header\r".to_vec();
    bytes.extend([b'\n', 1, 2]);
    assert_eq!(open(&bytes, Format::Ply).drawn.positions, [DVec3::new(10.0, 1.0, 2.0)]);
}

#[test]
fn text_finer_than_its_type_keeps_its_fineness() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n4512345.25 0 0\n4512346.5 0 0\n4512345 1 0\n3 0 1 2\n";
    let opened = open(text.as_bytes(), Format::Ply);
    let positions = moved(&opened, |file| file == 0, |p| p + DVec3::splat(0.125));
    assert_eq!(open(&save(&opened, &positions), Format::Ply).drawn.positions, positions);
}

#[test]
fn a_new_file_holds_colours_and_polygons_and_as_many_digits_as_the_place_needs() {
    let off = "COFF\n4 1 0\n0 0 0 255 0 0\n1 0 0 0 128 0\n1 1 0 0 0 255\n0 1 0 9 99 199\n4 0 1 2 3\n";
    let opened = open(off.as_bytes(), Format::Off);
    let near = save_as(&opened, &opened.drawn.positions, Format::Ply);
    assert!(near.warnings.is_empty(), "{:?}", near.warnings);
    let text = String::from_utf8_lossy(&near.files[0].bytes).into_owned();
    assert!(
        text.contains("element face 1\n") && text.contains("property float x"),
        "{text}"
    );
    let again = open(&near.files[0].bytes, Format::Ply);
    assert_eq!(again.drawn.positions, opened.drawn.positions);
    assert_eq!(again.drawn.triangles, opened.drawn.triangles);
    let colours = |opened: &pliant_io::SceneAndDrawn| opened.scene.appearance().srgb_colours();
    assert_eq!(colours(&opened), colours(&again));
    let far: Vec<DVec3> = opened
        .drawn
        .positions
        .iter()
        .map(|&p| p + DVec3::new(4.5e6, 0.0, 0.001))
        .collect();
    let saved = save_as(&opened, &far, Format::Ply);
    assert_eq!(open(&saved.files[0].bytes, Format::Ply).drawn.positions, far);
}

#[test]
fn any_number_of_records_that_take_no_bytes_is_passed_over() {
    for name in ["face", "tristrips", "vertex", "other"] {
        let file = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element {name} 18446744073709551615\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
             0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        );
        assert_eq!(open(file.as_bytes(), Format::Ply).drawn.triangles.len(), 1, "{name}");
    }
}

#[test]
fn normals_of_faces_turn_with_them() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
             element face 2\nproperty float ny\nproperty list uchar int vertex_indices\nproperty uchar hue\n\
             property float nx\nproperty float nz\nend_header\n"
        )
    };
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [9.0, 9.0, 9.0_f32],
    ];
    let ascii = header("ascii") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 9\n0.0 4 0 1 2 3 77 0.00 2\n-1 3 0 1 4 78 0 0\n";
    let mut binary = header("binary_big_endian").into_bytes();
    binary.extend(points.as_flattened().iter().flat_map(|number| number.to_be_bytes()));
    for (normal, corners, hue) in [
        ([0.0, 0.0, 2.0_f32], vec![0, 1, 2, 3_i32], 77),
        ([0.0, -1.0, 0.0], vec![0, 1, 4], 78),
    ] {
        binary.extend(normal[1].to_be_bytes());
        binary.push(corners.len() as u8);
        binary.extend(corners.iter().flat_map(|corner| corner.to_be_bytes()));
        binary.push(hue);
        binary.extend([normal[0], normal[2]].iter().flat_map(|number| number.to_be_bytes()));
    }
    // A quarter turn about x takes the quad's normal from z to -y; the triangle at the fifth vertex bends.
    let quarter = |p: DVec3| DVec3::new(p.x, -p.z, p.y);
    for (bytes, is_text) in [(ascii.into_bytes(), true), (binary, false)] {
        let opened = open(&bytes, Format::Ply);
        assert_eq!(save(&opened, &opened.drawn.positions), bytes);
        let after = save(&opened, &moved(&opened, |vertex| vertex < 4, quarter));
        if is_text {
            let text = String::from_utf8(after.clone()).unwrap();
            assert!(text.contains("\n-2 4 0 1 2 3 77 0 0\n"), "{text}");
        } else {
            let faces = &after[after.len() - 2 * 13 - 28 - 2..];
            let number = |at: usize| f32::from_be_bytes(faces[at..at + 4].try_into().unwrap());
            let (ny, nx, nz) = (number(0), number(22), number(26));
            assert!(
                (ny + 2.0).abs() < 1e-6 && nx.abs() < 1e-6 && nz.abs() < 1e-6,
                "{nx} {ny} {nz}"
            );
        }
        // Only the triangle's own vertex moves: the quad's normal keeps its bytes.
        let bent = save(&opened, &moved(&opened, |vertex| vertex == 4, |p| p + DVec3::Y * 5.0));
        if is_text {
            assert_eq!(changed_lines(&bytes, &bent), [17, 19]);
        }
        let turned = vec![true; 5];
        let inside_out = pliant_io::Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &turned,
            drawn: &opened.drawn,
            positions: &opened.drawn.positions,
            format: Format::Ply,
            name: "b.ply",
            placement: pliant_io::Placement::SameFolder,
        };
        let saved = opened
            .scene
            .save(&inside_out, &Progress::new(), &Cancel::new())
            .unwrap();
        if is_text {
            let text = String::from_utf8(saved.files[0].bytes.clone()).unwrap();
            assert!(
                text.contains("\n-0.0 4 0 3 2 1 77 -0.00 -2\n1 3 0 4 1 78 -0 -0\n"),
                "{text}"
            );
        }
    }
}
