//! Times the space methods that fit lattices and cages: `cage THREADS`.
//!
//! The shape is a torus of 200,000 vertices; the lowest 5% along x are fixed, the highest 5% are the handle. One JSON
//! object a line; times are medians in milliseconds.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::time::Instant;

use common::{median, ms, one_handle, peak_mb, peers_edit};
use glam::DVec3;
use pliant_deform::stages::cage::made;
use pliant_deform::{CageCoordinates, Method, OptionValue};
use pliant_mesh::{Cancel, Progress, shapes};

fn main() {
    let threads = std::env::args().nth(1).and_then(|word| word.parse().ok()).unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| measure(threads));
}

fn measure(threads: usize) {
    let model = shapes::model(shapes::torus(500, 400));
    let (roles, target) = peers_edit(&model);
    let stiffness = vec![1.0; roles.len()];
    let positions = &model.surface.positions;
    let triangles = model.surface.triangles.iter();
    let triangles: Vec<[DVec3; 3]> = triangles.map(|t| t.map(|v| positions[v.index()])).collect();
    let faces = |detail: u32| made(positions, &triangles, detail).1.len();
    let detail = (2..=12).min_by_key(|detail| faces(*detail).abs_diff(300)).unwrap();
    let methods = CageCoordinates::ALL.map(|coordinates| {
        let values = [
            ("coordinates", OptionValue::Name(coordinates.name())),
            ("detail", OptionValue::Whole(detail)),
        ];
        Method::from_name("cage").unwrap().with(values).unwrap()
    });
    for method in methods.into_iter().chain([Method::from_name("lattice").unwrap()]) {
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let problem = one_handle(&model, &roles, &stiffness, &method);
        let mut binds = Vec::new();
        let mut last = None;
        for _ in 0..3 {
            drop(last.take());
            let start = Instant::now();
            last = Some(problem.bind(None, &progress, &cancel).unwrap());
            binds.push(ms(start));
        }
        let mut bound = last.unwrap();
        bound.set_targets(&[target]).unwrap();
        let mut displacements = vec![DVec3::ZERO; positions.len()];
        let mut frames = Vec::new();
        for _ in 0..10 {
            let start = Instant::now();
            bound.step(&mut displacements).unwrap();
            frames.push(ms(start));
        }
        let start = Instant::now();
        bound.jacobians().unwrap();
        let jacobians = ms(start);
        println!(
            "{{\"method\": \"{method:?}\", \"threads\": {threads}, \"vertices\": {}, \"cage_faces\": {}, \"bind\": {:.0}, \
             \"frame\": {:.2}, \"jacobians\": {jacobians:.0}, \"peak_mb\": {:.0}}}",
            positions.len(),
            faces(detail),
            median(&mut binds),
            median(&mut frames),
            peak_mb(),
        );
    }
}
