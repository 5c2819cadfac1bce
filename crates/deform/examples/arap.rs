//! Times as-rigid-as-possible deformation: `arap MESH.off THREADS ENERGY [REACH.off]`.
//!
//! The edit is beside the mesh as MESH.sel (a line per vertex: 0 fixed, 1 free, 2 handle) and MESH.def (the handle's
//! matrix, row by row); without them it is the one that peers are timed on: the lowest 5% along the longest axis are
//! fixed, the highest 5% turned by 60° and moved. One JSON object; times in milliseconds. With REACH.off, another
//! program's result for the same edit, it also gives the time until the energy was below that shape's.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;
use std::time::Instant;

use common::{edit, median, ms, name, one_handle, pool, read, timed};
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Arap, ArapEnergy, Bound, Method, Step};
use pliant_mesh::{Cancel, Model, Progress};

/// A frame of a drag, in milliseconds.
const FRAME_MS: f64 = 16.0;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, threads, energy, reach @ ..] = words.as_slice() else {
        panic!("usage: arap MESH.off THREADS ENERGY [REACH.off]");
    };
    let threads = threads.parse().unwrap();
    let energy = *ArapEnergy::ALL.iter().find(|known| known.name() == energy).unwrap();
    let pool = pool(threads);
    pool.install(|| measure(Path::new(file), threads, energy, reach.first()));
}

fn options(energy: ArapEnergy, tolerance: f64) -> Arap {
    let mut options = Arap::default();
    options.energy = energy;
    options.tolerance = tolerance;
    options.max_iterations = 5000;
    options
}

fn measure(file: &Path, threads: usize, energy: ArapEnergy, reach: Option<&String>) {
    let model = read(file);
    let (roles, target) = edit(file, &model);
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let exact = Method::from(options(energy, 1e-10));
    let (order_ms, ordering) = timed(|| exact.ordering(&model.topology, &progress, &cancel).unwrap());
    let bind = |method: &Method| {
        let problem = one_handle(&model, &roles, &stiffness, method);
        problem.bind(ordering.as_ref(), &progress, &cancel).unwrap()
    };
    let (bind_ms, mut bound) = timed(|| bind(&Method::from(options(energy, Arap::default().tolerance))));
    let mut displacements = vec![DVec3::ZERO; roles.len()];
    let mut exactly = bind(&exact);

    // The usual solve, and then on to the minimum.
    let (solve_ms, iterations, solved_energy) = solve(&mut bound, target, &mut displacements);
    let mut minimum = displacements.clone();
    let (_, _, least_energy) = solve(&mut exactly, target, &mut minimum);

    let reached_energy = reach.map_or(0.0, |reach| {
        let mut shape = vec![DVec3::ZERO; roles.len()];
        let moved = read(Path::new(reach)).rest_positions();
        for (vertex, place) in model.drawn.surface_vertices().enumerate() {
            if let Some(place) = place {
                shape[place.index()] = moved[vertex] - model.surface.positions[place.index()];
            }
        }
        bound.energy_of(&shape).unwrap()
    });
    let (mut reach_ms, mut reach_iterations) = (f64::NAN, 0);
    let steps = steps(&mut exactly, target, |spent_ms, step| {
        if reach_ms.is_nan() && step.energy <= reached_energy {
            reach_ms = spent_ms;
            reach_iterations = step.iteration;
        }
    });
    let first_ms = steps[0];
    // An iteration is a local and a global step at full resolution: a leading coarse level would take other steps.
    let mut alone = options(energy, 1e-10);
    alone.coarse_above = usize::MAX;
    let mut iterations_ms = self::steps(&mut bind(&Method::from(alone)), target, |_, _| {});
    let iteration_ms = median(&mut iterations_ms[1..]);

    let drag = drag(&mut bound, &model, target, &minimum);
    let reached = match reach {
        Some(_) => format!(
            ", \"reach\": {reach_ms:.2}, \"reach_iterations\": {reach_iterations}, \"reach_energy\": {reached_energy:.9}"
        ),
        None => String::new(),
    };
    println!(
        "{{\"mesh\": \"{}\", \"energy\": \"{}\", \"threads\": {threads}, \"free\": {}, \"order\": {order_ms:.2}, \
         \"bind\": {bind_ms:.2}, \"iteration\": {iteration_ms:.3}, \"first\": {first_ms:.3}, \"solve\": {solve_ms:.2}, \
         \"iterations\": {iterations}, \"solved_energy\": {solved_energy:.9}, \"least_energy\": {least_energy:.9}, \
         \"frame_median\": {:.2}, \"frame_max\": {:.2}, \"rested\": {:.6}{reached}}}",
        name(file),
        energy.name(),
        bound.solved_count(),
        drag.frame_median_ms,
        drag.frame_max_ms,
        drag.rested,
    );
}

/// At most 400 steps from rest, each with its time and the time since rest, in milliseconds.
fn steps(bound: &mut Bound, target: DAffine3, mut look: impl FnMut(f64, Step)) -> Vec<f64> {
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    bound.set_targets(&[DAffine3::IDENTITY]).unwrap();
    bound.step(&mut displacements).unwrap();
    bound.set_targets(&[target]).unwrap();
    let mut steps = Vec::new();
    let start = Instant::now();
    loop {
        let (step_ms, step) = timed(|| bound.step(&mut displacements).unwrap());
        steps.push(step_ms);
        look(ms(start), step);
        if step.finished || steps.len() >= 400 {
            return steps;
        }
    }
}

/// Solves to the end: milliseconds, iterations, energy.
fn solve(bound: &mut Bound, target: DAffine3, displacements: &mut [DVec3]) -> (f64, u32, f64) {
    bound.set_targets(&[target]).unwrap();
    let start = Instant::now();
    loop {
        let step = bound.step(displacements).unwrap();
        if step.finished {
            return (ms(start), step.iteration, step.energy);
        }
    }
}

/// The measurements of a drag of 60 frames.
struct Drag {
    /// The time from a new target to the first shape for it.
    frame_median_ms: f64,
    frame_max_ms: f64,
    /// The largest distance from the minimum half a second after the last target, in diagonals.
    rested: f64,
}

fn drag(bound: &mut Bound, model: &Model, target: DAffine3, minimum: &[DVec3]) -> Drag {
    let mut displacements = vec![DVec3::ZERO; minimum.len()];
    let rotation = DQuat::from_mat3(&target.matrix3);
    bound.set_targets(&[DAffine3::IDENTITY]).unwrap();
    bound.step(&mut displacements).unwrap();
    let mut frames = Vec::new();
    for frame in 1..=60 {
        let t = f64::from(frame) / 60.0;
        let turned = DAffine3::from_quat(DQuat::IDENTITY.slerp(rotation, t));
        let shift = target.translation * t;
        let at = if frame == 60 {
            target
        } else {
            DAffine3::from_translation(shift) * turned
        };
        bound.set_targets(&[at]).unwrap();
        let start = Instant::now();
        bound.step(&mut displacements).unwrap();
        frames.push(ms(start));
        // The rest of the frame is used.
        let length = if frame == 60 { 500.0 } else { FRAME_MS };
        while ms(start) < length && !bound.step(&mut displacements).unwrap().finished {}
    }
    let apart = displacements.iter().zip(minimum).map(|(a, b)| a.distance(*b));
    let diagonal = model.bounds().unwrap().diagonal();
    Drag {
        rested: apart.fold(0.0, f64::max) / diagonal,
        frame_max_ms: frames.iter().copied().fold(0.0, f64::max),
        frame_median_ms: median(&mut frames),
    }
}
