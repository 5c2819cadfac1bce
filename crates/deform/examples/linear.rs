//! Times the bi-Laplacian step by step: `linear MESH.off THREADS [cpu]`.
//!
//! The edit is the one that peers are timed on: the lowest 5% along the longest axis are fixed, the highest 5% are the
//! handle. One JSON object a line; times are medians in milliseconds, sizes in megabytes. With `cpu`, times are the
//! processor's, summed over threads, which stay comparable on a busy machine.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

use common::{median, ms, name, one_handle, peak_mb, peers_edit, pool, processor_ms, read, stroke};
use glam::{DVec3, Vec3A};
use pliant_deform::stages::Operator;
use pliant_deform::{Bilaplacian, Method, Ordering};
use pliant_mesh::{Cancel, Progress, SurfaceVertex, vertex_normals};
use rayon::prelude::*;

fn main() {
    let mut words = std::env::args().skip(1);
    let usage = "usage: linear MESH.off THREADS [cpu]";
    let file = words.next().unwrap_or_else(|| panic!("{usage}"));
    let threads = words.next().and_then(|word| word.parse().ok()).unwrap_or(1);
    let pool = pool(threads);
    let clock: fn() -> f64 = match words.next().as_deref() {
        Some("cpu") => processor_ms,
        _ => wall_ms,
    };
    pool.install(|| measure(Path::new(&file), threads, clock));
}

fn measure(file: &Path, threads: usize, clock: fn() -> f64) {
    let watch = Watch { clock };
    let model = read(file);
    let count = model.surface.positions.len();
    let (roles, target) = peers_edit(&model);
    let stroked = stroke(&model, &roles);
    let stiffness = vec![1.0; count];
    let method = Method::default();
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let problem = |roles| one_handle(&model, roles, &stiffness, &method);
    let times = if count > 500_000 { 3 } else { 5 };
    let order = || Ordering::of(&model.topology, 2, &progress, &cancel).unwrap();
    let (order_ms, ordering) = watch.of(times, order);
    let Some(options) = method.options::<Bilaplacian>() else {
        unreachable!()
    };
    let (operator_ms, operator) = watch.of(times, || Operator::of(&problem(&roles), options, &ordering).unwrap());
    let (assemble_ms, matrix) = watch.of(times, || operator.assemble().unwrap());
    let (symbolic_ms, _) = watch.of(times, || operator.analyse(&matrix).unwrap());
    let (numeric_ms, factor) = watch.of(times, || {
        let mut factor = operator.analyse(&matrix).unwrap();
        factor.fill(&matrix).unwrap();
        factor
    });
    let numeric_ms = numeric_ms - symbolic_ms;
    let work = factor.work();
    let mut x = vec![[1.0; 3]; factor.column_count()];
    let (substitute_ms, ()) = watch.of(times, || factor.solve(&mut x));
    drop((x, factor, matrix, operator));
    let (bind_ms, mut bound) = watch.of(times, || problem(&roles).bind(&ordering, &progress, &cancel).unwrap());
    bound.set_targets(&[target]).unwrap();
    let mut displacements = vec![DVec3::ZERO; count];
    let (solve_ms, _) = watch.of(times, || bound.step_by_back_substitution(&mut displacements).unwrap());
    let (frame_ms, _) = watch.of(60, || bound.step(&mut displacements).unwrap());
    // The contents of the renderer's buffers, made as the window makes them: in single precision, relative to a centre.
    let rest = &model.surface.positions;
    let centre = model.bounds().unwrap().centre();
    let (mut positions, mut drawn): (Vec<Vec3A>, Vec<[f32; 3]>) = (Vec::new(), Vec::new());
    let (drawn_ms, ()) = watch.of(60, || {
        let moved = rest.par_iter().zip(&displacements).with_min_len(4096);
        moved
            .map(|(rest, moved)| (*rest + *moved - centre).as_vec3a())
            .collect_into_vec(&mut positions);
        let single = |v: SurfaceVertex| positions[v.index()].to_array();
        model.spread(single, |_, v| v.map_or([0.0; 3], single), &mut drawn);
    });
    let mut normals = Vec::new();
    let (normals_ms, ()) = watch.of(60, || {
        vertex_normals(&model.surface.triangles, &model.topology, &positions, &mut normals);
        let single = |v: SurfaceVertex| normals[v.index()].to_array();
        model.spread(single, |_, v| v.map_or([0.0; 3], single), &mut drawn);
    });
    // From here on another bound problem exists beside this one, as in the window while a stroke is bound.
    let peak_mb = peak_mb();
    let former = problem(&roles).rebind(&ordering, None, &progress, &cancel).unwrap();
    let reusable_factor = former.reusable_factor();
    drop(former);
    let (rebind_ms, _) = watch.of(times, || {
        problem(&stroked)
            .rebind(&ordering, reusable_factor.as_ref(), &progress, &cancel)
            .unwrap()
    });
    drop(reusable_factor);
    let (name, read_gb_s) = (name(file), bandwidth(&watch));
    let solve_share = 2e-6 * 8.0 * bound.factor_len() as f64 / substitute_ms / read_gb_s;
    let factor_mb = bound.factor_len() as f64 * 8e-6;
    println!(
        "{{\"mesh\": \"{name}\", \"threads\": {threads}, \"free\": {}, \"order\": {order_ms:.1}, \"operator\": {operator_ms:.1}, \
         \"assemble\": {assemble_ms:.1}, \"symbolic\": {symbolic_ms:.1}, \"numeric\": {numeric_ms:.1}, \
         \"substitute3\": {substitute_ms:.1}, \"bind\": {bind_ms:.2}, \
         \"rebind\": {rebind_ms:.2}, \"solve\": {solve_ms:.2}, \"frame\": {frame_ms:.3}, \"drawn\": {drawn_ms:.3}, \"normals\": {normals_ms:.3}, \
         \"gflop\": {:.2}, \"factor_mb\": {factor_mb:.1}, \"read_gb_s\": {read_gb_s:.1}, \"solve_share\": {solve_share:.2}, \"peak_mb\": {peak_mb:.0}}}",
        bound.solved_count(),
        1e-9 * work,
    );
}

/// Measures times with a clock.
struct Watch {
    clock: fn() -> f64,
}

impl Watch {
    /// The median time of some runs, and the last one's result.
    fn of<T>(&self, times: usize, mut run: impl FnMut() -> T) -> (f64, T) {
        let mut last = None;
        let mut taken: Vec<f64> = (0..times)
            .map(|_| {
                drop(last.take());
                let start = (self.clock)();
                last = Some(run());
                (self.clock)() - start
            })
            .collect();
        (median(&mut taken), last.unwrap())
    }
}

/// Milliseconds since the first call.
fn wall_ms() -> f64 {
    static FIRST: OnceLock<Instant> = OnceLock::new();
    ms(*FIRST.get_or_init(Instant::now))
}

/// The speed at which all threads together read memory in order, in GB/s.
fn bandwidth(watch: &Watch) -> f64 {
    let numbers = vec![1.0_f64; 64 << 20];
    let (ms, sum) = watch.of(5, || {
        numbers
            .par_chunks(1 << 16)
            .map(|chunk| {
                let mut sums = [0.0; 16];
                for line in chunk.chunks_exact(16) {
                    for (sum, value) in sums.iter_mut().zip(line) {
                        *sum += value;
                    }
                }
                sums.iter().sum::<f64>()
            })
            .sum::<f64>()
    });
    assert_eq!(sum, numbers.len() as f64);
    numbers.len() as f64 * 8e-6 / ms
}
