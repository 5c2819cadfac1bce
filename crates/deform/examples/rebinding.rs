//! The peak memory of binding once, or of binding again after a stroke like the window: `rebinding MESH.off ORDER
//! TRIANGULATION once|again|work`, for instance `rebinding armadillo.off 3 tufted again`.
//!
//! `work` prints the operations of the factorisation instead.
//!
//! The edit is the one that peers are timed on, and the stroke is on its handle's rim. In the window a binding stays
//! until the next one, which builds on it, is done. Each figure is the peak of a separate process.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;
use std::time::Instant;

use common::{ms, name, one_handle, peak_mb, peers_edit, read, stroke};
use pliant_deform::stages::Operator;
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method, TriangulationKind};
use pliant_mesh::{Cancel, Progress};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, order, triangulation, times] = words.as_slice() else {
        panic!("usage: rebinding MESH.off ORDER as-is|intrinsic-delaunay|tufted once|again|work");
    };
    let mut options = Bilaplacian::default();
    options.order = match order.as_str() {
        "1" => BilaplacianOrder::Membrane,
        "2" => BilaplacianOrder::ThinPlate,
        _ => BilaplacianOrder::CurvatureVariation,
    };
    options.triangulation = match triangulation.as_str() {
        "tufted" => TriangulationKind::Tufted,
        "intrinsic-delaunay" => TriangulationKind::IntrinsicDelaunay,
        _ => TriangulationKind::AsIs,
    };
    let method = Method::from(options);
    let model = read(Path::new(file));
    let (roles, _) = peers_edit(&model);
    let stroked = stroke(&model, &roles);
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let problem = |roles| one_handle(&model, roles, &stiffness, &method);
    if times == "work" {
        let power_ordering = method.ordering(&model.topology, &progress, &cancel).unwrap().unwrap();
        let options = method.options::<Bilaplacian>().unwrap();
        let operator = Operator::of(&problem(&roles), options, &power_ordering).unwrap();
        let factor = operator.analyse(&operator.assemble().unwrap()).unwrap();
        let (work, columns) = (factor.work(), factor.column_count() as f64);
        println!(
            "{{\"mesh\": \"{}\", \"free\": {columns}, \"gflop\": {:.2}, \"gflop_a_root_of_free_cubed\": {:.0}}}",
            name(Path::new(file)),
            1e-9 * work,
            work / columns.powf(1.5),
        );
        return;
    }
    let before_mb = peak_mb();
    let start = Instant::now();
    let ordering = method.ordering(&model.topology, &progress, &cancel).unwrap();
    let ordering = ordering.as_ref();
    let bound = if times == "once" {
        problem(&roles).bind(ordering, &progress, &cancel).unwrap()
    } else {
        let first = problem(&roles).rebind(ordering, None, &progress, &cancel).unwrap();
        let reusable = first.reusable_factor();
        let second = problem(&stroked)
            .rebind(ordering, reusable.as_ref(), &progress, &cancel)
            .unwrap();
        drop(first);
        second
    };
    println!(
        "{{\"mesh\": \"{}\", \"times\": \"{times}\", \"free\": {}, \"factor_mb\": {:.0}, \
         \"before_mb\": {before_mb:.0}, \"peak_mb\": {:.0}, \"ms\": {:.0}}}",
        name(Path::new(file)),
        bound.solved_count(),
        bound.factor_len() as f64 * 8e-6,
        peak_mb(),
        ms(start),
    );
}
