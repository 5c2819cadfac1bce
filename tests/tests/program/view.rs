//! The view of a shape: the triangle under a pixel is the one that a ray hits, on deformed scans; and the pictures that
//! `pliant render` writes. Skipped by name if there is no graphics device.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::path::Path;

use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_editor::{Camera, Look, NamedView, Projection};
use pliant_mesh::{Bvh, Model};
use pliant_picture::drawing::{self, Drawing};
use pliant_render::{Frame, Headless, IdTarget, PixelRect, Renderer};
use pliant_tests::{Folder, assets, datum, open, run};

const SIZE_PX: [u32; 2] = [640, 480];

fn renderer() -> Option<Renderer> {
    match Headless::new() {
        Ok(headless) => Some(headless.renderer),
        Err(error) => {
            eprintln!("skipped: pictures ({error})");
            None
        }
    }
}

/// A bend, a twist and a bulge at once.
fn bent(model: &Model) -> Vec<DVec3> {
    let bounds = model.bounds().unwrap();
    let (centre, size) = (bounds.centre(), bounds.diagonal());
    let moved = |&p: &DVec3| {
        let q = (p - centre) / size;
        let turned = DQuat::from_rotation_y(1.3 * q.y) * q;
        let bent = turned + DVec3::new(0.5 * q.y * q.y, 0.0, 0.08 * (9.0 * q.x).sin());
        centre + bent * size - p
    };
    model.surface.positions.iter().map(moved).collect()
}

/// The triangle that each pixel shows.
fn ids(renderer: &mut Renderer, model: &Model, displacements: &[DVec3], camera: &Camera) -> Vec<Option<u32>> {
    let drawing = Drawing::new(model, pliant_io::Appearance::default(), Default::default());
    // As in the window, the chunks' boxes come from the rest shape and move with the displacements.
    let rest = vec![DVec3::ZERO; displacements.len()];
    let mut surface = drawing.upload(renderer, &drawing.pose(model, &rest)).unwrap();
    surface
        .update_shape(renderer.gpu(), &drawing.pose(model, displacements).data())
        .unwrap();
    let [width, height] = SIZE_PX;
    let frame = Frame {
        view: &drawing::view(
            camera,
            DVec2::new(f64::from(width), f64::from(height)),
            drawing.centre(),
        ),
        style: &drawing::style(&Look::default(), 1.0),
        surfaces: &[&surface],
        grid: None,
        overlays: &[],
    };
    let request = renderer
        .pick(&mut IdTarget::new(), SIZE_PX, PixelRect::whole(SIZE_PX), &frame)
        .unwrap();
    let ids = request.wait(renderer).unwrap().ids;
    ids.into_iter().map(|id| id.map(|id| id.triangle)).collect()
}

#[test]
fn the_triangle_under_ten_thousand_pixels_is_the_one_that_a_ray_meets() {
    let Some(mut renderer) = renderer() else { return };
    let mut files = vec![assets().join("creature.glb"), assets().join("cactus.glb")];
    files.extend(["scans/horse.ply", "scans/armadillo.obj"].into_iter().filter_map(datum));
    let pixels_each = 10_000 / files.len();
    let mut compared = 0;
    for (number, file) in files.iter().enumerate() {
        let loaded = open(file);
        let model = &loaded.model;
        let displacements = bent(model);
        let moved: Vec<DVec3> = model
            .surface
            .positions
            .iter()
            .zip(&displacements)
            .map(|(&p, &d)| p + d)
            .collect();
        let mut bvh = Bvh::build(&model.surface.positions, &model.surface.triangles);
        bvh.refit(|vertex| moved[vertex.index()]);
        let size_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]));
        let mut camera = Camera {
            scale: model.bounds().unwrap().diagonal(),
            projection: if number % 2 == 0 {
                Projection::Perspective
            } else {
                Projection::Orthographic
            },
            ..Camera::default()
        };
        camera.look_from(NamedView::NAMES[number % NamedView::NAMES.len()].1);
        camera.frame(&moved, size_px);
        let ids = ids(&mut renderer, model, &displacements, &camera);
        // A fixed walk over the pixels that visits each one once.
        let (mut asked, mut beside) = (0, 0);
        let mut pixel = 12_345_u64;
        while asked < pixels_each {
            pixel = pixel
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let at = (pixel >> 33) as usize % ids.len();
            let Some(seen) = ids[at] else { continue };
            asked += 1;
            let (x, y) = (at as u32 % SIZE_PX[0], at as u32 / SIZE_PX[0]);
            let position_px = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let met = |offset: DVec2| {
                let ray = camera.ray(position_px + offset, size_px);
                bvh.ray(ray.origin, ray.direction)
                    .map(|hit| model.drawn.triangle_of_surface()[hit.triangle as usize])
            };
            if met(DVec2::ZERO) == Some(seen) {
                continue;
            }
            // The device snaps corners to 1/256 of a pixel, so close to an edge either triangle is right.
            let near = [-1.0, 1.0]
                .iter()
                .flat_map(|s| [DVec2::X * *s, DVec2::Y * *s, DVec2::new(*s, 1.0), DVec2::new(*s, -1.0)]);
            let is_beside = near.map(|offset| offset * 0.02).any(|offset| met(offset) == Some(seen));
            assert!(
                is_beside,
                "{}: pixel {x}, {y} shows {seen}, the ray meets {:?}",
                file.display(),
                met(DVec2::ZERO)
            );
            beside += 1;
        }
        // Few pixels are that close to an edge, even though triangles are about as large as pixels.
        assert!(
            10 * beside < asked,
            "{}: {beside} of {asked} lie beside an edge",
            file.display()
        );
        compared += asked;
    }
    assert!(compared >= 9_999, "{compared}");
}

fn picture(path: &Path) -> image::RgbaImage {
    image::open(path).unwrap().into_rgba8()
}

/// `pliant render` of the creature with its edit and further arguments.
fn rendered(folder: &Folder, name: &str, arguments: &[&str]) -> image::RgbaImage {
    let output = folder.at(name);
    let mut line = vec!["render".to_owned(), assets().join("creature.glb").display().to_string()];
    line.extend(["--output".to_owned(), output.display().to_string()]);
    line.extend([
        "--edit".to_owned(),
        assets().join("creature.edit.json").display().to_string(),
    ]);
    line.extend(["--size".to_owned(), "160x120".to_owned()]);
    line.extend(arguments.iter().map(|&argument| argument.to_owned()));
    run(line).done();
    if output.exists() {
        picture(&output)
    } else {
        image::RgbaImage::new(0, 0)
    }
}

/// A sheet has a cell for each method, equal for the same methods and different otherwise, and its report is that of
/// `apply`.
#[test]
fn a_comparison_shows_each_method_beside_the_others_and_tells_what_apply_does() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    let (sheet, report) = (folder.at("sheet.png"), folder.at("report.json"));
    let [file, edit] = ["creature.glb", "creature.edit.json"].map(|name| assets().join(name));
    let compare = |methods: &str| {
        let line = ["compare", "--methods", methods, "--size", "480x200", "--output"].map(std::ffi::OsString::from);
        let rest = [
            sheet.clone(),
            "--report".into(),
            report.clone(),
            "--edit".into(),
            edit.clone(),
            file.clone(),
        ];
        run(line.into_iter().chain(rest.map(Into::into))).done();
        let told: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&report).unwrap()).unwrap();
        (picture(&sheet), told)
    };
    let (picture, told) = compare("bilaplacian,arap");
    assert_eq!(picture.dimensions(), (480, 200));
    let cell = |number: u32| image::imageops::crop_imm(&picture, 240 * number, 0, 240, 150).to_image();
    assert!(cell(0) != cell(1));
    let bent = folder.at("bent.glb");
    let words = ["apply", "--method", "arap", "--edit"]
        .map(std::ffi::OsString::from)
        .into_iter();
    let applied = folder.at("applied.json");
    let rest = [
        edit.clone(),
        "--output".into(),
        bent,
        "--report".into(),
        applied.clone(),
        file.clone(),
    ];
    run(words.chain(rest.map(Into::into))).done();
    let applied: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(applied).unwrap()).unwrap();
    for member in ["distortion", "energy", "iterations", "free_vertices", "converged"] {
        assert_eq!(told["methods"]["arap"][member], applied[member], "{member}");
    }
    let errors = ["bilaplacian", "arap"].map(|name| told["methods"][name]["detail_error_ratio"].as_f64().unwrap());
    assert!(
        errors.contains(&1.0) && errors.iter().all(|error| *error >= 1.0),
        "{errors:?}"
    );
}

#[test]
fn every_shading_gives_a_picture_of_its_own() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    let shadings = [
        "clay",
        "material",
        "regions",
        "stiffness",
        "distortion",
        "area",
        "curvature",
        "zebra",
        "normals",
    ];
    let mut pictures: Vec<(&str, image::RgbaImage)> = Vec::new();
    for shading in shadings {
        let picture = rendered(&folder, "a.png", &["--shading", shading]);
        assert_eq!(picture.dimensions(), (160, 120));
        for (other, seen) in &pictures {
            let differing = picture.pixels().zip(seen.pixels()).filter(|(a, b)| a != b).count();
            assert!(differing > 400, "{shading} looks like {other}");
        }
        pictures.push((shading, picture));
    }
}

#[test]
fn a_transparent_picture_has_alpha_only_where_the_surface_is() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    let opaque = rendered(&folder, "a.png", &[]);
    let clear = rendered(&folder, "b.png", &["--transparent"]);
    assert_eq!(clear.get_pixel(1, 1).0[3], 0);
    let whole = clear
        .pixels()
        .zip(opaque.pixels())
        .filter(|(clear, _)| clear.0[3] == 255);
    let (mut count, mut off) = (0, 0);
    for (clear, opaque) in whole {
        count += 1;
        off += usize::from(clear != opaque);
    }
    assert!(count > 1000 && off == 0, "{count} {off}");
}

#[test]
fn a_shape_stands_in_a_picture_as_it_does_in_the_window_unless_the_axis_is_given() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    // A cone about the z axis, which stands on its disc.
    let cone = pliant_mesh::shapes::turned(24, 24, |share| match share {
        ..0.3 => DVec2::new(share / 0.3, -1.0),
        _ => DVec2::new((1.0 - share) / 0.7, 2.0 * (share - 0.3) / 0.7 - 1.0),
    });
    let turn = DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let on_z = folder.write_mesh("z.off", &cone);
    let on_y = folder.write_mesh("y.off", &pliant_mesh::shapes::moved(&cone, turn));
    let drawn = |file: &Path, up: &[&str]| {
        let output = folder.at("cone.png");
        let words = ["render", "--size", "80x60", "--grid"]
            .iter()
            .chain(up)
            .map(std::ffi::OsString::from);
        run(words.chain(["--output".into(), output.clone().into(), file.into()])).done();
        picture(&output)
    };
    for (file, own, other) in [(on_z, "z", "y"), (on_y, "y", "z")] {
        let guessed = drawn(&file, &[]);
        assert!(guessed == drawn(&file, &["--up", own]), "{own}");
        assert!(guessed == drawn(&file, &["--up", "guess"]), "{own}");
        assert!(guessed != drawn(&file, &["--up", other]), "{own}");
    }
}

#[test]
fn a_turntable_comes_all_around_and_begins_at_the_view() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    let still = rendered(&folder, "still.png", &[]);
    rendered(&folder, "turn.png", &["--turntable", "4"]);
    assert!(!folder.at("turn.png").exists() && !folder.at("turn-0005.png").exists());
    let turned: Vec<_> = (1..=4)
        .map(|n| picture(&folder.at(&format!("turn-000{n}.png"))))
        .collect();
    assert_eq!(turned[0], still);
    for n in 1..4 {
        assert_ne!(turned[n], turned[n - 1]);
    }
}

#[test]
fn images_that_a_picture_does_not_show_are_told() {
    let Some(_) = renderer() else { return };
    let folder = Folder::new();
    let model = folder.write(
        "sheet.obj",
        "mtllib sheet.mtl\nusemtl cloth\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
    );
    folder.write("sheet.mtl", "newmtl cloth\nmap_Kd skin.png\n");
    let image = |bytes: &[u8]| folder.write("skin.png", bytes);
    let mut whole = std::io::Cursor::new(Vec::new());
    image::RgbaImage::new(8, 8)
        .write_to(&mut whole, image::ImageFormat::Png)
        .unwrap();
    let told = |shading: &str| {
        let words = ["render", "--size", "16x16", "--shading", shading, "--output"];
        let words = words.map(std::ffi::OsString::from).into_iter();
        run(words.chain([folder.at("a.png").into(), model.clone().into()]))
            .done()
            .out
    };
    image(whole.get_ref());
    assert_eq!(told("material"), "");
    image(&whole.get_ref()[..20]);
    let said = told("material");
    assert!(
        said.lines().count() == 1 && said.contains("skin.png") && said.contains("is not shown"),
        "{said:?}"
    );
    // A shading that shows no image reports no missing one.
    assert_eq!(told("clay"), "");
}
