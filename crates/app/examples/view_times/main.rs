//! `view_times TRIANGLES [TRIANGLES ..]`: times of the view at each size, one JSON object per line: preparation, a
//! shape update, CPU and GPU time of a frame, picks, and dabs of the brush.

#![expect(clippy::print_stdout, reason = "its output is the measurement")]

mod brush;
mod picks;
mod ring;

use std::sync::Arc;
use std::time::Instant;

use glam::{DVec2, DVec3};
use pliant_editor::{Camera, Look, Shading};
use pliant_io::Appearance;
use pliant_mesh::{Cancel, Model, Progress, WeldOptions};
use pliant_picture::drawing::{self, Drawing};
use pliant_render::{Detail, Frame, Headless, Samples, Style, Surface, Target};

const SIZE_PX: [u32; 2] = [1280, 800];
const FRAMES: usize = 9;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for argument in std::env::args().skip(1) {
        measure(argument.parse()?)?;
    }
    Ok(())
}

fn measure(triangles: usize) -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::weld(
        ring::knobbly_ring(triangles),
        &WeldOptions::default(),
        &Progress::default(),
        &Cancel::default(),
    )?;
    let model = Arc::new(model);
    let (drawing_ms, drawing) = timed(|| Drawing::new(&model, Appearance::default(), Arc::default()));
    let rest = vec![DVec3::ZERO; model.surface.positions.len()];
    let bent: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .map(|p| DVec3::Z * 0.2 * p.x * p.x)
        .collect();
    let mut pose = drawing.pose(&model, &rest);
    let mut renderer = Headless::new()?.renderer;
    let (upload_ms, surface) = timed(|| drawing.upload(&renderer, &pose));
    let mut surface = surface?;
    let poses = (0..FRAMES).map(|_| {
        let (ms, posed) = timed(|| drawing.pose(&model, &bent));
        drawing.put_back(std::mem::replace(&mut pose, posed));
        ms
    });
    let pose_ms = median(poses.collect());
    let moves = (0..FRAMES).map(|_| {
        let (ms, moved) = timed(|| surface.update_shape(renderer.gpu(), &pose.data()));
        moved?;
        renderer.queue().submit([]);
        renderer.finish()?;
        Ok(ms)
    });
    let move_ms = median(moves.collect::<Result<Vec<f64>, pliant_render::RenderError>>()?);

    println!(
        "{{\"triangles\": {triangles}, \"ready_ms\": {drawing_ms:.1}, \"upload_ms\": {upload_ms:.1}, \
         \"pose_ms\": {pose_ms:.2}, \"move_ms\": {move_ms:.2}, \"gpu_mb\": {:.0}}}",
        surface.gpu_bytes() as f64 * 1e-6
    );
    let size_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]));
    let moved: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .zip(&bent)
        .map(|(&p, &d)| p + d)
        .collect();
    let mut camera = Camera::default();
    camera.frame(&moved, size_px);
    println!(
        "{{\"triangles\": {triangles}, {}}}",
        picks::row(&model, &moved, &camera)
    );
    for row in brush::rows(&model, &drawing, &renderer, &mut surface)? {
        println!("{{\"triangles\": {triangles}, {row}}}");
    }
    surface.update_shape(renderer.gpu(), &pose.data())?;
    let view = |camera: &Camera| drawing::view(camera, size_px, drawing.centre());
    let ground = drawing::ground(&camera, size_px, rest_height(&model), drawing.centre());
    let made = (0..FRAMES).map(|_| {
        let (ms, made) = timed(|| {
            renderer.update_shadow(&mut surface, &ground)?;
            renderer.finish()
        });
        made.map(|()| ms)
    });
    let shadow_ms = median(made.collect::<Result<Vec<f64>, pliant_render::RenderError>>()?);
    println!("{{\"triangles\": {triangles}, \"shadow_ms\": {shadow_ms:.1}}}");
    measure_looks(&mut renderer, &surface, triangles, camera, view)
}

/// The height of the ground under the model.
fn rest_height(model: &Model) -> f64 {
    model.bounds().map_or(0.0, |bounds| bounds.min.y)
}

/// Measures frames in several looks, with one and four samples per pixel.
fn measure_looks(
    renderer: &mut pliant_render::Renderer,
    surface: &Surface,
    triangles: usize,
    camera: Camera,
    view: impl Fn(&Camera) -> pliant_render::View,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut near = camera;
    near.distance *= 0.12;
    near.target += DVec3::X * 0.9;
    let clay = Look {
        grid: false,
        shadow: false,
        ..Look::default()
    };
    let looks = [
        ("clay", clay, camera),
        ("clay, near", clay, near),
        ("clay, moving", clay, camera),
        ("clay, shadow", Look { shadow: true, ..clay }, camera),
        (
            "material",
            Look {
                shading: Shading::Material,
                ..clay
            },
            camera,
        ),
        (
            "zebra",
            Look {
                shading: Shading::Zebra,
                ..clay
            },
            camera,
        ),
        (
            "clay, edges",
            Look {
                wireframe: true,
                ..clay
            },
            camera,
        ),
    ];
    let device = renderer.device_name();
    for (name, look, camera) in looks {
        for (samples, count) in [(Samples::One, 1), (Samples::Four, 4)] {
            // These take minutes on a software device and show nothing beyond the smaller meshes.
            if triangles > 1_000_000 && !name.starts_with("clay,") && name != "clay" && count > 1 {
                continue;
            }
            let mut target = Target::new();
            target.resize(renderer.device(), SIZE_PX, samples)?;
            let view = view(&camera);
            let style = Style {
                detail: if name == "clay, moving" {
                    Detail::Reduced
                } else {
                    Detail::Full
                },
                ..drawing::style(&look, 1.0)
            };
            let (processor_ms, device_ms) = frames(renderer, &target, &view, &style, surface)?;
            println!(
                "{{\"triangles\": {triangles}, \"device\": \"{device}\", \"look\": \"{name}\", \"samples\": {count}, \
                 \"processor_ms\": {processor_ms:.3}, \"device_ms\": {device_ms:.2}, \"drawn\": {}}}",
                surface.drawn_triangles(&view)
            );
        }
    }
    Ok(())
}

/// Median CPU time of the draw call and median GPU time, in milliseconds.
fn frames(
    renderer: &mut pliant_render::Renderer,
    target: &Target,
    view: &pliant_render::View,
    style: &Style,
    surface: &Surface,
) -> Result<(f64, f64), pliant_render::RenderError> {
    let (mut processor, mut device) = (Vec::new(), Vec::new());
    let start = Instant::now();
    for number in 0..=FRAMES {
        let frame = Frame {
            view,
            style,
            surfaces: &[surface],
            grid: None,
            overlays: &[],
        };
        let (ms, drawn) = timed(|| renderer.draw(target, &frame));
        drawn?;
        renderer.finish()?;
        // The first frame creates pipelines.
        if number > 0 {
            processor.push(ms);
            device.extend(renderer.device_ms());
        }
        // Stop after two seconds: software devices are slow with millions of triangles.
        if number >= 1 && start.elapsed().as_secs() >= 2 {
            break;
        }
    }
    Ok((median(processor), median(device)))
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64() * 1e3, result)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
