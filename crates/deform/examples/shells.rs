//! Times discrete shells: `shells MESH.off THREADS [OPTION=NUMBER ..]`.
//!
//! The edit is the one beside the mesh, or the one that peers are timed on (see `common`). One JSON object: binding,
//! the first shape, the solve from rest until it converges, and a drag of 60 frames: the median and the longest time
//! from new targets to the first shape for them, and the largest distance from the converged shape at the end of the
//! drag and half a second later, in diagonals. Then the converged shape is an example, only fixed vertices are held,
//! and its weight goes from 0 to 1 in 60 frames: binding, the median and the longest time to the first shape, and its
//! distance from the example at 1. Times in milliseconds.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use common::{edit, forget_peak, median, ms, name, one_handle, peak_mb, read, timed};
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Attachment, Bound, ExampleShape, Examples, Method, OptionValue, Problem, Role};
use pliant_mesh::{Cancel, Model, Progress};

/// A frame of a drag, in milliseconds.
const FRAME_MS: f64 = 16.0;

/// The longest wait for a solve.
const PATIENCE_MS: f64 = 12_000.0;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, threads, options @ ..] = words.as_slice() else {
        panic!("usage: shells MESH.off THREADS [OPTION=NUMBER ..]");
    };
    let options = options.iter().map(|option| {
        let (name, value) = option.split_once('=').unwrap();
        (name, OptionValue::Number(value.parse().unwrap()))
    });
    let method = Method::from_name("shells").unwrap().with(options).unwrap();
    let threads = threads.parse().unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| measure(Path::new(file), threads, &method));
}

fn measure(file: &Path, threads: usize, method: &Method) {
    let model = read(file);
    let (roles, target) = edit(file, &model);
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    forget_peak();
    let problem = one_handle(&model, &roles, &stiffness, method);
    let (bind_ms, mut bound) = timed(|| problem.bind(None, &progress, &cancel).unwrap());
    let mut minimum = vec![DVec3::ZERO; roles.len()];
    bound.set_targets(&[target]).unwrap();
    let start = Instant::now();
    let (mut first_ms, mut energies, mut near_ms) = (0.0, Vec::new(), Vec::new());
    let step = loop {
        let step = bound.step(&mut minimum).unwrap();
        if energies.is_empty() {
            first_ms = ms(start);
        }
        energies.push(step.energy);
        near_ms.push(ms(start));
        if step.finished || ms(start) > PATIENCE_MS {
            break step;
        }
    };
    let solve_ms = ms(start);
    let near = energies
        .iter()
        .position(|energy| *energy <= 1.01 * step.energy)
        .unwrap();
    let diagonal = model.bounds().unwrap().diagonal();
    let away = |displacements: &[DVec3]| {
        let apart = displacements.iter().zip(&minimum).map(|(a, b)| a.distance(*b));
        apart.fold(0.0, f64::max) / diagonal
    };
    let (mut frames, displacements) = drag(&mut bound, target, roles.len());
    let dragged = away(&displacements);
    let rested = away(&rest(&mut bound, displacements));
    let (blend_bind_ms, mut blend_frames, blended) = blend(&model, &roles, &stiffness, method, &minimum);
    let blended = away(&blended);
    println!(
        "{{\"mesh\": \"{}\", \"threads\": {threads}, \"free\": {}, \"bind\": {bind_ms:.0}, \"first\": {first_ms:.0}, \
         \"solve\": {solve_ms:.0}, \"steps\": {}, \"converged\": {}, \"first_energy\": {:.6e}, \"energy\": {:.6e}, \
         \"to_1%\": {:.0}, \"frame_median\": {:.1}, \"frame_max\": {:.1}, \"dragged\": {dragged:.4}, \
         \"rested\": {rested:.4}, \"blend_bind\": {blend_bind_ms:.0}, \"blend_median\": {:.1}, \"blend_max\": {:.1}, \
         \"blended\": {blended:.1e}, \"factor_mb\": {:.0}, \"peak_mb\": {:.0}}}",
        name(file),
        bound.solved_count(),
        step.iteration,
        step.converged,
        energies[0],
        step.energy,
        near_ms[near],
        median(&mut frames.clone()),
        frames.iter_mut().fold(0.0, |a: f64, b| a.max(*b)),
        median(&mut blend_frames.clone()),
        blend_frames.iter_mut().fold(0.0, |a: f64, b| a.max(*b)),
        bound.factor_len() as f64 * 8e-6,
        peak_mb(),
    );
}

/// 60 frames on the way to the target: the time of each, and the last one's shape.
fn drag(bound: &mut Bound, target: DAffine3, count: usize) -> (Vec<f64>, Vec<DVec3>) {
    let mut displacements = vec![DVec3::ZERO; count];
    let rotation = DQuat::from_mat3(&target.matrix3);
    bound.set_targets(&[DAffine3::IDENTITY]).unwrap();
    bound.step(&mut displacements).unwrap();
    let mut frames = Vec::new();
    for frame in 1..=60 {
        let t = f64::from(frame) / 60.0;
        let turned = DAffine3::from_quat(DQuat::IDENTITY.slerp(rotation, t));
        let at = match frame {
            60 => target,
            _ => DAffine3::from_translation(target.translation * t) * turned,
        };
        bound.set_targets(&[at]).unwrap();
        let start = Instant::now();
        bound.step(&mut displacements).unwrap();
        frames.push(ms(start));
        // The rest of the frame is used.
        while frame < 60 && ms(start) < FRAME_MS && !bound.step(&mut displacements).unwrap().finished {}
    }
    (frames, displacements)
}

/// Binding with an example alone, 60 frames of its weight from 0 to 1, and the last one's shape.
fn blend(
    model: &Model,
    roles: &[Role],
    stiffness: &[f64],
    method: &Method,
    example: &[DVec3],
) -> (f64, Vec<f64>, Vec<DVec3>) {
    let roles: Vec<Role> = roles
        .iter()
        .map(|role| if *role == Role::Fixed { Role::Fixed } else { Role::Free })
        .collect();
    let shape = ExampleShape {
        name: "example".to_owned(),
        displacements: Arc::new(example.to_vec()),
    };
    let attachments = [("examples", Attachment::Shapes(Examples::at_rest(vec![shape])))];
    let problem = Problem {
        handle_count: 0,
        attachments: &attachments,
        ..one_handle(model, &roles, stiffness, method)
    };
    let (bind_ms, mut bound) = timed(|| problem.bind(None, &Progress::new(), &Cancel::new()).unwrap());
    let (mut frames, mut displacements) = (Vec::new(), vec![DVec3::ZERO; roles.len()]);
    for frame in 1..=60 {
        bound.set_weights(&[Some(f64::from(frame) / 60.0)]).unwrap();
        let start = Instant::now();
        bound.step(&mut displacements).unwrap();
        frames.push(ms(start));
    }
    (bind_ms, frames, displacements)
}

/// Half a second of steps.
fn rest(bound: &mut Bound, mut displacements: Vec<DVec3>) -> Vec<DVec3> {
    let start = Instant::now();
    while ms(start) < 500.0 && !bound.step(&mut displacements).unwrap().finished {}
    displacements
}
