//! Times the linear shell step by step: `linear MESH.off THREADS [cpu]`.
//!
//! The edit is the one that peers are timed on: the lowest 5% along the longest axis are fixed, the highest 5% are the
//! handle. One JSON object a line; times are medians in milliseconds, sizes in megabytes. With
//! `cpu` times are the processor's, summed over threads: what a busy machine leaves comparable.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

use std::sync::OnceLock;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use pliant_deform::stages::Operator;
use pliant_deform::{Holds, Loose, Method, Ordering, Problem, Role};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, WeldOptions, vertex_normals};
use rayon::prelude::*;

fn main() {
    let mut words = std::env::args().skip(1);
    let usage = "usage: linear MESH.off THREADS [cpu]";
    let file = words.next().unwrap_or_else(|| panic!("{usage}"));
    let threads = words.next().and_then(|word| word.parse().ok()).unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let clock: fn() -> f64 = match words.next().as_deref() {
        Some("cpu") => processor_ms,
        _ => wall_ms,
    };
    pool.install(|| measure(&file, threads, clock));
}

fn measure(file: &str, threads: usize, clock: fn() -> f64) {
    let median = Median { clock };
    let model = read(file);
    let count = model.surface.positions.len();
    let (roles, stroked) = roles(&model);
    let stiffness = vec![1.0; count];
    let method = Method::default();
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let problem = |roles| Problem {
        surface: &model.surface,
        topology: &model.topology,
        roles,
        handle_count: 1,
        stiffness: &stiffness,
        holds: Holds::default(),
        loose: Loose::Rest,
        method: &method,
        revision: 0,
    };
    let times = if count > 500_000 { 3 } else { 5 };
    let order = || Ordering::of(&model.topology, method.operator_power(), &progress, &cancel).unwrap();
    let (order_ms, ordering) = median.of(times, order);
    let Method::Bilaplacian(options) = &method else {
        unreachable!()
    };
    let (operator_ms, operator) = median.of(times, || Operator::of(&problem(&roles), options, &ordering).unwrap());
    let (assemble_ms, matrix) = median.of(times, || operator.assemble());
    let (symbolic_ms, _) = median.of(times, || operator.analyse(&matrix).unwrap());
    let (numeric_ms, factor) = median.of(times, || {
        let mut factor = operator.analyse(&matrix).unwrap();
        factor.fill(&matrix).unwrap();
        factor
    });
    let numeric_ms = numeric_ms - symbolic_ms;
    let work = factor.work();
    let mut x = vec![[1.0; 3]; factor.column_count()];
    let (substitute_ms, ()) = median.of(times, || factor.solve(&mut x));
    drop((x, factor, matrix, operator));
    let (bind_ms, mut bound) = median.of(times, || problem(&roles).bind(&ordering, &progress, &cancel).unwrap());
    let former = problem(&roles).rebind(&ordering, None, &progress, &cancel).unwrap();
    let remains = former.remains();
    drop(former);
    let (rebind_ms, _) = median.of(times, || {
        problem(&stroked)
            .rebind(&ordering, remains.as_ref(), &progress, &cancel)
            .unwrap()
    });
    drop(remains);
    bound.set_targets(&[DAffine3::from_translation(DVec3::X)]).unwrap();
    let mut displacements = vec![DVec3::ZERO; count];
    let (solve_ms, _) = median.of(times, || bound.step_by_back_substitution(&mut displacements).unwrap());
    let (frame_ms, _) = median.of(60, || bound.step(&mut displacements).unwrap());
    let mut normals = Vec::new();
    let positions: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .zip(&displacements)
        .map(|(p, d)| *p + *d)
        .collect();
    let (normals_ms, ()) = median.of(60, || {
        vertex_normals(&model.surface.triangles, &model.topology, &positions, &mut normals);
    });
    let name = std::path::Path::new(file)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let factor_mb = bound.factor_len() as f64 * 8e-6;
    println!(
        "{{\"mesh\": \"{name}\", \"threads\": {threads}, \"free\": {}, \"order\": {order_ms:.1}, \"operator\": {operator_ms:.1}, \
         \"assemble\": {assemble_ms:.1}, \"symbolic\": {symbolic_ms:.1}, \"numeric\": {numeric_ms:.1}, \
         \"substitute3\": {substitute_ms:.1}, \"bind\": {bind_ms:.2}, \
         \"rebind\": {rebind_ms:.2}, \"solve\": {solve_ms:.2}, \"frame\": {frame_ms:.3}, \"normals\": {normals_ms:.3}, \
         \"gflop\": {:.2}, \"factor_mb\": {factor_mb:.1}, \"read_gb_s\": {:.1}, \"peak_mb\": {:.0}}}",
        bound.solved_count(),
        1e-9 * work,
        bandwidth(&median),
        peak_mb(),
    );
}

/// The roles of the edit, and the same after a stroke on the handle's rim that adds a thousandth of the vertices to it.
fn roles(model: &Model) -> (Vec<Role>, Vec<Role>) {
    let bounds = model.bounds().unwrap();
    let extent = bounds.extent();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap();
    let roles: Vec<Role> = model
        .surface
        .positions
        .iter()
        .map(|p| match (p[axis] - bounds.min[axis]) / extent[axis] {
            t if t < 0.05 => Role::Fixed,
            t if t > 0.95 => Role::Handle(0),
            _ => Role::Free,
        })
        .collect();
    let mut stroked = roles.clone();
    let at_rim = |v: &u32| {
        let mut ring = model.topology.neighbours(SurfaceVertex(*v)).iter();
        roles[*v as usize] == Role::Free && ring.any(|n| roles[n.index()] == Role::Handle(0))
    };
    let mut queue: Vec<u32> = (0..roles.len() as u32).find(at_rim).into_iter().collect();
    let mut next = 0;
    while next < queue.len() && next < roles.len().div_ceil(1000) {
        let vertex = queue[next];
        next += 1;
        stroked[vertex as usize] = Role::Handle(0);
        for neighbour in model.topology.neighbours(SurfaceVertex(vertex)) {
            if stroked[neighbour.index()] == Role::Free && !queue.contains(&neighbour.0) {
                queue.push(neighbour.0);
            }
        }
    }
    (roles, stroked)
}

/// Times things by a clock.
struct Median {
    clock: fn() -> f64,
}

impl Median {
    /// The median time of some runs, and what the last one gave.
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
        taken.sort_by(f64::total_cmp);
        (taken[times / 2], last.unwrap())
    }
}

/// Milliseconds since the first call.
fn wall_ms() -> f64 {
    static FIRST: OnceLock<Instant> = OnceLock::new();
    FIRST.get_or_init(Instant::now).elapsed().as_secs_f64() * 1e3
}

/// Milliseconds that processors have spent on this process' threads.
fn processor_ms() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task").unwrap();
    let spent = |thread: std::io::Result<std::fs::DirEntry>| -> f64 {
        let text = std::fs::read_to_string(thread.unwrap().path().join("schedstat")).unwrap();
        text.split_whitespace().next().unwrap().parse().unwrap()
    };
    threads.map(spent).sum::<f64>() * 1e-6
}

/// How fast all threads together read memory in order, in GB/s.
fn bandwidth(median: &Median) -> f64 {
    let numbers = vec![1.0_f64; 64 << 20];
    let (ms, sum) = median.of(5, || {
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

/// The most memory that this process has held; 0 where the system doesn't say.
fn peak_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kilobytes = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse().ok());
    kilobytes.map_or(0.0, |kb: f64| kb / 1024.0)
}

/// An OFF file of triangles.
fn read(file: &str) -> Model {
    let text = std::fs::read_to_string(file).unwrap();
    let mut numbers = text.split_ascii_whitespace().skip(1);
    let mut next = || numbers.next().unwrap();
    let (vertices, triangles): (usize, usize) = (next().parse().unwrap(), next().parse().unwrap());
    next();
    let positions = (0..vertices)
        .map(|_| {
            DVec3::new(
                next().parse().unwrap(),
                next().parse().unwrap(),
                next().parse().unwrap(),
            )
        })
        .collect();
    let triangles = (0..triangles)
        .map(|_| {
            next();
            [(); 3].map(|()| DrawnVertex(next().parse().unwrap()))
        })
        .collect();
    let drawn = Drawn::once(positions, triangles);
    Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap()
}
