//! USDZ: which meshes are drawn, saves that leave the rest of the layer as it is, new files, and broken ones.

use std::io::{Cursor, Read, Write};

use crate::text::{moved, open, refusal, same_bits, save, save_as};
use glam::DVec3;
use pliant_io::{Format, MorphDeltas, Placement, Save, SceneAndDrawn};
use pliant_mesh::{Cancel, Progress};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// A layer with these prims.
fn layer(prims: &str) -> String {
    format!("#usda 1.0\n(\n    defaultPrim = \"A\"\n    customLayerData = {{ string by = \"(someone)\" }}\n)\n{prims}")
}

/// A square of a quad that is mesh `A`, with these other properties and children.
fn square(more: &str) -> String {
    layer(&format!(
        "def Mesh \"A\" (\n    prepend apiSchemas = [\"MaterialBindingAPI\"]\n)\n{{ # a square\n\
         int[] faceVertexCounts = [4]\n int[] faceVertexIndices = [0, 1, 2, 3]\n\
         point3f[] points = [(0, 0, 0), (1.50, 0, 0), (1.5, 1e0, 0), (0, 1, 0)] ( doc = \"corners\" )\n{more}\n}}\n"
    ))
}

fn packed(layer: &[u8]) -> Vec<u8> {
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in [("m.usda", layer), ("t/0.png", &[1, 2, 3])] {
        zip.start_file(name, stored.with_alignment(64)).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn opened(layer: &str) -> SceneAndDrawn {
    open(&packed(layer.as_bytes()), Format::Usdz)
}

fn text_of(archive: &[u8]) -> String {
    let mut zip = ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut text = String::new();
    zip.by_index(0).unwrap().read_to_string(&mut text).unwrap();
    text
}

/// Asserts what the specification of USDZ asks of an archive.
fn assert_is_mapped(archive: &[u8]) {
    let mut zip = ZipArchive::new(Cursor::new(archive)).unwrap();
    for place in 0..zip.len() {
        let file = zip.by_index(place).unwrap();
        assert_eq!(file.compression(), CompressionMethod::Stored);
        assert_eq!(file.data_start().unwrap() % 64, 0, "part {place}");
    }
}

#[test]
fn only_the_numbers_of_moved_points_change() {
    let text = square("custom string kept = \"[(\"");
    let opened = opened(&text);
    assert_eq!(opened.drawn.triangles.len(), 2);
    let up = moved(&opened, |vertex| vertex == 1, |p| p + DVec3::Z * 0.25);
    let after = save(&opened, &up);
    let expected = text.replace("(1.50, 0, 0)", "(1.50, 0, 0.25)");
    assert_ne!(expected, text);
    assert_eq!(text_of(&after), expected);
    assert_is_mapped(&after);
    let again = open(&after, Format::Usdz);
    assert!(same_bits(&again.drawn.positions, &up));
}

#[test]
fn transforms_place_meshes_and_hidden_ones_are_not_drawn() {
    let inner = square("double xformOp:rotateZ = 90\nuniform token[] xformOpOrder = [\"xformOp:rotateZ\"]");
    let mesh = inner.split_once("def Mesh").unwrap().1;
    let text = layer(&format!(
        "def Xform \"R\"\n{{\n double3 xformOp:translate = (10, 0, 5)\n float3 xformOp:scale = (2, 2, 2)\n\
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:scale\"]\n\
         def Mesh{mesh} def Mesh \"B\" {{ token visibility = \"invisible\" point3f[] points = [(0, 0, 0)] }} }}\n\
         class \"C\" {{ def Mesh \"D\" {{ point3f[] points = [(0, 0, 0)] }} }}"
    ));
    let opened = opened(&text);
    let wanted = [[10.0, 0.0, 5.0], [10.0, 3.0, 5.0], [8.0, 3.0, 5.0], [8.0, 0.0, 5.0]];
    assert_eq!(opened.drawn.positions.len(), wanted.len());
    for (found, wanted) in opened.drawn.positions.iter().zip(wanted) {
        assert!(found.distance(wanted.into()) < 1e-12, "{found}");
    }
    let up = moved(&opened, |vertex| vertex == 2, |p| p + DVec3::new(0.0, 0.0, 3.0));
    let again = open(&save(&opened, &up), Format::Usdz);
    assert!(again.drawn.positions[2].distance(up[2]) < 1e-6);
}

#[test]
fn normals_turn_with_the_surface_and_looks_at_corners_split_points() {
    let more = "normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] ( interpolation = \"vertex\" )\n\
                texCoord2f[] primvars:st = [(0, 0), (1, 0)] ( interpolation = \"faceVarying\" )\n\
                int[] primvars:st:indices = [0, 1, 1, 0]";
    let opened = opened(&square(more));
    let look = opened.scene.appearance();
    assert_eq!(look.uvs.unwrap()[1], [1.0, 1.0]);
    let tilted: Vec<DVec3> = opened
        .drawn
        .positions
        .iter()
        .map(|p| DVec3::new(0.0, p.y, p.x + 1.0))
        .collect();
    let after = text_of(&save(&opened, &tilted));
    assert!(after.contains("normals = [(-1, 0, 0), "), "{after}");

    let two = square("")
        .replace("[4]", "[4, 4]")
        .replace("[0, 1, 2, 3]", "[0, 1, 2, 3, 3, 2, 1, 0]");
    let uvs = "texCoord2f[] primvars:st = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 0), (5, 0), (1, 0), (0, 0)] \
               ( interpolation = \"faceVarying\" )\n}";
    let two = two.trim_end().strip_suffix('}').unwrap().to_owned() + uvs;
    let opened = super::usdz::opened(&two);
    assert_eq!((opened.drawn.positions.len(), opened.drawn.file_vertex_count), (5, 4));
}

#[test]
fn parts_are_turned_inside_out_and_back() {
    let text = square("")
        .replace("[4]", "[3, 4]")
        .replace("[0, 1, 2, 3]", "[0, 1, 2, 0, 2, 3, 1]");
    let bytes = packed(text.as_bytes());
    let opened = open(&bytes, Format::Usdz);
    let turned = |opened: &SceneAndDrawn| {
        let all = vec![true; opened.drawn.positions.len()];
        let save = Save {
            deltas: MorphDeltas::WhereFarOff,
            turned: &all,
            drawn: &opened.drawn,
            positions: &opened.drawn.positions,
            format: Format::Usdz,
            name: "out.usdz",
            placement: Placement::SameFolder,
        };
        let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
        let back = open(&saved.files[0].bytes, Format::Usdz);
        opened.scene.check_read_back(&save, None, None, &back).unwrap();
        back
    };
    let once = turned(&opened);
    assert_ne!(once.drawn.triangles, opened.drawn.triangles);
    let twice = turned(&once);
    assert_eq!(text_of(&save(&twice, &twice.drawn.positions)), text);
}

#[test]
fn a_bent_quad_may_be_drawn_by_its_other_diagonal() {
    let opened = opened(&square(""));
    let folded = moved(&opened, |vertex| vertex == 0, |p| p - DVec3::new(1.0, 1.0, 0.0));
    let save = Save {
        deltas: MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions: &folded,
        format: Format::Usdz,
        name: "out.usdz",
        placement: Placement::SameFolder,
    };
    let saved = opened.scene.save(&save, &Progress::new(), &Cancel::new()).unwrap();
    let back = open(&saved.files[0].bytes, Format::Usdz);
    assert_ne!(back.drawn.triangles, opened.drawn.triangles);
    opened.scene.check_read_back(&save, None, None, &back).unwrap();
}

#[test]
fn a_new_file_has_the_materials_colours_and_images_of_a_glb() {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus/rich.glb");
    let glb = open(&std::fs::read(corpus).unwrap(), Format::Glb);
    let saved = save_as(&glb, &glb.drawn.positions, Format::Usdz);
    let bytes = &saved.files[0].bytes;
    assert_is_mapped(bytes);
    let back = open(bytes, Format::Usdz);
    let (before, after) = (glb.scene.appearance(), back.scene.appearance());
    assert_eq!(before.uvs.is_some(), after.uvs.is_some());
    assert_eq!(before.normals.is_some(), after.normals.is_some());
    for (group, triangle) in before
        .groups
        .iter()
        .flat_map(|group| group.triangles.clone().map(move |t| (group, t)))
    {
        let found = after
            .groups
            .iter()
            .find(|found| found.triangles.contains(&triangle))
            .unwrap();
        let (wanted, found) = (&before.materials[group.material], &after.materials[found.material]);
        if before.colours.is_none() || wanted.base_colour_image.is_some() {
            assert_eq!(wanted.base_colour[..3], found.base_colour[..3]);
        }
        let image =
            |look: &pliant_io::Appearance, image: Option<usize>| image.map(|image| look.images[image].encoded.to_vec());
        let wanted = image(&before, wanted.base_colour_image).filter(|bytes| bytes.starts_with(b"\x89PNG"));
        assert_eq!(wanted, image(&after, found.base_colour_image));
    }
}

#[test]
fn what_is_not_a_plain_mesh_is_refused_with_a_remedy() {
    let animated = square("point3f[] points.timeSamples = { 0: [(0, 0, 0)], }");
    let referring = layer("def Mesh \"A\" ( prepend references = @other.usda@ ) { }");
    let varied = layer("def \"A\" { variantSet \"v\" = { \"a\" { } } }");
    let moving =
        square("double xformOp:rotateX.timeSamples = { 0: 1 }\nuniform token[] xformOpOrder = [\"xformOp:rotateX\"]");
    for text in [animated, referring, varied, moving] {
        let said = refusal(&packed(text.as_bytes()), Format::Usdz);
        assert!(said.contains(".glb"), "{said}");
    }
    let binary = refusal(&packed(b"PXR-USDC\0\0\0"), Format::Usdz);
    assert!(binary.contains("usdcat"), "{binary}");
    let faults = [
        ("[4]", "[5]"),
        ("[0, 1, 2, 3]", "[0, 1, 2, 4]"),
        ("[0, 1, 2, 3]", "[0, 1, 2, -1]"),
        ("(0, 1, 0)]", "(0, 1)]"),
        ("1.50", "x"),
        ("#usda 1.0", "#usd 1.0"),
    ];
    for (old, new) in faults {
        let said = refusal(&packed(square("").replace(old, new).as_bytes()), Format::Usdz);
        assert!(said.contains("not a readable USDZ file"), "{said}");
    }
    assert!(
        refusal(
            &packed(square("").trim_end().strip_suffix('}').unwrap().as_bytes()),
            Format::Usdz
        )
        .contains("ends")
    );
    assert!(
        refusal(
            &ZipWriter::new(Cursor::new(Vec::new())).finish().unwrap().into_inner(),
            Format::Usdz
        )
        .contains("empty")
    );
}
