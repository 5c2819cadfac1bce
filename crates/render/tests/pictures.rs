//! Laws of pictures, tested if there is a device.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use glam::Vec3;
use pliant_render::{
    AlphaMode, Background, Encoding, Frame, Grid, Map, Matcap, Material, MaterialGroup, RenderError, Samples, Shading,
    Shadows, Style, Surface, SurfaceData, Target, TextureData, Wireframe, Wrap, region,
};
use rig::{SIZE_PX, Shape, brightness, draw, front_view, is_near, parallel_front_view, pixel_at, renderer};

const CORNER: [f32; 3] = [-1.9, 1.25, 0.0];

fn style(shading: Shading) -> Style {
    Style {
        shading,
        ..Style::default()
    }
}

#[test]
fn a_sphere_is_brighter_towards_the_key_light_than_at_its_far_silhouette() {
    let Some(mut headless) = renderer() else { return };
    let sphere = Shape::sphere(4).upload(&headless.renderer);
    for view in [front_view(), parallel_front_view()] {
        let image = draw(
            &mut headless.renderer,
            &view,
            &style(Shading::Matcap(Matcap::Clay)),
            &[&sphere],
            &[],
        );
        let at = |x: f32, y: f32| brightness(pixel_at(&image, &view, [x, y, (1.0 - x * x - y * y).sqrt()]));
        assert!(at(-0.4, 0.5) > at(0.0, 0.0), "the key comes from the upper left");
        assert!(at(0.0, 0.0) > at(0.7, -0.6) + 40.0, "the far side lies in shadow");
        assert!(at(0.7, -0.6) > 15.0, "the shadow is not black");
        assert!(at(-0.4, 0.5) < 250.0, "the light does not clip");
    }
}

#[test]
fn an_empty_frame_shows_the_background() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let sphere = Shape::sphere(3).upload(&headless.renderer);
    let background = Background::Gradient {
        top: [200, 100, 50],
        bottom: [20, 40, 80],
    };
    let style = Style {
        background,
        ..Style::default()
    };
    let image = draw(&mut headless.renderer, &view, &style, &[&sphere], &[]);
    let empty = draw(&mut headless.renderer, &view, &style, &[], &[]);
    assert!(is_near(image.pixel(0, 0).unwrap(), [200, 100, 50, 255], 2));
    assert!(is_near(image.pixel(149, 99).unwrap(), [20, 40, 80, 255], 2));
    assert_eq!(pixel_at(&image, &view, CORNER), pixel_at(&empty, &view, CORNER));
    assert_ne!(pixel_at(&image, &view, [0.0; 3]), pixel_at(&empty, &view, [0.0; 3]));
}

#[test]
fn a_transparent_background_has_no_alpha() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let sphere = Shape::sphere(3).upload(&headless.renderer);
    let style = Style {
        background: Background::Transparent,
        ..Style::default()
    };
    let image = draw(&mut headless.renderer, &view, &style, &[&sphere], &[]);
    assert_eq!(pixel_at(&image, &view, CORNER), [0; 4]);
    assert_eq!(pixel_at(&image, &view, [0.0; 3])[3], 255);
}

#[test]
fn the_nearer_surface_hides_the_farther_one_in_either_order() {
    let Some(mut headless) = renderer() else { return };
    let painted = |z: f32, colour: [u8; 4]| {
        let square = Shape::square(0.0, z, 1.0 - 0.1 * z);
        let colours = [colour; 4];
        let data = SurfaceData {
            colours: Some(&colours),
            ..square.data()
        };
        Surface::new(headless.renderer.gpu(), &data).unwrap()
    };
    let (near, far) = (painted(0.004, [255, 0, 0, 255]), painted(0.0, [0, 0, 255, 255]));
    let (from_near, from_afar) = (painted(-3000.0, [255, 0, 0, 255]), painted(-3010.0, [0, 0, 255, 255]));
    for view in [front_view(), parallel_front_view()] {
        for surfaces in [[&near, &far], [&far, &near]] {
            let image = draw(&mut headless.renderer, &view, &style(Shading::Material), &surfaces, &[]);
            let [red, _, blue, _] = pixel_at(&image, &view, [0.1, 0.2, 0.0]);
            assert!(red > 100 && blue < 60, "red is nearer");
        }
    }
    // Reversed depth stays precise far away: two squares at distance 3000, a third of a percent apart.
    for surfaces in [[&from_near, &from_afar], [&from_afar, &from_near]] {
        let image = draw(
            &mut headless.renderer,
            &front_view(),
            &style(Shading::Material),
            &surfaces,
            &[],
        );
        let [red, _, blue, _] = image.pixel(75, 50).unwrap();
        assert!(red > 100 && blue < 60, "red is nearer far away, too");
    }
}

#[test]
fn region_colours_show_in_regions_only_and_change_in_place() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let square = Shape::square(0.0, 0.0, 1.0);
    let surface = square.upload(&headless.renderer);
    let clay = draw(
        &mut headless.renderer,
        &view,
        &style(Shading::Matcap(Matcap::Clay)),
        &[&surface],
        &[],
    );
    let plain = draw(
        &mut headless.renderer,
        &view,
        &Style {
            region_share: 1.0,
            ..style(Shading::Matcap(Matcap::Clay))
        },
        &[&surface],
        &[],
    );
    assert_eq!(clay, plain, "no regions are clay");
    surface
        .update_regions(headless.renderer.gpu(), &[region::HANDLE; 4])
        .unwrap();
    let gold = draw(
        &mut headless.renderer,
        &view,
        &Style {
            region_share: 1.0,
            ..style(Shading::Matcap(Matcap::Clay))
        },
        &[&surface],
        &[],
    );
    let still_clay = draw(
        &mut headless.renderer,
        &view,
        &style(Shading::Matcap(Matcap::Clay)),
        &[&surface],
        &[],
    );
    assert_eq!(clay, still_clay);
    let [red, green, blue, _] = pixel_at(&gold, &view, [0.1; 3]);
    assert!(red > green && green > blue + 40, "a handle is golden");
    surface
        .update_regions(headless.renderer.gpu(), &[region::FREE; 4])
        .unwrap();
    let free = draw(
        &mut headless.renderer,
        &view,
        &Style {
            region_share: 1.0,
            ..style(Shading::Matcap(Matcap::Clay))
        },
        &[&surface],
        &[],
    );
    let [red, _, blue, _] = pixel_at(&free, &view, [0.1; 3]);
    assert!(blue > red + 40, "free is blue");
}

#[test]
fn edges_show_as_thin_dark_lines_that_leave_faces_alone() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let square = Shape::square(0.0, 0.0, 1.0).upload(&headless.renderer);
    let background = Background::Gradient {
        top: [220; 3],
        bottom: [220; 3],
    };
    let unwired = Style {
        background,
        ..Style::default()
    };
    let wired = Style {
        wireframe: Wireframe::On,
        ..unwired
    };
    let plain = draw(&mut headless.renderer, &view, &unwired, &[&square], &[]);
    let wired = draw(&mut headless.renderer, &view, &wired, &[&square], &[]);
    let middle = SIZE_PX[1] / 2;
    let darker: Vec<u32> = (0..SIZE_PX[0])
        .filter(|&x| brightness(wired.pixel(x, middle).unwrap()) + 20.0 < brightness(plain.pixel(x, middle).unwrap()))
        .collect();
    assert!(
        (2..=6).contains(&darker.len()),
        "a row crosses two sides and the diagonal: {darker:?}"
    );
    let of_face = [0.4, -0.2, 0.0];
    assert_eq!(pixel_at(&wired, &view, of_face), pixel_at(&plain, &view, of_face));
}

#[test]
fn a_shadow_is_darker_under_what_is_nearer_to_the_ground_and_ends_beside_it() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    // The squares face the eye, and the ground lies behind them.
    let ground = |z: f32| Grid {
        middle: [0.0, 0.0, z],
        along: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        step: 1.0,
        reach: 1.0,
        fine_share: 0.0,
        axes: [0.0; 2],
        colour: [0; 4],
        axis_colours: [[0; 4]; 2],
    };
    let background = Background::Gradient {
        top: [220; 3],
        bottom: [220; 3],
    };
    let lit = Style {
        background,
        ..Style::default()
    };
    let shaded = Style {
        shadows: Shadows::On,
        ..lit
    };
    let view = parallel_front_view();
    let mut surface = Shape::square(0.0, 0.0, 0.5).upload(renderer);
    let mut at_height = |height: f32, position: [f32; 3]| {
        renderer.update_shadow(&mut surface, &ground(-height)).unwrap();
        let [off, on] = [&lit, &shaded].map(|style| draw(renderer, &view, style, &[&surface], &[]));
        brightness(pixel_at(&off, &view, position)) - brightness(pixel_at(&on, &view, position))
    };
    // Just outside of the square, which hides the ground behind it.
    let beside = [0.52, 0.1, 0.0];
    let [near, higher, far] = [0.01, 0.1, 0.9].map(|height| at_height(height, beside));
    assert!(near > higher + 3.0 && higher > 3.0, "{near} {higher}");
    assert_eq!(far, 0.0);
    assert_eq!(at_height(0.01, [1.0, 0.1, 0.0]), 0.0);
}

#[test]
fn vertices_move_in_place_and_a_wrong_count_is_refused() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let (here, there) = (Shape::square(-0.6, 0.0, 0.3), Shape::square(0.6, 0.0, 0.3));
    let mut surface = here.upload(&headless.renderer);
    surface
        .update_positions(headless.renderer.gpu(), &there.positions)
        .unwrap();
    let moved = draw(
        &mut headless.renderer,
        &view,
        &style(Shading::Matcap(Matcap::Clay)),
        &[&surface],
        &[],
    );
    let made_there = there.upload(&headless.renderer);
    let expected = draw(
        &mut headless.renderer,
        &view,
        &style(Shading::Matcap(Matcap::Clay)),
        &[&made_there],
        &[],
    );
    assert_eq!(moved, expected);
    let error = surface
        .update_normals(headless.renderer.gpu(), &there.normals[1..])
        .unwrap_err();
    assert_eq!(
        error,
        RenderError::Length {
            what: "normals",
            expected: 4,
            found: 3
        }
    );
}

#[test]
fn the_back_of_a_single_sided_surface_is_dimmer_and_normals_may_be_missing() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let centre = [0.1, 0.2, 0.0];
    let mut without_normals = Shape::square(0.0, 0.0, 1.0);
    let front = without_normals.upload(&headless.renderer);
    without_normals.normals.fill([0.0; 3]);
    let bare = without_normals.upload(&headless.renderer);
    let back = Shape::square(0.0, 0.0, 1.0)
        .turned_inside_out()
        .upload(&headless.renderer);
    for shading in [Shading::Matcap(Matcap::Clay), Shading::Material] {
        let shown = |renderer: &mut _, surface| {
            brightness(pixel_at(
                &draw(renderer, &view, &style(shading), &[surface], &[]),
                &view,
                centre,
            ))
        };
        let lit = shown(&mut headless.renderer, &front);
        assert!(shown(&mut headless.renderer, &back) < 0.8 * lit);
        assert!((shown(&mut headless.renderer, &bare) - lit).abs() < 8.0);
    }
}

#[test]
fn textures_show_upright_and_masks_cut_holes() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let square = Shape::square(0.0, 0.0, 1.0);
    // In glTF v = 0 is the image's first row, red here; the last row is green, and its right half has alpha 0.
    let (width, height) = (32_u32, 8_u32);
    let rgba: Vec<u8> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .flat_map(|(x, y)| {
            let alpha = if x < width / 2 { 255 } else { 0 };
            if y < height / 2 {
                [255, 0, 0, alpha]
            } else {
                [0, 255, 0, alpha]
            }
        })
        .collect();
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let shown = |renderer: &mut pliant_render::Renderer, alpha| {
        let map = Map {
            wrap: [Wrap::Clamp; 2],
            ..Map::of(0)
        };
        let material = Material {
            base_colour_map: Some(map),
            alpha,
            ..Material::default()
        };
        let data = SurfaceData {
            uvs: Some(&uvs),
            materials: &[material],
            groups: &[MaterialGroup {
                triangles: 0..2,
                material: 0,
            }],
            textures: &[TextureData {
                width,
                height,
                rgba: &rgba,
                encoding: Encoding::Srgb,
            }],
            ..square.data()
        };
        let surface = Surface::new(renderer.gpu(), &data).unwrap();
        draw(renderer, &view, &style(Shading::Material), &[&surface], &[])
    };
    let empty = draw(&mut headless.renderer, &view, &style(Shading::Material), &[], &[]);
    let opaque = shown(&mut headless.renderer, AlphaMode::Opaque);
    let masked = shown(&mut headless.renderer, AlphaMode::Mask { cutoff: 0.5 });
    let blended = shown(&mut headless.renderer, AlphaMode::Blend);
    let (upper_left, lower_left, right) = ([-0.5, 0.5, 0.0], [-0.5, -0.5, 0.0], [0.5, 0.5, 0.0]);
    for image in [&opaque, &masked, &blended] {
        let [red, green, ..] = pixel_at(image, &view, upper_left);
        assert!(red > 120 && green < 60, "the first row is above");
        let [red, green, ..] = pixel_at(image, &view, lower_left);
        assert!(green > 120 && red < 60, "the last row is below");
    }
    assert!(pixel_at(&opaque, &view, right)[0] > 120);
    assert_eq!(pixel_at(&masked, &view, right), pixel_at(&empty, &view, right));
    assert_eq!(pixel_at(&blended, &view, right), pixel_at(&empty, &view, right));
}

#[test]
fn mipmaps_keep_the_mean_light() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    // A fine checkerboard, minified on the screen, compared with a plain grey of the same mean light.
    let side = 512_u32;
    let chequer: Vec<u8> = (0..side * side)
        .flat_map(|at| {
            if (at % side + at / side).is_multiple_of(2) {
                [255; 4]
            } else {
                [0, 0, 0, 255]
            }
        })
        .collect();
    let half_light = [188, 188, 188, 255];
    let square = Shape::square(0.0, 0.0, 1.0);
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut shown = |rgba: &[u8], side| {
        let material = Material {
            base_colour_map: Some(Map::of(0)),
            ..Material::default()
        };
        let data = SurfaceData {
            uvs: Some(&uvs),
            materials: &[material],
            groups: &[MaterialGroup {
                triangles: 0..2,
                material: 0,
            }],
            textures: &[TextureData {
                width: side,
                height: side,
                rgba,
                encoding: Encoding::Srgb,
            }],
            ..square.data()
        };
        let surface = Surface::new(headless.renderer.gpu(), &data).unwrap();
        let image = draw(
            &mut headless.renderer,
            &view,
            &style(Shading::Material),
            &[&surface],
            &[],
        );
        pixel_at(&image, &view, [0.2, 0.1, 0.0])
    };
    assert!(is_near(shown(&chequer, side), shown(&half_light, 1), 3));
}

#[test]
fn four_samples_smooth_borders_and_change_nothing_else() {
    let Some(mut headless) = renderer() else { return };
    let (view, style) = (front_view(), style(Shading::Matcap(Matcap::Clay)));
    let sphere = Shape::sphere(4).upload(&headless.renderer);
    let frame = Frame {
        view: &view,
        style: &style,
        surfaces: &[&sphere],
        grid: None,
        overlays: &[],
    };
    let jagged = headless.renderer.draw_to_image(SIZE_PX, Samples::One, &frame).unwrap();
    let smooth = headless.renderer.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
    let again = headless.renderer.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
    assert_eq!(smooth, again, "the same frame gives the same bytes");
    let differing = jagged
        .rgba
        .chunks_exact(4)
        .zip(smooth.rgba.chunks_exact(4))
        .filter(|(one, four)| one.iter().zip(*four).any(|(a, b)| a.abs_diff(*b) > 12))
        .count();
    assert!(
        (20..600).contains(&differing),
        "only the contour differs: {differing} pixels"
    );
}

#[test]
fn an_empty_size_draws_nothing_and_a_too_large_size_is_rejected() {
    let Some(mut headless) = renderer() else { return };
    let (view, style) = (front_view(), Style::default());
    let empty = Shape::default().upload(&headless.renderer);
    let wired = Style {
        wireframe: Wireframe::On,
        shading: Shading::Material,
        ..style
    };
    let frame = Frame {
        view: &view,
        style: &wired,
        surfaces: &[&empty],
        grid: None,
        overlays: &[],
    };
    let renderer = &mut headless.renderer;
    let mut target = Target::new();
    renderer.draw(&target, &frame).unwrap();
    assert_eq!(renderer.read(&target), Ok(None));
    assert_eq!(target.resize(renderer.device(), [0, 7], Samples::Four), Ok(false));
    assert_eq!(target.resize(renderer.device(), [1, 1], Samples::Four), Ok(true));
    assert_eq!(target.resize(renderer.device(), [1, 1], Samples::Four), Ok(false));
    renderer.draw(&target, &frame).unwrap();
    assert_eq!(
        target
            .resize(renderer.device(), [1 << 30, 8], Samples::Four)
            .map_err(|error| error.to_string())
            .err()
            .map(|text| text.starts_with("a picture of 1073741824 by 8 pixels is too large")),
        Some(true)
    );
    assert_eq!(target.size_px(), [0, 0]);
    let refused = renderer.draw_to_image([0, 5], Samples::One, &frame);
    assert_eq!(refused, Err(RenderError::EmptyPicture { width: 0, height: 5 }));
}

#[test]
fn non_finite_numbers_affect_nothing_else() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let mut broken = Shape::sphere(2);
    broken.positions[0] = [f32::NAN, f32::INFINITY, 0.0];
    broken.normals[3] = [f32::NAN; 3];
    let broken = broken.upload(&headless.renderer);
    let square = Shape::square(0.0, 2.0, 0.3).upload(&headless.renderer);
    let style = Style {
        wireframe: Wireframe::On,
        ..Style::default()
    };
    let image = draw(&mut headless.renderer, &view, &style, &[&broken, &square], &[]);
    let alone = draw(&mut headless.renderer, &view, &style, &[&square], &[]);
    let inside = (Vec3::new(0.05, 0.12, 2.0)).to_array();
    assert_eq!(pixel_at(&image, &view, inside), pixel_at(&alone, &view, inside));
}
