//! Laws of meshes that are split into chunks and distributed over pages: the result looks and picks the same.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use std::sync::Arc;

use glam::{Vec3, Vec4Swizzles};
use pliant_render::{
    Borders, Detail, Frame, IdTarget, Image, PixelRect, Renderer, Samples, Shading, Style, Surface, View, Wireframe,
};
use rig::{SIZE_PX, Shape, draw, front_view, oblique_view, renderer};

/// 150,000 triangles in shuffled order.
fn large() -> Shape {
    let mut ring = Shape::open_ring(600, 143);
    let count = ring.triangles.len();
    ring.triangles = (0..count).map(|n| ring.triangles[n * 7919 % count]).collect();
    ring
}

/// Looks at one end of the ring from nearby.
fn close_view() -> View {
    let view_from_world = View::look_at(Vec3::new(0.9, 0.8, 1.4), Vec3::new(0.6, 0.6, 0.3), Vec3::Y);
    View::perspective(0.2, 1.5, 0.01, view_from_world)
}

fn pictures(renderer: &mut Renderer, surface: &Surface, view: &View) -> Vec<Image> {
    let wired = Style {
        wireframe: Wireframe::On,
        borders: Borders::On,
        ..Style::default()
    };
    let material = Style {
        shading: Shading::Material,
        ..Style::default()
    };
    let plain = Style::default();
    [plain, material, wired]
        .iter()
        .map(|style| draw(renderer, view, style, &[surface], &[]))
        .collect()
}

fn ids(renderer: &mut Renderer, surface: &Surface, view: &View) -> Vec<Option<u32>> {
    let style = Style::default();
    let frame = Frame {
        view,
        style: &style,
        surfaces: &[surface],
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
fn a_mesh_spread_over_several_buffers_looks_and_picks_the_same() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let shape = large();
    let mut whole = shape.upload(renderer);
    let mut spread = Surface::spread(renderer.gpu(), &shape.data(), 20_000, 60_000).unwrap();
    assert_eq!(whole.page_count(), 1);
    assert!(spread.page_count() >= 4, "{}", spread.page_count());
    let bent: Vec<[f32; 3]> = shape
        .positions
        .iter()
        .map(|&[x, y, z]| [x, y, z + 0.2 * x * x])
        .collect();
    for round in 0..2 {
        for view in [oblique_view(), close_view()] {
            let [a, b] = [&whole, &spread].map(|surface| pictures(renderer, surface, &view));
            // Edges between triangles of two pages are drawn twice and look slightly stronger.
            assert!(a[0] == b[0] && a[1] == b[1], "round {round}");
            assert_eq!(ids(renderer, &whole, &view), ids(renderer, &spread, &view));
        }
        whole.update_positions(renderer.gpu(), &bent).unwrap();
        spread.update_positions(renderer.gpu(), &bent).unwrap();
    }
}

#[test]
fn culling_leaves_out_only_invisible_triangles() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let shape = large();
    let surface = shape.upload(renderer);
    assert_eq!(surface.drawn_triangles(&oblique_view()), shape.triangles.len());
    let near = surface.drawn_triangles(&close_view());
    assert!(
        near > 0 && near < shape.triangles.len() / 2,
        "{near} of {}",
        shape.triangles.len()
    );
    // The same picture from parts small enough not to be culled.
    let parts: Vec<Surface> = shape
        .triangles
        .chunks(50_000)
        .map(|triangles| {
            let data = pliant_render::SurfaceData {
                triangles,
                ..shape.data()
            };
            Surface::new(renderer.gpu(), &data).unwrap()
        })
        .collect();
    let parts: Vec<&Surface> = parts.iter().collect();
    for view in [close_view(), oblique_view(), front_view()] {
        let of =
            |renderer: &mut Renderer, surfaces: &[&Surface]| draw(renderer, &view, &Style::default(), surfaces, &[]);
        assert_eq!(of(renderer, &[&surface]), of(renderer, &parts));
    }
}

#[test]
fn the_id_in_a_sorted_mesh_is_the_triangle_under_the_ray() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let shape = large();
    let surface = shape.upload(renderer);
    let view = oblique_view();
    let ids = ids(renderer, &surface, &view);
    let world_from_clip = view.clip_from_world.inverse();
    let mut compared = 0;
    for pixel in (0..ids.len()).step_by(701) {
        let (x, y) = (pixel as u32 % SIZE_PX[0], pixel as u32 / SIZE_PX[0]);
        let at = |depth: f32| {
            let ndc_x = 2.0 * (x as f32 + 0.5) / SIZE_PX[0] as f32 - 1.0;
            let ndc_y = 1.0 - 2.0 * (y as f32 + 0.5) / SIZE_PX[1] as f32;
            let world = world_from_clip * Vec3::new(ndc_x, ndc_y, depth).extend(1.0);
            world.xyz() / world.w
        };
        let (near, far) = (at(0.9), at(0.001));
        match shape.ray(near, (far - near).normalize()) {
            Some((_, margin)) if margin < 0.05 => {}
            Some((triangle, _)) => {
                compared += 1;
                assert_eq!(ids[pixel], Some(triangle), "pixel {x}, {y}");
            }
            None => {}
        }
    }
    assert!(compared > 4, "{compared}");
}

#[test]
fn tiles_join_without_a_seam() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let surface = Shape::open_ring(48, 20).upload(renderer);
    let style = Style {
        wireframe: Wireframe::On,
        borders: Borders::On,
        background: pliant_render::Background::Gradient {
            top: [200, 180, 160],
            bottom: [20, 40, 60],
        },
        ..Style::default()
    };
    let frame = Frame {
        view: &oblique_view(),
        style: &style,
        surfaces: &[&surface],
        grid: None,
        overlays: &[],
    };
    let whole = renderer.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
    let tiled = renderer.draw_tiled(SIZE_PX, Samples::Four, &frame, 64).unwrap();
    let apart = |tolerance: u8| {
        let bytes = whole.rgba.iter().zip(&tiled.rgba);
        bytes.filter(|(a, b)| a.abs_diff(**b) > tolerance).count()
    };
    // Rounding moves single samples along silhouettes, and the background's dither restarts in each tile.
    assert!(apart(2) < whole.rgba.len() / 200, "{} bytes differ", apart(2));
    assert!(apart(60) < 20, "{} bytes differ by far", apart(60));
}

#[test]
fn the_reduced_level_looks_nearly_the_same_and_follows_the_shape() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let shape = Shape::open_ring(1000, 200);
    let mut surface = shape.upload(renderer);
    if !renderer.is_software() {
        #[expect(clippy::print_stderr, reason = "a skipped test says so")]
        return eprintln!("skipped: fewer triangles (the device is none of software)");
    }
    let view = oblique_view();
    assert!(surface.has_reduced(&view) && !large().upload(renderer).has_reduced(&view));
    let reduced = Style {
        detail: Detail::Reduced,
        ..Style::default()
    };
    let bent: Vec<[f32; 3]> = shape
        .positions
        .iter()
        .map(|&[x, y, z]| [x, y + 0.3 * x * x, z])
        .collect();
    for positions in [shape.positions.clone(), bent] {
        surface.update_positions(renderer.gpu(), &positions).unwrap();
        let [full, few] = [Style::default(), reduced].map(|style| draw(renderer, &view, &style, &[&surface], &[]));
        let pixels = full.rgba.chunks_exact(4).zip(few.rgba.chunks_exact(4));
        let (mut differ, mut off) = (0, 0);
        for (a, b) in pixels {
            let apart = a.iter().zip(b).map(|(&a, &b)| a.abs_diff(b)).max().unwrap();
            differ += usize::from(apart > 0);
            off += usize::from(apart > 24);
        }
        assert!(differ > 100, "fewer triangles were drawn: {differ}");
        assert!(off < 300, "{off} of 15000 pixels are off");
    }
    assert!(!surface.has_reduced(&close_view()), "from near their size would show");
    // Hidden triangles stay hidden.
    let half: Vec<bool> = (0..shape.triangles.len()).map(|t| t % 2000 < 1000).collect();
    surface.show(renderer.gpu(), Some(Arc::new(half))).unwrap();
    let [full, few] = [Style::default(), reduced].map(|style| draw(renderer, &view, &style, &[&surface], &[]));
    assert!(full.rgba == few.rgba);
}
