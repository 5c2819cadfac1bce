//! `view_times TRIANGLES [TRIANGLES ..]`: how long the view takes at each size, a JSON object a line: getting ready, a
//! moved shape, a frame on the processor's side and on the device's, and an answer to the pointer.

#![expect(clippy::print_stdout, reason = "its output is the measurement")]

use std::f64::consts::TAU;
use std::time::Instant;

use glam::{DVec2, DVec3};
use pliant_app::drawing::{self, Drawing};
use pliant_editor::{Camera, Look, Shading};
use pliant_io::Appearance;
use pliant_mesh::{Bvh, Cancel, Drawn, DrawnVertex, Model, Progress, WeldOptions};
use pliant_render::{Frame, Headless, Samples, Surface, Target};

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
        knobbly_ring(triangles),
        &WeldOptions::default(),
        &Progress::default(),
        &Cancel::default(),
    )?;
    let (drawing_ms, drawing) = timed(|| Drawing::new(&model, Appearance::default()));
    let rest = vec![DVec3::ZERO; model.surface.positions.len()];
    let bent: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .map(|p| DVec3::Z * 0.2 * p.x * p.x)
        .collect();
    let pose = drawing.pose(&model, &rest);
    let mut renderer = Headless::new()?.renderer;
    let (upload_ms, surface) = timed(|| drawing.upload(&renderer, &pose));
    let mut surface = surface?;
    let (pose_ms, pose) = timed(|| drawing.pose(&model, &bent));
    let moves = (0..FRAMES).map(|_| {
        let (ms, moved) = timed(|| surface.update_shape(&renderer, &pose.data()));
        moved?;
        renderer.queue().submit([]);
        renderer.finish()?;
        Ok(ms)
    });
    let move_ms = median(moves.collect::<Result<Vec<f64>, pliant_render::RenderError>>()?);

    let (build_ms, mut bvh) = timed(|| Bvh::build(&model.surface.positions, &model.surface.triangles));
    let moved: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .zip(&bent)
        .map(|(&p, &d)| p + d)
        .collect();
    let (refit_ms, ()) = timed(|| bvh.refit(&moved));
    let size_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]));
    let mut camera = Camera::default();
    camera.frame(&moved, size_px);
    let mut picks: Vec<f64> = (0..2000_u32)
        .map(|n| {
            let at = DVec2::new(f64::from(n * 7919 % 1280), f64::from(n * 104_729 % 800));
            let ray = camera.ray(at, size_px);
            timed(|| bvh.ray(ray.origin, ray.direction)).0
        })
        .collect();
    picks.sort_by(f64::total_cmp);

    let mut near = camera;
    near.distance *= 0.12;
    near.target += DVec3::X * 0.9;
    let clay = Look {
        grid: false,
        ..Look::default()
    };
    let looks = [
        ("clay", clay, camera),
        ("clay, near", clay, near),
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
            let mut target = Target::new();
            target.resize(&renderer, SIZE_PX, samples)?;
            let view = drawing::view(&camera, size_px, drawing.centre);
            let (processor_ms, device_ms) = frames(&mut renderer, &target, &view, &look, &surface)?;
            println!(
                "{{\"triangles\": {triangles}, \"device\": \"{device}\", \"look\": \"{name}\", \"samples\": {count}, \
                 \"processor_ms\": {processor_ms:.3}, \"device_ms\": {device_ms:.2}, \"drawn\": {}}}",
                surface.drawn_triangles(&view)
            );
        }
    }
    println!(
        "{{\"triangles\": {triangles}, \"ready_ms\": {drawing_ms:.1}, \"upload_ms\": {upload_ms:.1}, \
         \"pose_ms\": {pose_ms:.1}, \"move_ms\": {move_ms:.2}, \"bvh_ms\": {build_ms:.0}, \"refit_ms\": {refit_ms:.1}, \
         \"pick_median_ms\": {:.4}, \"pick_worst_ms\": {:.4}, \"gpu_mb\": {:.0}}}",
        picks[picks.len() / 2],
        picks[picks.len() - 1],
        surface.gpu_bytes() as f64 * 1e-6
    );
    Ok(())
}

/// Medians of the call that draws and of the device's own time.
fn frames(
    renderer: &mut pliant_render::Renderer,
    target: &Target,
    view: &pliant_render::View,
    look: &Look,
    surface: &Surface,
) -> Result<(f64, f64), pliant_render::RenderError> {
    let style = drawing::style(look);
    let (mut processor, mut device) = (Vec::new(), Vec::new());
    for number in 0..=FRAMES {
        let frame = Frame {
            view,
            style: &style,
            surfaces: &[surface],
            grid: None,
            overlays: &[],
        };
        let (ms, drawn) = timed(|| renderer.draw(target, &frame));
        drawn?;
        renderer.finish()?;
        // The first one makes pipelines.
        if number > 0 {
            processor.push(ms);
            device.extend(renderer.device_ms());
        }
    }
    Ok((median(processor), median(device)))
}

/// A ring with knobs, of about so many triangles.
fn knobbly_ring(triangles: usize) -> Drawn {
    let across = ((triangles as f64 / 5.0).sqrt() as u32).max(3);
    let around = (triangles as u32 / (2 * across)).max(3);
    let mut positions = Vec::new();
    for i in 0..around {
        let turn = TAU * f64::from(i) / f64::from(around);
        let outward = DVec3::new(turn.cos(), turn.sin(), 0.0);
        for k in 0..across {
            let lap = TAU * f64::from(k) / f64::from(across);
            let normal = outward * lap.cos() + DVec3::Z * lap.sin();
            let knobs =
                0.03 * (9.0 * turn).sin() * (5.0 * lap).cos() + 0.004 * (70.0 * turn).cos() * (40.0 * lap).cos();
            positions.push(outward * 0.85 + normal * (0.35 + knobs));
        }
    }
    let v = |i: u32, k: u32| DrawnVertex((i % around) * across + k % across);
    let quads = (0..around).flat_map(|i| (0..across).map(move |k| (i, k)));
    let triangles = quads.flat_map(|(i, k)| {
        [
            [v(i, k), v(i + 1, k), v(i + 1, k + 1)],
            [v(i, k), v(i + 1, k + 1), v(i, k + 1)],
        ]
    });
    Drawn::once(positions, triangles.collect())
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
