//! Times a method that takes steps on the edit that peers are timed on: `steps MESH.off THREADS METHOD [ENERGY]`.
//!
//! One JSON object: ordering, binding, and the median step on the way to the target, in milliseconds.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;

use common::{median, name, one_handle, peers_edit, pool, read, timed};
use glam::DVec3;
use pliant_deform::{Arap, ArapEnergy, Method, Problem};
use pliant_mesh::{Cancel, Progress};

/// The number of timed steps after the first, which also starts the solver.
const STEPS: usize = 10;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, threads, method, energy @ ..] = words.as_slice() else {
        panic!("usage: steps MESH.off THREADS METHOD [ENERGY]");
    };
    let mut method = Method::from_name(method).unwrap();
    if let (Some(mut options), [energy]) = (method.options::<Arap>().cloned(), energy) {
        options.energy = *ArapEnergy::ALL.iter().find(|known| known.name() == energy).unwrap();
        method = options.into();
    }
    let threads = threads.parse().unwrap();
    let pool = pool(threads);
    pool.install(|| measure(Path::new(file), threads, &method));
}

fn measure(file: &Path, threads: usize, method: &Method) {
    let model = read(file);
    let (roles, target) = peers_edit(&model);
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let (order_ms, ordering) = timed(|| method.ordering(&model.topology, &progress, &cancel).unwrap());
    let stiffness = vec![1.0; roles.len()];
    let problem = one_handle(&model, &roles, &stiffness, method);
    let (bind_ms, mut bound) = timed(|| problem.bind(ordering.as_ref(), &progress, &cancel).unwrap());
    // Peers' steps are at full resolution: a leading coarse level would take other steps.
    if let Some(mut options) = method.options::<Arap>().cloned() {
        options.coarse_above = usize::MAX;
        bound = Problem {
            method: &options.into(),
            ..problem
        }
        .bind(ordering.as_ref(), &progress, &cancel)
        .unwrap();
    }
    bound.set_targets(&[target]).unwrap();
    let mut displacements = vec![DVec3::ZERO; roles.len()];
    let mut steps = Vec::new();
    loop {
        let (step_ms, step) = timed(|| bound.step(&mut displacements).unwrap());
        steps.push(step_ms);
        if step.finished || steps.len() > STEPS {
            break;
        }
    }
    println!(
        "{{\"mesh\": \"{}\", \"method\": \"{}\", \"threads\": {threads}, \"free\": {}, \"order\": {order_ms:.1}, \
         \"bind\": {bind_ms:.1}, \"step\": {:.2}}}",
        name(file),
        method.name(),
        bound.solved_count(),
        median(&mut steps[1..]),
    );
}
