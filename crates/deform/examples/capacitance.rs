//! Times binding the thin plate by its own factor or by the Laplacian's: `capacitance MESH.off THREADS [TIMES [factor|laplacian|both]]`.
//!
//! The mesh is first subdivided TIMES times at the middles of its edges. The edit is the one that peers are timed on.
//! One JSON object a line, for each requested factor: times in seconds, the most memory held while ordering and binding
//! in megabytes, beyond the mesh, and the largest distance between both shapes in diagonals.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::collections::HashMap;
use std::path::Path;

use common::{forget_peak, name, one_handle, peak_mb, peers_edit, pool, read, timed};
use glam::DVec3;
use pliant_deform::{Method, Ordering};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, WeldOptions};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: capacitance MESH.off THREADS [TIMES [factor|laplacian|both]]";
    let file = words.first().unwrap_or_else(|| panic!("{usage}"));
    let number = |place: usize, default: usize| words.get(place).map_or(default, |word| word.parse().unwrap());
    let (threads, times) = (number(1, 2), number(2, 0));
    let powers: &[u32] = match words.get(3).map(String::as_str) {
        Some("factor") => &[2],
        Some("laplacian") => &[1],
        _ => &[2, 1],
    };
    pool(threads).install(|| measure(Path::new(file), threads, times, powers));
}

fn measure(file: &Path, threads: usize, times: usize, powers: &[u32]) {
    let mut model = read(file);
    for _ in 0..times {
        model = subdivided(&model);
    }
    let count = model.surface.positions.len();
    let (roles, target) = peers_edit(&model);
    let stiffness = vec![1.0; count];
    let method = Method::default();
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let problem = one_handle(&model, &roles, &stiffness, &method);
    let mut first: Option<Vec<DVec3>> = None;
    for &power in powers {
        forget_peak();
        let before = peak_mb();
        let (order_ms, ordering) = timed(|| Ordering::of(&model.topology, power, &progress, &cancel).unwrap());
        let ordering_mb = peak_mb() - before;
        let (bind_ms, mut bound) = timed(|| problem.bind(&ordering, &progress, &cancel).unwrap());
        let peak = peak_mb() - before;
        bound.set_targets(&[target]).unwrap();
        let mut displacements = vec![DVec3::ZERO; count];
        let (frame_ms, _) = timed(|| bound.step(&mut displacements).unwrap());
        let apart = first.as_ref().map_or(0.0, |first| {
            let each = first.iter().zip(&displacements).map(|(a, b)| a.distance(*b));
            each.fold(0.0, f64::max) / model.bounds().unwrap().diagonal()
        });
        println!(
            "{{\"mesh\": \"{}\", \"subdivided\": {times}, \"threads\": {threads}, \"power\": {power}, \"free\": {}, \
             \"order_s\": {:.2}, \"bind_s\": {:.2}, \"frame_ms\": {frame_ms:.2}, \"ordering_mb\": {ordering_mb:.0}, \
             \"peak_mb\": {peak:.0}, \"mesh_mb\": {before:.0}, \"factor_mb\": {:.0}, \"apart\": {apart:.1e}}}",
            name(file),
            bound.solved_count(),
            order_ms / 1e3,
            bind_ms / 1e3,
            bound.factor_len() as f64 * 8e-6,
        );
        first = Some(displacements);
    }
}

/// Each triangle cut in four at the middles of its edges.
fn subdivided(model: &Model) -> Model {
    let mut positions = model.surface.positions.clone();
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut triangles = Vec::with_capacity(4 * model.surface.triangles.len());
    for corners in &model.surface.triangles {
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let new = (positions[a as usize] + positions[b as usize]) * 0.5;
                positions.push(new);
                positions.len() as u32 - 1
            })
        };
        let [a, b, c] = corners.map(|corner| corner.0);
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            triangles.push(corners.map(DrawnVertex));
        }
    }
    let drawn = Drawn::once(positions, triangles);
    Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap()
}
