//! Laws of weak devices: their gaps (compute, large buffers, timers, numbered triangles) change no picture.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use pliant_render::{
    Borders, EdgePoint, Frame, IdTarget, Image, Overlay, OverlayLine, PixelRect, RenderError, Renderer, Samples,
    Shading, Style, Surface, SurfaceLine, Wireframe,
};
use rig::{SIZE_PX, Shape, draw, oblique_view, renderer};

/// The limit of the weak device's buffers. Real ones end at 128 MB; with this limit, a mesh that a test draws quickly
/// needs several.
const LARGEST_BUFFER: u64 = 1 << 20;

/// The lowest limits that WebGPU's downlevel devices offer, and lower ones.
fn weak_limits(adapter: &wgpu::Adapter) -> wgpu::Limits {
    let least = wgpu::Limits {
        max_compute_workgroup_storage_size: 0,
        max_compute_invocations_per_workgroup: 0,
        max_compute_workgroup_size_x: 0,
        max_compute_workgroup_size_y: 0,
        max_compute_workgroup_size_z: 0,
        max_compute_workgroups_per_dimension: 0,
        max_buffer_size: LARGEST_BUFFER,
        max_storage_buffer_binding_size: LARGEST_BUFFER,
        max_sampled_textures_per_shader_stage: 8,
        max_samplers_per_shader_stage: 8,
        ..wgpu::Limits::downlevel_defaults()
    };
    least.using_alignment(adapter.limits())
}

/// A renderer on the device that tests share, opened with no feature and the lowest limits.
fn weak() -> Renderer {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).unwrap();
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: weak_limits(&adapter),
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
    Renderer::new(&device, &queue).unwrap()
}

/// 150,000 triangles: more than one of the weak device's buffers holds.
fn shape() -> Shape {
    Shape::open_ring(600, 143)
}

/// Every shading, with lines on the surface and marks over it.
fn pictures(renderer: &mut Renderer, surface: &mut Surface) -> Vec<Image> {
    let seam = SurfaceLine {
        ends: [EdgePoint::at(0), EdgePoint::at(143)],
        colour: [255, 0, 0, 255],
        width_points: 3.0,
    };
    surface.update_lines(renderer.gpu(), &[seam]).unwrap();
    let mark = OverlayLine {
        ends: [[-1.0, -1.0, 0.0], [1.0, 1.0, 0.5]],
        colours: [[0, 200, 0, 255]; 2],
        width_px: 4.0,
    };
    let overlay = Overlay {
        lines: vec![mark],
        ..Overlay::default()
    };
    let style = |shading| Style {
        shading,
        ..Style::default()
    };
    let wired = Style {
        wireframe: Wireframe::On,
        borders: Borders::On,
        ..Style::default()
    };
    let styles = [
        style(Shading::Material),
        style(Shading::Zebra),
        style(Shading::Normals),
        Style::default(),
        wired,
    ];
    let view = oblique_view();
    styles
        .iter()
        .map(|style| draw(renderer, &view, style, &[surface], std::slice::from_ref(&overlay)))
        .collect()
}

#[test]
fn a_weak_device_draws_the_same_pictures() {
    let Some(mut headless) = renderer() else { return };
    let mut weak = weak();
    let shape = shape();
    let mut whole = shape.upload(&headless.renderer);
    let mut spread = shape.upload(&weak);
    assert_eq!(whole.page_count(), 1);
    assert!(spread.page_count() > 1, "the mesh takes several of its buffers");
    let of_strong = pictures(&mut headless.renderer, &mut whole);
    let of_weak = pictures(&mut weak, &mut spread);
    let (wired_strong, plain_strong) = of_strong.split_last().unwrap();
    let (wired_weak, plain_weak) = of_weak.split_last().unwrap();
    assert!(plain_strong == plain_weak);
    // Edges between triangles of two pages are drawn twice and look slightly stronger.
    let pixels = wired_strong.rgba.iter().zip(&wired_weak.rgba);
    let apart = pixels.filter(|(a, b)| a.abs_diff(**b) > 40).count();
    assert!(
        apart < wired_strong.rgba.len() / 100,
        "{apart} bytes of the wireframe differ"
    );
}

#[test]
fn a_weak_device_says_that_it_cannot_number_triangles() {
    if renderer().is_none() {
        return;
    }
    let mut weak = weak();
    let surface = shape().upload(&weak);
    let (view, style) = (oblique_view(), Style::default());
    let frame = Frame {
        view: &view,
        style: &style,
        surfaces: &[&surface],
        grid: None,
        overlays: &[],
    };
    let refused = weak.pick(&mut IdTarget::new(), SIZE_PX, PixelRect::whole(SIZE_PX), &frame);
    assert!(matches!(refused, Err(RenderError::NoTriangleNumbers)));
    assert_eq!(weak.device_ms(), None, "it has no timer");
    // Its other functions still work.
    weak.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
}
