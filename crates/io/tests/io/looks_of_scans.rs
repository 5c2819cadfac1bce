//! The appearance of PLY, OFF, STL and OBJ files, and the parts of it that are carried over or reported as left behind:
//! textures, colours.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use crate::text::{Folder, changed_lines, folder, moved, open, open_in, save, save_as};
use glam::DVec3;
use pliant_io::{Format, Placement, Save, Saved, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n not really";

/// A folder with two textures.
fn textures(first: &[u8], second: &[u8]) -> Folder {
    let mut folder = Folder::default();
    for (name, bytes) in [("skin one.png", first), ("b.png", second)] {
        folder.0.insert(name.to_owned(), bytes.to_vec());
    }
    folder
}

/// A square of two triangles around a seam: the corners of vertices 0 and 2 have other texture coordinates in each
/// face.
const WEDGES: &str = "ply\nformat ascii 1.0\ncomment TextureFile skin one.png\ncomment TextureFile b.png\nelement vertex 4\n\
    property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n\
    property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\n\
    property list uchar float texcoord\nproperty int texnumber\nend_header\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n\
    1 1 0 0 0 1 0 0 255\n0 1 0 0 0 1 9 9 9\n3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0.25 0 0.75 1 0 1 0\n";

fn saved(opened: &SceneAndDrawn, positions: &[DVec3], format: Format, placement: Placement) -> Saved {
    let name = format!("out.{}", format.extension());
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions,
        format,
        name: &name,
        placement,
    };
    opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap()
}

#[test]
fn texture_coordinates_of_faces_are_drawn_and_a_vertex_stays_one() {
    let files = textures(PNG, b"other");
    let opened = open_in(WEDGES.as_bytes(), Format::Ply, &files).unwrap();
    assert!(opened.scene.notes().is_empty(), "{:?}", opened.scene.notes());
    assert_eq!((opened.drawn.file_vertex_count, opened.drawn.positions.len()), (4, 6));
    let look = opened.scene.appearance();
    assert_eq!(look.images.len(), 2);
    assert_eq!(&*look.images[0].encoded, PNG);
    let of_groups: Vec<_> = look
        .groups
        .iter()
        .map(|group| look.materials[group.material].base_colour_image)
        .collect();
    assert_eq!(of_groups, [Some(1), Some(0)]);
    // Each corner has its face's coordinates, v down.
    let uvs = look.uvs.unwrap();
    let of_corners: Vec<[f32; 2]> = opened
        .drawn
        .triangles
        .iter()
        .flatten()
        .map(|v| uvs[v.index()])
        .collect();
    assert_eq!(
        of_corners,
        [[0., 1.], [1., 1.], [1., 0.], [0.25, 1.], [0.75, 0.], [0., 0.]]
    );
    let colours = look.colours.unwrap();
    let corner = opened.drawn.triangles[1][0];
    assert_eq!(colours[corner.index()], [65535, 0, 0, 65535]);
    // The file keeps one vertex, whose normal turns with all the faces around it.
    let bytes = save(&opened, &opened.drawn.positions);
    assert_eq!(bytes, WEDGES.as_bytes());
    let bent = moved(&opened, |_| true, |p| DVec3::new(p.x, -p.z, p.y));
    let after = save(&opened, &bent);
    assert_eq!(changed_lines(WEDGES.as_bytes(), &after), [19, 20, 21, 22]);
    let text = String::from_utf8(after).unwrap();
    assert!(
        text.contains("\n1 -0 1 0 -1 0 0 0 255\n") || text.contains("\n1 0 1 0 -1 0 0 0 255\n"),
        "{text}"
    );
}

#[test]
fn texture_coordinates_go_with_the_corners_of_a_face_that_is_turned_inside_out() {
    let opened = open_in(WEDGES.as_bytes(), Format::Ply, &textures(PNG, PNG)).unwrap();
    let turned = vec![true; opened.drawn.positions.len()];
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &turned,
        drawn: &opened.drawn,
        positions: &opened.drawn.positions,
        format: Format::Ply,
        name: "out.ply",
        placement: Placement::SameFolder,
    };
    let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
    let text = String::from_utf8(saved.files[0].bytes.clone()).unwrap();
    assert!(
        text.ends_with("\n3 0 2 1 6 0 0 1 1 1 0 1\n3 0 3 2 6 0.25 0 0 1 0.75 1 0\n"),
        "{text}"
    );
}

#[test]
fn textures_go_along_to_other_formats_and_folders() {
    let files = textures(PNG, PNG);
    let opened = open_in(WEDGES.as_bytes(), Format::Ply, &files).unwrap();
    let rest = &opened.drawn.positions;
    for format in [Format::Glb, Format::Obj] {
        let out = saved(&opened, rest, format, Placement::OtherFolder);
        let again = {
            let name = format!("out.{}", format.extension());
            pliant_io::read(
                out.files[0].bytes.clone(),
                format,
                &name,
                &out,
                &Progress::new(),
                &Cancel::new(),
            )
            .unwrap()
        };
        let look = again.scene.appearance();
        assert!(!look.images.is_empty() && look.uvs.is_some(), "{format}");
        assert!(
            look.groups
                .iter()
                .all(|group| look.materials[group.material].base_colour_image.is_some())
        );
    }
    let mut out = saved(&opened, rest, Format::Ply, Placement::OtherFolder);
    let names: Vec<&str> = out.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["out.ply", "skin one.png", "b.png"]);
    out.rename(1, "skin one-2.png", Format::Ply).unwrap();
    let expected = WEDGES.replace("skin one.png", "skin one-2.png");
    assert_eq!(String::from_utf8(out.files[0].bytes.clone()).unwrap(), expected);
    assert_eq!(saved(&opened, rest, Format::Ply, Placement::SameFolder).files.len(), 1);
    // A missing texture is named.
    let bare = open(WEDGES.as_bytes(), Format::Ply);
    assert!(
        bare.scene.notes()[0].contains("skin one.png"),
        "{:?}",
        bare.scene.notes()
    );
}

#[test]
fn all_greys_come_back_from_glb() {
    let mut ply = "ply\nformat ascii 1.0\nelement vertex 258\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 256\n\
        property list uchar int vertex_indices\nend_header\n"
        .to_owned();
    for k in 0..258 {
        let grey = k.min(255);
        ply += &format!("{k} {} 0 {grey} {grey} {grey}\n", k % 2);
    }
    (0..256).for_each(|k| ply += &format!("3 {k} {} {}\n", k + 1, k + 2));
    let opened = open(ply.as_bytes(), Format::Ply);
    let glb = save_as(&opened, &opened.drawn.positions, Format::Glb);
    let again = open(&glb.files[0].bytes, Format::Glb);
    for scene in [&opened.scene, &again.scene] {
        let greys = scene.appearance().srgb_colours().unwrap();
        let wanted = (0..258_usize).map(|k| [k.min(255) as u8; 3]);
        assert!(greys.iter().map(|&[r, g, b, _]| [r, g, b]).eq(wanted));
    }
    let back = save_as(&again, &again.drawn.positions, Format::Ply);
    let back = open(&back.files[0].bytes, Format::Ply);
    assert_eq!(back.scene.appearance().colours, opened.scene.appearance().colours);
}

#[test]
fn whole_numbers_of_any_type_are_colours() {
    for (kind, most) in [
        ("uchar", 255),
        ("ushort", 65535),
        ("short", 255),
        ("int", 255),
        ("uint", 65535),
        ("float", 1),
    ] {
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property {kind} red\nproperty {kind} green\nproperty {kind} blue\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n0 0 0 {most} 0 0\n1 0 0 0 {most} 0\n0 1 0 0 0 {most}\n3 0 1 2\n"
        );
        let colours = open(ply.as_bytes(), Format::Ply)
            .scene
            .appearance()
            .srgb_colours()
            .unwrap();
        assert_eq!(
            colours,
            [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]],
            "{kind}"
        );
    }
}

#[test]
fn polypaint_is_shown() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n#MRGB ffff0000ff00ff00\n#MRGB ff0000ff00102030\nf 1 2 3\nf 2 4 3\n";
    let opened = open(obj.as_bytes(), Format::Obj);
    let colours = opened.scene.appearance().srgb_colours().unwrap();
    assert_eq!(
        colours,
        [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [16, 32, 48, 255]]
    );
    assert_eq!(save(&opened, &opened.drawn.positions), obj.as_bytes());
}

#[test]
fn what_stays_behind_is_named() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float confidence\nelement face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n\
        property uchar green\nproperty uchar blue\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
        0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2 255 0 0\n0 1\n";
    let opened = open(ply.as_bytes(), Format::Ply);
    assert!(opened.scene.notes()[0].contains("colours of its faces"));
    let warnings = |opened: &SceneAndDrawn, format| save_as(opened, &opened.drawn.positions, format).warnings;
    let found = warnings(&opened, Format::Glb);
    let expected = "GLB output leaves out confidence of each 'vertex', red, green, blue of each 'face', the element \
                    edge: keep the .ply for them.";
    assert_eq!(found, [expected]);
    let off = open(
        b"OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n",
        Format::Off,
    );
    assert!(off.scene.notes()[0].contains("colours of its faces"));
    let found = warnings(&off, Format::Glb);
    assert!(
        found.iter().any(|warning| warning.contains("polygons were cut")),
        "{found:?}"
    );
    assert!(
        found.iter().any(|warning| warning.contains("the colours of faces")),
        "{found:?}"
    );
    let facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
    let stl = open(
        format!("solid a\n{facet}endsolid a\nsolid b\n{facet}endsolid b\n").as_bytes(),
        Format::Stl,
    );
    assert!(warnings(&stl, Format::Ply)[0].contains("2 solids"));
    // Plain files lose nothing.
    let plain = open(b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 # comment\n", Format::Off);
    assert_eq!((plain.scene.notes().len(), warnings(&plain, Format::Glb).len()), (0, 0));
}

#[test]
fn splats_and_directions_that_do_not_turn_are_named() {
    let ply = |more: &str, values: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n{more}end_header\n\
             0 0 0 {values}\n"
        )
    };
    let splat = ply(
        "property float rot_0\nproperty float scale_0\nproperty float opacity\n",
        "1 1 1",
    );
    assert!(open(splat.as_bytes(), Format::Ply).scene.notes()[0].contains("splats"));
    let wind = ply("property float vx\nproperty float vy\nproperty float vz\n", "1 1 1");
    assert!(open(wind.as_bytes(), Format::Ply).scene.notes()[0].contains("don't turn"));
}

#[test]
fn a_byte_order_mark_is_passed_over_and_kept() {
    let facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let texts = [
        (Format::Obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
        (Format::Off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_owned()),
        (Format::Stl, format!("solid facet of a name\n{facet}endsolid\n")),
        (Format::Ply, ply.to_owned()),
    ];
    for (format, text) in texts {
        let marked = format!("\u{feff}{text}");
        let (plain, opened) = (open(text.as_bytes(), format), open(marked.as_bytes(), format));
        assert_eq!(opened.drawn.positions, plain.drawn.positions, "{format}");
        assert_eq!(opened.drawn.triangles, plain.drawn.triangles, "{format}");
        assert_eq!(save(&opened, &opened.drawn.positions), marked.as_bytes());
        let up = |p: DVec3| p + DVec3::Z * 2.0;
        let [with, without] = [&opened, &plain].map(|opened| save(opened, &moved(opened, |v| v == 1, up)));
        assert_eq!(with, [b"\xef\xbb\xbf".as_slice(), &without].concat(), "{format}");
        let turned = vec![true; 3];
        let inside_out = |opened: &SceneAndDrawn| {
            let save = Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &turned,
                drawn: &opened.drawn,
                positions: &opened.drawn.positions,
                format,
                name: "b",
                placement: Placement::SameFolder,
            };
            opened
                .scene
                .save(&save, &Progress::new(), &Cancel::new())
                .unwrap()
                .files
                .swap_remove(0)
                .bytes
        };
        assert_eq!(
            inside_out(&opened),
            [b"\xef\xbb\xbf".as_slice(), &inside_out(&plain)].concat(),
            "{format}"
        );
    }
    // In front of a library's name, and in the library.
    let files = folder(&[("a.mtl", "\u{feff}newmtl red\nKd 1 0 0\n")]);
    let obj = "\u{feff}mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let opened = open_in(obj.as_bytes(), Format::Obj, &files).unwrap();
    assert!(opened.scene.notes().is_empty(), "{:?}", opened.scene.notes());
    assert_eq!(opened.scene.appearance().materials[0].base_colour, [1.0, 0.0, 0.0, 1.0]);
    let mut out = saved(&opened, &opened.drawn.positions, Format::Obj, Placement::OtherFolder);
    out.rename(1, "b.mtl", Format::Obj).unwrap();
    assert_eq!(
        String::from_utf8(out.files[0].bytes.clone()).unwrap(),
        obj.replace("a.mtl", "b.mtl")
    );
}

#[test]
fn libraries_whose_names_have_blanks_are_found_and_what_is_missing_is_told() {
    let files = folder(&[
        ("my stuff.mtl", "newmtl red\nKd 1 0 0\n"),
        ("more of it.mtl", "newmtl Blue\nKd 0 0 1\n"),
    ]);
    let obj = |uses: &str| format!("mtllib my stuff.mtl more of it.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{uses}");
    let open = |uses: &str| open_in(obj(uses).as_bytes(), Format::Obj, &files).unwrap();
    let opened = open("usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 2\nusemtl green\nf 2 1 3\n");
    let colours: Vec<[f32; 4]> = opened
        .scene
        .appearance()
        .materials
        .iter()
        .map(|own| own.base_colour)
        .collect();
    assert_eq!(colours[..2], [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
    let notes = opened.scene.notes();
    assert!(
        notes[0].contains("no material 'blue', so its material 'Blue'") && notes[1].contains("'green'"),
        "{notes:?}"
    );
    assert_eq!(notes.len(), 2);
    let bare = open("f 1 2 3\n");
    assert!(
        bare.scene.notes()[0].contains("no 'usemtl'"),
        "{:?}",
        bare.scene.notes()
    );
    let mut out = saved(&opened, &opened.drawn.positions, Format::Obj, Placement::OtherFolder);
    out.rename(2, "b.mtl", Format::Obj).unwrap();
    assert!(out.files[0].bytes.starts_with(b"mtllib my stuff.mtl b.mtl\n"));
}

#[test]
fn flat_faces_are_flat_and_hard_edges_that_are_drawn_smooth_are_told() {
    let obj = |first: &str, second: &str| {
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nv 5 5 5\n{first}f 1 2 3\n{second}f 2 4 3\n")
    };
    let open_obj = |first: &str, second: &str| open(obj(first, second).as_bytes(), Format::Obj);
    let flat = open_obj("s off\n", "");
    assert!(flat.scene.notes().is_empty(), "{:?}", flat.scene.notes());
    // The fifth vertex is in no face.
    assert_eq!(flat.scene.appearance().flat, std::slice::from_ref(&(0..4)));
    let normals_in_glb = |opened: &SceneAndDrawn| {
        let glb = save_as(opened, &opened.drawn.positions, Format::Glb);
        let has_some = glb.files[0].bytes.windows(8).any(|bytes| bytes == b"\"NORMAL\"");
        assert_eq!(
            open(&glb.files[0].bytes, Format::Glb)
                .scene
                .appearance()
                .flat
                .is_empty(),
            has_some
        );
        has_some
    };
    assert!(!normals_in_glb(&flat));
    for smooth in [open_obj("", ""), open_obj("s 1\n", "")] {
        assert!(smooth.scene.notes().is_empty() && smooth.scene.appearance().flat.is_empty());
        assert!(normals_in_glb(&smooth));
    }
    for (first, second) in [("s 1\n", "s 2\n"), ("s 1\n", "s off\n"), ("s 0\n", "s 1\n")] {
        let mixed = open_obj(first, second);
        assert!(
            mixed.scene.notes()[0].contains("smoothing groups"),
            "{:?}",
            mixed.scene.notes()
        );
        assert!(normals_in_glb(&mixed));
    }
    let with_normals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns off\nf 1//1 2//1 3//1\n";
    assert!(
        open(with_normals.as_bytes(), Format::Obj)
            .scene
            .appearance()
            .flat
            .is_empty()
    );
}
