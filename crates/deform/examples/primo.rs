//! Times coupled prisms on a scene of the survey: `primo SCENE THREADS [THICKNESS]`, where SCENE.off, SCENE.sel and
//! SCENE.def are its mesh, its roles and its handle's matrix.
//!
//! One JSON object a line: binding; the number of steps and the time until the energy is within 1% of the best known
//! minimum, and until the method says it converged; the longest step; milliseconds. The best known minimum is the lower
//! of two solves to a tolerance of 1e-9, one at once and one as a drag of 20 frames.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;
use std::time::Instant;

use common::{edit, ms, name, one_handle, pool, read};
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Bound, Method, Primo};
use pliant_mesh::{Cancel, Progress};

fn main() {
    let mut words = std::env::args().skip(1);
    let usage = "usage: primo SCENE THREADS [THICKNESS]";
    let scene = words.next().unwrap_or_else(|| panic!("{usage}"));
    let threads = words.next().and_then(|word| word.parse().ok()).unwrap_or(1);
    let thickness = words
        .next()
        .map_or(Primo::default().thickness, |word| word.parse().unwrap());
    let pool = pool(threads);
    pool.install(|| measure(Path::new(&scene), threads, thickness));
}

fn measure(scene: &Path, threads: usize, thickness: f64) {
    let model = read(&scene.with_extension("off"));
    let (roles, target) = edit(scene, &model);
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let bind = |tolerance: f64| {
        let mut options = Primo::default();
        options.tolerance = tolerance;
        options.thickness = thickness;
        options.max_iterations = 2000;
        let method = Method::from(options);
        let problem = one_handle(&model, &roles, &stiffness, &method);
        let start = Instant::now();
        (problem.bind(None, &progress, &cancel).unwrap(), ms(start))
    };
    let energy = |(_, energy): &(f64, f64)| *energy;
    let at_once = solve(&mut bind(1e-9).0, target).last().map_or(f64::NAN, energy);
    let (mut dragged, _) = bind(1e-9);
    let mut least = f64::NAN;
    for frame in 1..=20 {
        least = solve(&mut dragged, part_of(&target, f64::from(frame) / 20.0))
            .last()
            .map_or(f64::NAN, energy);
    }
    let least = least.min(at_once);
    let (mut bound, bind_ms) = bind(Primo::default().tolerance);
    let steps = solve(&mut bound, target);
    let near = steps
        .iter()
        .position(|(_, energy)| *energy <= 1.01 * least)
        .unwrap_or(steps.len() - 1);
    let times = steps.iter().map(|(ms, _)| *ms);
    let longest_ms = std::iter::once(0.0)
        .chain(times.clone())
        .zip(times)
        .map(|(a, b)| b - a)
        .fold(0.0, f64::max);
    let (all_ms, last) = steps[steps.len() - 1];
    let name = name(scene);
    println!(
        "{{\"scene\": \"{name}\", \"faces\": {}, \"threads\": {threads}, \"thickness\": {thickness}, \"bind\": {bind_ms:.0}, \
         \"steps_to_1%\": {}, \"ms_to_1%\": {:.0}, \"steps\": {}, \"ms\": {all_ms:.0}, \"longest_step\": {longest_ms:.0}, \
         \"energy\": {last:.6e}, \"least\": {least:.6e}, \"factor_mb\": {:.0}}}",
        model.surface.triangles.len(),
        near + 1,
        steps[near].0,
        steps.len(),
        bound.factor_len() as f64 * 8e-6,
    );
}

/// Steps until finished: when each was done, and its energy.
fn solve(bound: &mut Bound, target: DAffine3) -> Vec<(f64, f64)> {
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    bound.set_targets(&[target]).unwrap();
    let start = Instant::now();
    let mut steps = Vec::new();
    loop {
        let step = bound.step(&mut displacements).unwrap();
        steps.push((ms(start), step.energy));
        if step.finished {
            return steps;
        }
    }
}

/// A share of a rigid motion.
fn part_of(target: &DAffine3, share: f64) -> DAffine3 {
    let rotation = DQuat::IDENTITY.slerp(DQuat::from_mat3(&target.matrix3), share);
    DAffine3::from_rotation_translation(rotation, target.translation * share)
}
