//! Wide and narrow vectors give the same bits.
//!
//! The single test is alone in its binary, because the choice of vectors holds for the whole process.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic")]

#[allow(dead_code, reason = "the laws need more of it")]
#[path = "deform/rig.rs"]
mod rig;

use glam::DVec3;
use pliant_deform::{METHODS, Method, OptionKind, OptionValue, Role};
use pliant_mesh::{Vectors, shapes, vertex_normals};
use rig::{Scene, far, settle};

/// Each method with its defaults, and with each other choice of one of its options.
fn methods() -> Vec<Method> {
    let mut methods = Vec::new();
    for declaration in METHODS {
        let plain = (declaration.default)();
        for option in declaration.options {
            if let OptionKind::Named { choices } = option.kind {
                let others = choices.iter().map(|name| (option.name, OptionValue::Name(name)));
                methods.extend(others.filter_map(|choice| plain.with([choice]).ok()));
            }
        }
        methods.push(plain);
    }
    methods
}

/// The method with fewer unknowns, if an option tells their number: the narrowest vectors multiply slowly.
fn small(method: Method) -> Method {
    let counts = [("cells", 150), ("nodes", 30), ("detail", 3)];
    counts.into_iter().fold(method, |method, (option, count)| {
        let few = method.with([(option, OptionValue::Whole(count))]);
        few.unwrap_or(method)
    })
}

/// The displacements of a far drag, and the normals of the shape.
fn result(scene: &Scene) -> (Vec<DVec3>, Vec<DVec3>) {
    let (displacements, _) = settle(&mut scene.bind(), &far(scene));
    let places: Vec<DVec3> = scene
        .positions()
        .iter()
        .zip(&displacements)
        .map(|(p, d)| *p + *d)
        .collect();
    let mut normals = Vec::new();
    vertex_normals(
        &scene.model.surface.triangles,
        &scene.model.topology,
        &places,
        &mut normals,
    );
    (displacements, normals)
}

#[test]
fn every_method_gives_the_same_bits_with_all_vectors_that_the_processor_has() {
    let (mut compared, mut different) = (0, Vec::new());
    for method in methods() {
        let method = small(method);
        for drawn in [shapes::torus(40, 24), shapes::grid(30, 30)] {
            let mut scene = Scene::new(drawn).with_ends(true);
            assert!(scene.roles.contains(&Role::Free));
            scene.method = method.clone();
            for (stiffness, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
                *stiffness = 1.0 + p.x.abs();
            }
            assert!(Vectors::Baseline.choose());
            let baseline = result(&scene);
            for vectors in [Vectors::Avx2, Vectors::Avx512] {
                if vectors.choose() {
                    compared += 1;
                    if result(&scene) != baseline {
                        different.push(format!("{} {method:?}", vectors.name()));
                    }
                }
            }
        }
    }
    println!("{compared} results compared with the narrowest vectors'");
    assert!(different.is_empty(), "{}", different.join("\n"));
}
