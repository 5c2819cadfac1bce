//! Times a flow: `flow_steps VERTICES THREADS [STEPS]`.
//!
//! Dye swirls on a bumpy torus. One JSON object: binding and the median step in milliseconds, the memory that the flow
//! takes beside the mesh, that of the Laplacian's factor in it, and that of the mesh, in megabytes (0 where the system
//! does not tell), and the divergence at the end relative to the velocity over the mean edge.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

use std::time::Instant;

use glam::DVec3;
use pliant_deform::Budget;
use pliant_flow::{Flow, FlowSettings};
use pliant_mesh::{Cancel, Progress, shapes};

fn main() {
    let words: Vec<usize> = std::env::args().skip(1).map(|word| word.parse().unwrap()).collect();
    let [vertices, threads, steps @ ..] = words.as_slice() else {
        panic!("usage: flow_steps VERTICES THREADS [STEPS]");
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(*threads).build().unwrap();
    pool.install(|| measure(*vertices, *threads, steps.first().copied().unwrap_or(30)));
}

fn measure(vertices: usize, threads: usize, steps: usize) {
    let before = resident_mb();
    let around = (vertices as f64 / 2.0).sqrt() as usize;
    let mut drawn = shapes::torus(2 * around, around);
    for p in &mut drawn.positions {
        *p *= 1.0 + 0.05 * (9.0 * p.x).sin() * (7.0 * p.y).sin() * (8.0 * p.z).sin();
    }
    let model = shapes::model(drawn);
    let mesh_mb = resident_mb() - before;
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let start = Instant::now();
    let bound = Flow::bind(&model.surface, &model.topology, Budget::default(), &progress, &cancel);
    let mut flow = bound.unwrap();
    let bind_ms = ms_since(start);
    let positions = &model.surface.positions;
    let dyed: Vec<f64> = positions.iter().map(|p| f64::from(u8::from(p.x * p.y > 0.0))).collect();
    flow.pour(&dyed, [1.0, 0.5, 0.1]);
    let swirl = |p: DVec3| DVec3::Z.cross(p) + 0.5 * DVec3::new((5.0 * p.z).sin(), 0.0, (4.0 * p.y).cos());
    flow.add_velocity(&vec![1.0; positions.len()], swirl);
    let settings = FlowSettings {
        gravity: DVec3::new(0.0, -1.0, 0.0),
        ..FlowSettings::default()
    };
    let mut times: Vec<f64> = (0..steps)
        .map(|_| {
            let start = Instant::now();
            flow.step(1.0 / 60.0, &settings, &cancel).unwrap();
            ms_since(start)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let flow_mb = resident_mb() - before - mesh_mb;
    let unit = (2.0 * flow.kinetic_energy()).sqrt() / flow.mean_edge();
    println!(
        "{{\"vertices\": {}, \"threads\": {threads}, \"bind_ms\": {bind_ms:.0}, \"step_ms\": {:.1}, \
         \"flow_mb\": {flow_mb:.0}, \"factor_mb\": {:.0}, \"mesh_mb\": {mesh_mb:.0}, \"divergence\": {:.1e}}}",
        positions.len(),
        times[times.len() / 2],
        flow.factor_len() as f64 * 8.0 / 1024.0 / 1024.0,
        flow.divergence() / unit,
    );
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// The resident memory of this process.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    number.unwrap_or(0.0) / 1024.0
}
