//! OBJ: reading, and that saving changes only the moved vertices' lines.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text;
use crate::text::{changed_lines, folder, moved, open, open_in, refusal, save, save_as, try_open};
use glam::{DQuat, DVec3};
use pliant_io::{AlphaMode, Format, Placement, Save};
use pliant_mesh::{Cancel, Progress};

/// Every form of a line: comments, both line endings, continuations, w, colours, groups, a negative index.
const ODD: &[u8] = b"# caf\xe9 \\\r\nmtllib missing.mtl\n o thing  \nv 0 0 0 1.0 # w\n\tv  1.0 0 \\\n  0\r\nv 1 1 0 0.5 0.25 1\nv 0 1 0\n\
v 5 5 5\nvt 0 0\nvt 1 1\nvn 0 0 1\ng side\nusemtl red\ns off\nf 1/1/1 2/2/1 3//1 4\nf -5 -4 \\\n -3 # end\nl 1 2\ncurv 0 1";

#[test]
fn every_form_of_line_is_read_and_unmoved_comes_back_byte_for_byte() {
    let opened = open(ODD, Format::Obj);
    let drawn = &opened.drawn;
    assert_eq!(drawn.file_vertex_count, 5);
    assert_eq!(drawn.positions[1], DVec3::X);
    assert_eq!(drawn.triangles.len(), 3);
    let files = drawn.triangles.map_files(&drawn.file_vertex);
    assert_eq!(files[2], [0, 1, 2]);
    assert!(opened.scene.notes().iter().any(|note| note.contains("missing.mtl")));
    assert_eq!(save(&opened, &drawn.positions), ODD);
}

trait MapFiles {
    fn map_files(&self, file_vertex: &[pliant_mesh::FileVertex]) -> Vec<[u32; 3]>;
}

impl MapFiles for Vec<[pliant_mesh::DrawnVertex; 3]> {
    fn map_files(&self, file_vertex: &[pliant_mesh::FileVertex]) -> Vec<[u32; 3]> {
        self.iter()
            .map(|triangle| triangle.map(|corner| file_vertex[corner.index()].0))
            .collect()
    }
}

#[test]
fn a_moved_vertex_changes_its_three_numbers_and_nothing_else() {
    let opened = open(ODD, Format::Obj);
    let positions = moved(&opened, |file| file == 1, |p| p + DVec3::new(0.125, 0.0, 1e-7));
    let bytes = save(&opened, &positions);
    let expected = ODD
        .to_vec()
        .splice_text("v  1.0 0 \\\n  0\r\n", "v  1.125 0 \\\n  1e-7\r\n");
    assert_eq!(String::from_utf8_lossy(&bytes), String::from_utf8_lossy(&expected));
    let again = open(&bytes, Format::Obj);
    assert!(text::same_bits(&again.drawn.positions, &positions));
}

trait SpliceText {
    fn splice_text(self, from: &str, to: &str) -> Vec<u8>;
}

impl SpliceText for Vec<u8> {
    fn splice_text(mut self, from: &str, to: &str) -> Vec<u8> {
        let at = self
            .windows(from.len())
            .position(|window| window == from.as_bytes())
            .unwrap();
        self.splice(at..at + from.len(), to.bytes());
        self
    }
}

#[test]
fn positions_keep_all_their_digits() {
    let text = b"v 4512345.123456789 0.30000000000000004 -1e-300\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let opened = open(text, Format::Obj);
    assert_eq!(
        opened.drawn.positions[0],
        DVec3::new(4_512_345.123_456_789, 0.300_000_000_000_000_04, -1e-300)
    );
    let shift = DVec3::new(1.0 / 3.0, 1e10, 0.0);
    let positions = moved(&opened, |_| true, |p| p + shift);
    assert!(text::same_bits(
        &open(&save(&opened, &positions), Format::Obj).drawn.positions,
        &positions
    ));
}

#[test]
fn seams_split_what_is_drawn_and_move_as_one() {
    let text =
        b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.25\nf 1/1 2/2 3/3\nf 1/4 3/3 4/1\n";
    let opened = open(text, Format::Obj);
    assert_eq!(opened.drawn.file_vertex_count, 4);
    assert_eq!(opened.drawn.positions.len(), 5, "v 1 is drawn twice");
    assert_eq!(opened.drawn.file_vertex[4].0, 0);
    let look = opened.scene.appearance();
    assert_eq!(look.uvs.unwrap()[4], [0.5, 0.75], "v runs down");
    let bytes = save(&opened, &moved(&opened, |file| file == 0, |p| p - DVec3::Z));
    assert_eq!(changed_lines(text, &bytes), [0]);
}

#[test]
fn one_vertex_in_many_seams_is_drawn_once_for_each() {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    (0..100).for_each(|k| text.push_str(&format!("vt 0.{k:03} 0\n")));
    for _ in 0..2 {
        (1..=100).for_each(|k| text.push_str(&format!("f 1/{k} 2/1 3/1\n")));
    }
    let opened = open(text.as_bytes(), Format::Obj);
    assert_eq!(opened.drawn.positions.len(), 3 + 99);
    assert_eq!(opened.drawn.triangles[5], opened.drawn.triangles[105]);
    assert_eq!(opened.drawn.triangles[70], opened.drawn.triangles[170]);
}

#[test]
fn polygons_are_drawn_as_triangles_and_saved_as_they_were() {
    let text = b"v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 9 9 9\nf 1 2 3 4\nf 1 2\nf 5\nf\n";
    let opened = open(text, Format::Obj);
    // The dart's reflex corner is 3: only the cut through it is inside.
    let mut corners: Vec<Vec<u32>> = opened
        .drawn
        .triangles
        .iter()
        .map(|triangle| triangle.iter().map(|corner| corner.0).collect())
        .collect();
    corners.iter_mut().for_each(|triangle| triangle.sort_unstable());
    assert_eq!(corners, [[0, 1, 2], [0, 2, 3]]);
    assert!(
        opened.scene.notes()[0].starts_with("3 faces"),
        "{:?}",
        opened.scene.notes()
    );
    let off = save_as(&opened, &opened.drawn.positions, Format::Off)
        .files
        .swap_remove(0)
        .bytes;
    assert!(String::from_utf8(off).unwrap().ends_with("4 0 1 2 3\n"));
}

#[test]
fn impossible_corners_are_refused_by_their_line() {
    let start = "v 0 0 0\nv 1 0 0\n\nv 0 1 0\n";
    for (face, what) in [
        ("f 1 2 4\n", "line 5"),
        ("f 1 2 0\n", "line 5"),
        ("f 1 2 -4\n", "line 5"),
        ("f 1 2 x\n", "'x'"),
        ("f 1 2 3.5\n", "'3.5'"),
        ("f 1 2 99999999999999999999\n", "line 5"),
        ("v 1 2\n", "line 5"),
        ("v 1 2 z\n", "line 5"),
    ] {
        let message = refusal(format!("{start}{face}f 1 2 3").as_bytes(), Format::Obj);
        assert!(message.contains(what) && !message.contains('\n'), "{face}: {message}");
    }
}

#[test]
fn corners_may_name_vertices_that_come_later_and_looks_that_never_come() {
    let opened = open(b"f 1/9/9 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", Format::Obj);
    assert_eq!(opened.drawn.triangles.len(), 1);
    assert!(opened.scene.notes()[0].contains("without a texture coordinate or normal"));
    assert!(opened.scene.appearance().uvs.is_none());
}

#[test]
fn numbers_that_are_not_finite_are_read_and_kept() {
    let text = b"v nan 0 0\nv 1 -inf 0\nv 0 1 0\nv 2 2 2\nf 1 2 3\nf 2 3 4\n";
    let opened = open(text, Format::Obj);
    assert!(opened.drawn.positions[0].x.is_nan() && opened.drawn.positions[1].y == f64::NEG_INFINITY);
    assert_eq!(
        changed_lines(text, &save(&opened, &moved(&opened, |file| file == 3, |p| p * 2.0))),
        [3]
    );
}

/// A bumpy grid of n × n vertices with a normal each.
fn grid(n: usize, normal_of: impl Fn(usize) -> usize) -> String {
    let mut text = String::new();
    for k in 0..n * n {
        let (x, y) = ((k % n) as f64, (k / n) as f64);
        text.push_str(&format!("v {x} {y} {}\nvn {} 0 1\n", (x * 0.7).sin() * 0.2, x * 0.01));
    }
    for k in 0..n * n {
        if k % n + 1 < n && k / n + 1 < n {
            let corner = |k: usize| format!("{}//{}", k + 1, normal_of(k) + 1);
            text.push_str(&format!(
                "f {} {} {} {}\n",
                corner(k),
                corner(k + 1),
                corner(k + n + 1),
                corner(k + n)
            ));
        }
    }
    text
}

#[test]
fn normals_turn_with_a_rigid_motion_and_keep_their_length() {
    let text = grid(6, |k| k);
    let opened = open(text.as_bytes(), Format::Obj);
    let turn = DQuat::from_rotation_x(1.0) * DQuat::from_rotation_y(0.3);
    let bytes = save(&opened, &moved(&opened, |_| true, |p| turn * p + DVec3::ONE));
    let normals = |text: &[u8]| -> Vec<DVec3> {
        let text = String::from_utf8(text.to_vec()).unwrap();
        let lines = text.lines().filter_map(|line| line.strip_prefix("vn "));
        lines
            .map(|line| line.split(' ').map(|w| w.parse().unwrap()).collect::<Vec<f64>>())
            .map(|n| DVec3::from_slice(&n))
            .collect()
    };
    for (before, after) in normals(text.as_bytes()).into_iter().zip(normals(&bytes)) {
        assert!((turn * before).distance(after) < 1e-6, "{before} {after}");
    }
    let shifted = save(&opened, &moved(&opened, |_| true, |p| p + DVec3::ONE));
    assert_eq!(
        normals(&shifted),
        normals(text.as_bytes()),
        "a translation turns no normal"
    );
}

/// The normal of each corner of each face, looked up by a reader that goes from line to line.
fn normals_of_corners(text: &[u8]) -> Vec<Vec<DVec3>> {
    let text = String::from_utf8(text.to_vec()).unwrap();
    let (mut normals, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"vn") => {
                let numbers: Vec<f64> = words[1..].iter().map(|word| word.parse().unwrap()).collect();
                normals.push(DVec3::from_slice(&numbers));
            }
            Some(&"f") => {
                let of_corner = |word: &&str| {
                    let named: i64 = word.rsplit('/').next().unwrap().parse().unwrap();
                    let place = if named > 0 {
                        named - 1
                    } else {
                        normals.len() as i64 + named
                    };
                    normals[place as usize]
                };
                faces.push(words[1..].iter().map(of_corner).collect());
            }
            _ => {}
        }
    }
    faces
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.angle_between(b).to_degrees()
}

/// Two ribbons, each after its own `v` and `vn` lines, as Blender writes objects: one `vn` line for a whole flat side.
/// `counting` writes the name of a normal with the given number from 1, given the count so far.
fn ribbons(counting: impl Fn(usize, usize) -> String) -> String {
    let mut text = String::new();
    let n = 12;
    for ribbon in 0..2 {
        text += &format!("o ribbon{ribbon}\n");
        for k in 0..=n {
            let x = k as f64 / 2.0;
            text += &format!("v {x} {ribbon} 0\nv {x} {ribbon} 0.5\n");
        }
        text += "vn 0 1 0\n";
        for k in 0..n {
            let a = ribbon * 2 * (n + 1) + 2 * k + 1;
            let name = counting(ribbon + 1, ribbon + 1);
            let corners = [a, a + 1, a + 3, a + 2].map(|v| format!("{v}//{name}"));
            text += &format!("f {}\n", corners.join(" "));
        }
    }
    text
}

#[test]
fn a_normal_that_is_shared_by_what_bends_apart_becomes_several() {
    type Counting = fn(usize, usize) -> String;
    let countings: [Counting; 2] = [
        |number, _| number.to_string(),
        |number, so_far| format!("-{}", so_far + 1 - number),
    ];
    // Around the ribbons' end, with the first half of the second ribbon at rest.
    let curl = |p: DVec3, from: f64| match p.x > from {
        true => {
            let angle = (p.x - from) * 0.4;
            DVec3::new(from + angle.sin() / 0.4, p.y + (1.0 - angle.cos()) / 0.4, p.z)
        }
        false => p,
    };
    for counting in countings {
        let text = ribbons(counting);
        let opened = open(text.as_bytes(), Format::Obj);
        for (from_first, from_second) in [(0.0, 0.0), (3.0, 1.5), (9.0, 3.0), (0.0, 9.0)] {
            let new = |p: DVec3| curl(p, if p.y < 0.5 { from_first } else { from_second });
            let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| new(*p)).collect();
            let saved = save_as(&opened, &positions, Format::Obj);
            assert!(saved.warnings.is_empty(), "{:?}", saved.warnings);
            let bytes = &saved.files[0].bytes;
            let again = open(bytes, Format::Obj);
            let polygons = normals_of_corners(bytes);
            assert_eq!(polygons.len(), 24);
            for (face, normals) in polygons.into_iter().enumerate() {
                let (ribbon, k) = (face / 12, face % 12);
                let first = ribbon * 26 + 2 * k;
                for (normal, vertex) in normals.into_iter().zip([first, first + 1, first + 3, first + 2]) {
                    let rest = opened.drawn.positions[vertex];
                    let from = if ribbon == 0 { from_first } else { from_second };
                    let turned = ((rest.x - from) * 0.4).max(0.0);
                    let wanted = DVec3::new(-turned.sin(), turned.cos(), 0.0);
                    // A vertex's frame is the mean of the faces around it; at an end there is only one.
                    let most = if k == 0 || k == 11 { 6.5 } else { 3.5 };
                    assert!(angle(normal, wanted) < most, "face {face}: {normal} is not {wanted}");
                }
            }
            assert_eq!(again.drawn.file_vertex_count, opened.drawn.file_vertex_count);
            let posed = pliant_io::positions_in_pose((&opened.scene, &opened.drawn), (&again.scene, &again.drawn));
            assert!(posed.is_some(), "its faces join the same vertices");
        }
    }
}

#[test]
fn a_name_of_no_normal_does_not_become_that_of_an_added_one() {
    // A lid whose corners name lines that the file does not have, the first of which is added.
    let text = ribbons(|number, _| number.to_string()) + "f 1//3 3//4 2//70\n";
    let opened = open(text.as_bytes(), Format::Obj);
    let bent = |p: DVec3| DVec3::new(p.x, p.y + 0.1 * p.x * p.x, p.z);
    let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| bent(*p)).collect();
    let saved = String::from_utf8(save(&opened, &positions)).unwrap();
    let count = saved.lines().filter(|line| line.starts_with("vn ")).count();
    assert!(count > 4, "{count} lines");
    let lid = saved.lines().last().unwrap().split(['/', ' ']);
    let names: Vec<usize> = lid.skip(3).step_by(3).map(|name| name.parse().unwrap()).collect();
    assert!(
        names.len() == 3 && names.iter().all(|&name| name > count),
        "{names:?} of {count}"
    );
    let again = open(saved.as_bytes(), Format::Obj);
    assert_eq!(again.drawn.positions.len(), opened.drawn.positions.len());
}

#[test]
fn one_normal_of_all_turns_where_all_turn() {
    let text = grid(6, |_| 7);
    let opened = open(text.as_bytes(), Format::Obj);
    let turn = DQuat::from_rotation_x(1.0);
    let all = save_as(
        &opened,
        &moved(&opened, |_| true, |p| turn * p + DVec3::ONE),
        Format::Obj,
    );
    assert!(all.warnings.is_empty(), "{:?}", all.warnings);
    assert!(changed_lines(text.as_bytes(), &all.files[0].bytes).contains(&15));
    // A move without a turn changes none.
    let shifted = save(&opened, &moved(&opened, |_| true, |p| p + DVec3::Y));
    let changed = changed_lines(text.as_bytes(), &shifted);
    assert!(changed.iter().all(|line| line % 2 == 0), "{changed:?}");
}

#[test]
fn a_part_that_is_turned_inside_out_after_its_normals_were_divided_has_them_turned() {
    let text = ribbons(|number, _| number.to_string());
    let opened = open(text.as_bytes(), Format::Obj);
    let positions: Vec<DVec3> = (opened.drawn.positions.iter())
        .map(|p| DVec3::new(p.x, p.y + 0.05 * p.x * p.x, p.z))
        .collect();
    let turned: Vec<bool> = opened.drawn.positions.iter().map(|p| p.y > 0.5).collect();
    let save = |turned: &[bool]| {
        let save = Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned,
            drawn: &opened.drawn,
            positions: &positions,
            format: Format::Obj,
            name: "b.obj",
            placement: Placement::SameFolder,
        };
        let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
        normals_of_corners(&saved.files[0].bytes)
    };
    for (face, (as_is, turned)) in save(&[]).into_iter().zip(save(&turned)).enumerate() {
        let sign = if face < 12 { 1.0 } else { -1.0 };
        // A turned face has its corners in reverse, except the first.
        assert!((as_is[0] * sign).distance(turned[0]) < 1e-6, "face {face}");
        let last = if face < 12 { 3 } else { 1 };
        assert!((as_is[3] * sign).distance(turned[last]) < 1e-6, "face {face}");
    }
}

#[test]
fn materials_and_textures_come_through_the_resolver() {
    let text = b"mtllib my stuff.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl glass\nf 1 3 2\nusemtl none\nf 2 1 3\n";
    let library = "newmtl red\nKd 1 0 0\nmap_Kd -clamp on C:\\art\\skin.png\nnewmtl glass\nKd 1\nd 0.5\n";
    let files = folder(&[("my stuff.mtl", library), ("skin.png", "\u{89}PNG")]);
    let opened = open_in(text, Format::Obj, &files).unwrap();
    let look = opened.scene.appearance();
    assert_eq!(
        look.groups
            .iter()
            .map(|group| (group.triangles.clone(), group.material))
            .collect::<Vec<_>>(),
        [(0..1, 0), (1..2, 1), (2..3, 2)]
    );
    assert_eq!(look.materials[0].base_colour, [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(look.materials[0].base_colour_image, Some(0));
    assert_eq!(
        (look.materials[1].alpha, look.materials[1].base_colour[3]),
        (AlphaMode::Blend, 0.5)
    );
    assert_eq!(look.materials[2].name, "none");
    let notes = opened.scene.notes();
    assert!(notes.len() == 1 && notes[0].contains("'none'"), "{notes:?}");
    let plain = try_open(text, Format::Obj).unwrap();
    assert!(plain.scene.notes()[0].contains("my stuff.mtl"));
}

#[test]
fn a_copy_in_another_folder_brings_its_materials_along() {
    let text = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let library = "newmtl red\nmap_Kd art/skin.png\nbump rough.png\n";
    let files = folder(&[("a.mtl", library), ("art/skin.png", "png")]);
    let opened = open_in(text, Format::Obj, &files).unwrap();
    let save = |placement| {
        let save = Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions: &opened.drawn.positions,
            format: Format::Obj,
            name: "b.obj",
            placement,
        };
        opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
    };
    let saved = save(Placement::OtherFolder);
    let names: Vec<&str> = saved.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["b.obj", "a.mtl", "art/skin.png"]);
    assert_eq!(
        (saved.files[0].bytes.as_slice(), saved.files[1].bytes.as_slice()),
        (text.as_slice(), library.as_bytes())
    );
    assert!(saved.warnings[0].contains("copy them yourself"));
    assert_eq!(save(Placement::SameFolder).files.len(), 1);
}

#[test]
fn a_new_file_carries_materials_and_looks_that_read_back() {
    let text = b"mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0.25\nvn 0 0 1\no part one\nusemtl red\nf 1/1/1 2/2/1 3/1/1\nusemtl b\nf 2/1/1 4/2/1 3/1/1\n";
    let mut files = folder(&[("a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd skin.png\nnewmtl b\nd 0.5\n")]);
    files.0.insert("skin.png".to_owned(), b"\x89PNG\r\n\x1a\n".to_vec());
    let opened = open_in(text, Format::Obj, &files).unwrap();
    // Through a GLB: an OBJ is written from scratch only from another format.
    let (before, drawn) = (opened.scene.appearance(), &opened.drawn);
    let glb = save_as(&opened, &drawn.positions, Format::Glb);
    let from_glb = open(&glb.files[0].bytes, Format::Glb);
    let saved = save_as(&from_glb, &from_glb.drawn.positions, Format::Obj);
    let names: Vec<&str> = saved.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names[..2], ["out.obj", "out.mtl"]);
    let mut again = folder(&[]);
    saved.files[1..]
        .iter()
        .for_each(|file| drop(again.0.insert(file.name.clone(), file.bytes.clone())));
    let again = open_in(&saved.files[0].bytes, Format::Obj, &again).unwrap();
    let after = again.scene.appearance();
    assert!(again.scene.notes().is_empty(), "{:?}", again.scene.notes());
    let corners = |opened: &pliant_io::SceneAndDrawn| -> Vec<DVec3> {
        opened
            .drawn
            .triangles
            .iter()
            .flatten()
            .map(|corner| opened.drawn.positions[corner.index()])
            .collect()
    };
    assert_eq!(corners(&again), corners(&opened));
    let uvs = |opened: &pliant_io::SceneAndDrawn, look: &pliant_io::Appearance| -> Vec<[f32; 2]> {
        opened
            .drawn
            .triangles
            .iter()
            .flatten()
            .map(|corner| look.uvs.as_ref().unwrap()[corner.index()])
            .collect()
    };
    assert_eq!(uvs(&again, &after), uvs(&opened, &before));
    assert_eq!(after.images.len(), 1);
    let look = |look: &pliant_io::Appearance| -> Vec<(String, Option<usize>, bool)> {
        let materials = look.groups.iter().map(|group| &look.materials[group.material]);
        materials
            .map(|m| (m.name.clone(), m.base_colour_image, m.alpha == AlphaMode::Blend))
            .collect()
    };
    assert_eq!(look(&after), look(&before));
}

#[test]
fn colours_behind_positions_are_drawn_whether_they_count_to_1_or_255() {
    let small = open(b"v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n", Format::Obj);
    let large = open(
        b"v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 255 255 255\nf 1 2 3\n",
        Format::Obj,
    );
    let expected = vec![[255, 0, 0, 255], [0, 255, 0, 255], [255, 255, 255, 255]];
    assert_eq!(small.scene.appearance().srgb_colours().unwrap(), expected);
    assert_eq!(large.scene.appearance().srgb_colours().unwrap(), expected);
}
