//! Times coupled prisms on a scene of the survey: `primo SCENE THREADS [THICKNESS]`, where SCENE.off, SCENE.sel and
//! SCENE.def are its mesh, its roles and its handle's matrix.
//!
//! One JSON object a line: binding; how many steps and how long until the energy is within 1% of the best known minimum,
//! and until the method says it converged; the longest step; milliseconds. The best known minimum is the lower of two
//! solves to a tolerance of 1e-9, one at once and one as a drag of 20 frames.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

use std::time::Instant;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{Bound, Holds, Loose, Method, Ordering, Primo, Problem, Role};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, WeldOptions};

fn main() {
    let mut words = std::env::args().skip(1);
    let usage = "usage: primo SCENE THREADS [THICKNESS]";
    let scene = words.next().unwrap_or_else(|| panic!("{usage}"));
    let threads = words.next().and_then(|word| word.parse().ok()).unwrap_or(1);
    let thickness = words
        .next()
        .map_or(Primo::default().thickness, |word| word.parse().unwrap());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| measure(&scene, threads, thickness));
}

fn measure(scene: &str, threads: usize, thickness: f64) {
    let (model, roles, target) = read(scene);
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let bind = |tolerance: f64| {
        let mut options = Primo::default();
        options.tolerance = tolerance;
        options.thickness = thickness;
        options.max_iterations = 2000;
        let method = Method::Primo(options);
        let ordering = Ordering::of(&model.topology, method.operator_power(), &progress, &cancel).unwrap();
        let problem = Problem {
            surface: &model.surface,
            topology: &model.topology,
            roles: &roles,
            handle_count: 1,
            stiffness: &stiffness,
            holds: Holds::default(),
            loose: Loose::Rest,
            method: &method,
            revision: 0,
        };
        let start = Instant::now();
        (problem.bind(&ordering, &progress, &cancel).unwrap(), ms(start))
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
    let name = std::path::Path::new(scene)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
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

fn ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
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

/// A part of the way to a rigid motion.
fn part_of(target: &DAffine3, share: f64) -> DAffine3 {
    let rotation = DQuat::IDENTITY.slerp(DQuat::from_mat3(&target.matrix3), share);
    DAffine3::from_rotation_translation(rotation, target.translation * share)
}

fn read(scene: &str) -> (Model, Vec<Role>, DAffine3) {
    let numbers = |extension: &str, skip: usize| -> Vec<f64> {
        let text = std::fs::read_to_string(format!("{scene}.{extension}")).unwrap();
        text.lines()
            .filter(|line| !line.starts_with('#'))
            .skip(skip)
            .flat_map(str::split_whitespace)
            .map(|word| word.parse().unwrap())
            .collect()
    };
    let off = numbers("off", 1);
    let (vertices, faces) = (off[0] as usize, off[1] as usize);
    let positions: Vec<DVec3> = off[3..3 + 3 * vertices].chunks(3).map(DVec3::from_slice).collect();
    let triangles = off[3 + 3 * vertices..][..4 * faces]
        .chunks(4)
        .map(|f| {
            [
                DrawnVertex(f[1] as u32),
                DrawnVertex(f[2] as u32),
                DrawnVertex(f[3] as u32),
            ]
        })
        .collect();
    let drawn = Drawn::once(positions, triangles);
    let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
    let selected = numbers("sel", 0);
    let mut roles = vec![Role::Free; model.surface.positions.len()];
    for (k, &s) in selected.iter().enumerate() {
        let Some(v) = model.surface_of_drawn[k] else { continue };
        roles[v.index()] = match s as i32 {
            0 => Role::Fixed,
            1 => Role::Free,
            _ => Role::Handle(0),
        };
    }
    let m = numbers("def", 0);
    let target = DAffine3::from_mat3_translation(
        DMat3::from_cols(
            DVec3::new(m[0], m[4], m[8]),
            DVec3::new(m[1], m[5], m[9]),
            DVec3::new(m[2], m[6], m[10]),
        ),
        DVec3::new(m[3], m[7], m[11]),
    );
    (model, roles, target)
}
