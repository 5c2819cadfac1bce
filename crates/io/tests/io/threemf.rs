//! 3MF: what is drawn, saves that leave the rest of the archive as it is, conversions, and broken files.

use std::io::{Cursor, Read, Write};

use crate::text::{moved, open, refusal, same_bits, save, save_as, try_open};
use glam::DVec3;
use pliant_io::{Format, Placement, Save, SaveError, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

const MODEL: &str = "3D/3dmodel.model";

/// A model part around resources and a build list.
fn model(resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" xmlns:m=\"m\" xmlns:p=\"p\">\n\
         <resources>{resources}</resources>\n<build>{build}</build>\n</model>\n"
    )
}

/// An object that is a square of two triangles.
fn square(id: u32, more: &str) -> String {
    format!(
        "<object id=\"{id}\" name=\"square\"><mesh><vertices>\n<vertex x=\"0\" y=\"0.50\" z=\"0\"/>\n\
         <vertex z=\"0\" y=\"0\" x=\"1\"/>\n<vertex x='1e0' y='1' z='0' />\n<vertex x=\"0\" y=\"1\" z=\"0\"></vertex>\n\
         </vertices><triangles>\n<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>\n<triangle v1=\"0\" v2=\"2\" v3=\"3\" {more}/>\n\
         </triangles></mesh></object>"
    )
}

/// An archive of these parts.
fn packed(parts: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in parts {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// An archive with this model, and parts of a slicer.
fn with_strangers(model: &str) -> Vec<u8> {
    packed(&[
        ("[Content_Types].xml", b"<Types/>"),
        ("Metadata/slicer.config", &[7; 300]),
        (MODEL, model.as_bytes()),
        ("Metadata/thumbnail.png", &[1, 2, 3]),
    ])
}

/// The compressed bytes of each part, by name.
fn compressed(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut zip = ZipArchive::new(Cursor::new(archive)).unwrap();
    (0..zip.len())
        .map(|place| {
            let mut file = zip.by_index_raw(place).unwrap();
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).unwrap();
            (file.name().unwrap().into_owned(), bytes)
        })
        .collect()
}

fn part(archive: &[u8], name: &str) -> String {
    let mut zip = ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut text = String::new();
    zip.by_name(name).unwrap().read_to_string(&mut text).unwrap();
    text
}

fn try_save(opened: &SceneAndDrawn, positions: &[DVec3]) -> Result<Vec<u8>, SaveError> {
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions,
        format: Format::Threemf,
        name: "out.3mf",
        placement: Placement::SameFolder,
    };
    let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new());
    saved.map(|mut saved| saved.files.swap_remove(0).bytes)
}

#[test]
fn only_the_numbers_of_moved_vertices_change_and_other_parts_stay_compressed_as_they_are() {
    let text = model(&square(5, ""), "<item objectid=\"5\"/>");
    let bytes = with_strangers(&text);
    let opened = open(&bytes, Format::Threemf);
    assert_eq!(save(&opened, &opened.drawn.positions), bytes);

    let up = moved(&opened, |vertex| vertex == 1, |p| p + DVec3::Z * 0.25);
    let after = save(&opened, &up);
    let expected = text.replace(
        "<vertex z=\"0\" y=\"0\" x=\"1\"/>",
        "<vertex z=\"0.25\" y=\"0\" x=\"1\"/>",
    );
    assert_ne!(expected, text);
    assert_eq!(part(&after, MODEL), expected);
    let (before, now) = (compressed(&bytes), compressed(&after));
    assert_eq!(before.len(), now.len());
    for (before, now) in before.iter().zip(&now) {
        assert!(before == now || before.0 == MODEL, "{}", before.0);
    }
    let again = open(&after, Format::Threemf);
    assert!(same_bits(&again.drawn.positions, &up));
    assert_eq!(save(&opened, &up), after, "the same bytes at another time");
}

#[test]
fn the_build_list_places_objects_of_objects_and_of_other_parts() {
    let inner = model(&square(1, ""), "");
    let outer = model(
        "<object id=\"9\"><components><component objectid=\"1\" p:path=\"/3D/Objects/inner.model\" \
         transform=\"1 0 0 0 1 0 0 0 1 0 0 5\"/></components></object>",
        "<item objectid=\"9\" transform=\"2 0 0 0 2 0 0 0 2 10 0 0\"/>",
    );
    let bytes = packed(&[(MODEL, outer.as_bytes()), ("3D/Objects/inner.model", inner.as_bytes())]);
    let opened = open(&bytes, Format::Threemf);
    let wanted = [
        [10.0, 1.0, 10.0],
        [12.0, 0.0, 10.0],
        [12.0, 2.0, 10.0],
        [10.0, 2.0, 10.0],
    ];
    assert_eq!(opened.drawn.positions, wanted.map(DVec3::from));

    let up = moved(&opened, |vertex| vertex == 2, |p| p + DVec3::new(0.0, 0.0, 3.0));
    let after = save(&opened, &up);
    assert_eq!(part(&after, MODEL), outer);
    assert!(part(&after, "3D/Objects/inner.model").contains("z='1.5'"));
    assert_eq!(open(&after, Format::Threemf).drawn.positions, up);
}

#[test]
fn a_mirrored_place_is_wound_outwards() {
    let text = model(
        &square(1, ""),
        "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>",
    );
    let opened = open(&with_strangers(&text), Format::Threemf);
    let [a, b, c] = opened.drawn.triangles[0].map(|corner| opened.drawn.positions[corner.index()]);
    assert!((b - a).cross(c - a).z > 0.0);
}

#[test]
fn an_object_that_is_shown_twice_is_bent_alike_or_refused() {
    let build = "<item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 7 0 0\"/>";
    let opened = open(&with_strangers(&model(&square(1, ""), build)), Format::Threemf);
    assert_eq!((opened.drawn.positions.len(), opened.drawn.file_vertex_count), (8, 4));
    let both = moved(&opened, |vertex| vertex == 3, |p| p + DVec3::Z);
    assert_eq!(
        open(&try_save(&opened, &both).unwrap(), Format::Threemf)
            .drawn
            .positions,
        both
    );
    let mut one = opened.drawn.positions.clone();
    one[3].z = 1.0;
    let said = try_save(&opened, &one).unwrap_err().to_string();
    assert!(said.contains("several times") && said.contains(".glb"), "{said}");
    // Another format has no such objects.
    let glb = save_as(&opened, &one, Format::Glb);
    let glb = open(&glb.files[0].bytes, Format::Glb);
    assert_eq!(glb.drawn.positions.iter().filter(|p| p.z == 1.0).count(), 1);
}

#[test]
fn colours_and_textures_of_corners_are_drawn_and_come_back() {
    let resources = "<basematerials id=\"1\"><base name=\"red &amp; more\" displaycolor=\"#FF0000\"/></basematerials>\
         <m:colorgroup id=\"2\"><m:color color=\"#00FF00\"/><m:color color=\"#0000FF80\"/></m:colorgroup>\
         <m:texture2d id=\"3\" path=\"/3D/skin.png\" contenttype=\"image/png\"/>\
         <m:texture2dgroup id=\"4\" texid=\"3\"><m:tex2coord u=\"0.25\" v=\"1\"/><m:tex2coord u=\"0.5\" v=\"0\"/>\
         </m:texture2dgroup>";
    let look = |more: &str| {
        let text = model(&(resources.to_owned() + &square(9, more)), "<item objectid=\"9\"/>");
        let png = b"\x89PNG\r\n\x1a\n";
        open(
            &packed(&[(MODEL, text.as_bytes()), ("3D/skin.png", png)]),
            Format::Threemf,
        )
    };
    let base = look("pid=\"1\" p1=\"0\"");
    let materials = base.scene.appearance().materials;
    assert_eq!((materials.len(), &*materials[1].name), (2, "red & more"));
    assert_eq!(materials[1].base_colour, [1.0, 0.0, 0.0, 1.0]);

    // Vertices 0, 2 and 3 have colours in the second triangle; the first triangle has none.
    let coloured = look("pid=\"2\" p1=\"0\" p2=\"1\" p3=\"1\"");
    let colours = coloured.scene.appearance().srgb_colours().unwrap();
    let corner_colours = |opened: &SceneAndDrawn, colours: &[[u8; 4]]| {
        let corners = opened.drawn.triangles[1];
        corners.map(|corner| colours[corner.index()])
    };
    let wanted = [[0, 255, 0, 255], [0, 0, 255, 128], [0, 0, 255, 128]];
    assert_eq!(corner_colours(&coloured, &colours), wanted);

    let textured = look("pid=\"4\" p1=\"0\" p2=\"1\" p3=\"0\"");
    let seen = textured.scene.appearance();
    let uvs = seen.uvs.clone().unwrap();
    let corners = textured.drawn.triangles[1].map(|corner| uvs[corner.index()]);
    assert_eq!(corners, [[0.25, 0.0], [0.5, 1.0], [0.25, 0.0]]);
    assert_eq!(&seen.images[0].encoded[1..4], b"PNG");

    // To a format that holds them, and back to a new 3MF.
    for (opened, format) in [(&coloured, Format::Ply), (&textured, Format::Glb)] {
        let first = save_as(opened, &opened.drawn.positions, format);
        let between = pliant_io::read(
            first.files[0].bytes.clone(),
            format,
            "between",
            &first,
            &Progress::new(),
            &Cancel::new(),
        )
        .unwrap();
        let second = save_as(&between, &between.drawn.positions, Format::Threemf);
        let back = open(&second.files[0].bytes, Format::Threemf);
        let place = |opened: &SceneAndDrawn, triangle: usize| {
            opened.drawn.triangles[triangle].map(|corner| opened.drawn.positions[corner.index()])
        };
        assert_eq!(
            [0, 1].map(|triangle| place(&back, triangle)),
            [0, 1].map(|triangle| place(opened, triangle))
        );
        let look = back.scene.appearance();
        match format {
            Format::Ply => assert_eq!(corner_colours(&back, &look.srgb_colours().unwrap()), wanted),
            _ => {
                let uvs = look.uvs.unwrap();
                let found = back.drawn.triangles[1].map(|corner| uvs[corner.index()]);
                assert_eq!(found, corners);
                assert_eq!(&look.images[0].encoded[1..4], b"PNG");
            }
        }
    }
}

#[test]
fn broken_files_are_refused_in_a_sentence_that_names_the_fault() {
    let item = "<item objectid=\"1\"/>";
    let far = square(1, "").replace("v3=\"3\"", "v3=\"4\"");
    let laughs: String = (2..40)
        .map(|id| {
            let below = format!("<component objectid=\"{}\"/>", id - 1).repeat(2);
            format!("<object id=\"{id}\"><components>{below}</components></object>")
        })
        .collect();
    let recursive = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    for (resources, build, words) in [
        (far, item, vec!["triangle", "object 1"]),
        (square(1, ""), "<item objectid=\"2\"/>", vec!["object 2"]),
        (square(1, ""), "<item/>", vec!["objectid", "missing"]),
        (square(1, "").replace("1e0", "wide"), item, vec!["`x`", "wide"]),
        (square(1, "").replace("v1=\"0\"", "v1=\"-1\""), item, vec!["`v1`", "-1"]),
        (
            square(1, ""),
            "<item objectid=\"1\" transform=\"1 0 0\"/>",
            vec!["transform", "twelve"],
        ),
        (
            square(1, ""),
            "<item objectid=\"1\" p:path=\"/none.model\"/>",
            vec!["none.model"],
        ),
        (recursive.to_owned(), item, vec!["object 1", "itself"]),
        (square(1, "") + &laughs, "<item objectid=\"39\"/>", vec!["more often"]),
        (square(1, "").replace("</mesh>", "</mush>"), item, vec!["XML"]),
    ] {
        let said = refusal(&with_strangers(&model(&resources, build)), Format::Threemf);
        assert!(words.iter().all(|word| said.contains(word)), "{words:?}: {said}");
    }
    let whole = with_strangers(&model(&square(1, ""), item));
    for length in 0..whole.len() {
        let said = refusal(&whole[..length], Format::Threemf);
        assert!(
            said.contains("archive") && said.lines().count() == 1,
            "{length}: {said}"
        );
    }
    assert!(refusal(&packed(&[("a", b"b")]), Format::Threemf).contains(MODEL));
    assert!(refusal(&with_strangers("<other/>"), Format::Threemf).contains("model"));
}

/// A part may unpack to a multiple of its archive, but not to any size: its declared size is not believed.
#[test]
fn an_archive_that_unpacks_to_too_much_is_refused() {
    let bomb = packed(&[(MODEL, &vec![b' '; 80 << 20])]);
    assert!(bomb.len() < 1 << 20);
    let said = refusal(&bomb, Format::Threemf);
    assert!(said.contains("unpacks to more"), "{said}");
}

/// A position that is no number is set aside by the welding, as in every format, and saved as it was.
#[test]
fn a_vertex_that_is_no_number_stays_as_it_is() {
    let text = model(&square(1, "").replace("0.50", "NaN"), "<item objectid=\"1\"/>");
    let opened = try_open(&with_strangers(&text), Format::Threemf).unwrap();
    assert!(opened.drawn.positions[0].y.is_nan());
    let up = moved(&opened, |vertex| vertex == 1, |p| p + DVec3::Z);
    let after = save(&opened, &up);
    assert!(part(&after, MODEL).contains("y=\"NaN\""));
}
