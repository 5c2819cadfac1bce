//! The bi-Laplacian's options: the effect of each order, coefficient and discretisation on the shape.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, BindError, Discretisation, Method, Role, TriangulationKind};
use pliant_mesh::{Drawn, shapes};

use crate::rig::{Scene, apart, back_substitute, step, turned};
use crate::strip::{heights, largest_error};

fn bilaplacian(order: BilaplacianOrder, stretching: f64, bending: f64, discretisation: Discretisation) -> Method {
    let mut options = Bilaplacian::default();
    options.order = order;
    options.stretching = stretching;
    options.bending = bending;
    options.discretisation = discretisation;
    Method::from(options)
}

pub fn of_order(order: BilaplacianOrder) -> Method {
    bilaplacian(order, 0.0, 1.0, Discretisation::CotangentArea)
}

fn strip(cells: usize, method: Method) -> (Vec<f64>, f64) {
    heights(cells, method, |_| ())
}

#[test]
fn each_order_converges_to_its_polynomial() {
    let exact: [fn(f64) -> f64; 3] = [
        |s| s,
        |s| s * s * (3.0 - 2.0 * s),
        |s| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
    ];
    for (order, exact) in BilaplacianOrder::ALL.into_iter().zip(exact) {
        let errors = [12, 24, 48].map(|cells| {
            let (heights, pitch) = strip(cells, of_order(order));
            largest_error(&heights, pitch, exact)
        });
        let fine = errors[2] < 1e-7 || (errors[1] < 0.65 * errors[0] && errors[2] < 0.65 * errors[1]);
        assert!(errors[2] < 0.03 && fine, "{order:?}: {errors:?}");
    }
}

/// The order's error against its polynomial between the middles of the n rows that hold each end: n values in a row
/// that lie on the clamped polynomial are n zeros of the strip's, and to second order one of n-th order in their
/// middle.
#[test]
fn each_order_converges_with_second_order_between_the_middles_of_what_holds_it() {
    let exact: [fn(f64) -> f64; 2] = [
        |s| s * s * (3.0 - 2.0 * s),
        |s| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
    ];
    for (order, exact) in [BilaplacianOrder::ThinPlate, BilaplacianOrder::CurvatureVariation]
        .into_iter()
        .zip(exact)
    {
        let errors = [12, 24, 48].map(|cells| {
            let (heights, pitch) = strip(cells, of_order(order));
            let beyond = 0.5 * (order.number() - 1) as f64 * pitch;
            let errors = heights.iter().enumerate().map(|(i, z)| {
                let s = (i as f64 * pitch + beyond) / (1.0 + 2.0 * beyond);
                (z - exact(s)).abs()
            });
            errors.fold(0.0, f64::max)
        });
        let falls = |pair: &[f64]| pair[1] < 0.32 * pair[0] && pair[1] > 0.15 * pair[0];
        assert!(errors.windows(2).all(falls), "{order:?}: {errors:?}");
    }
}

#[test]
fn order_n_joins_what_is_held_with_continuity_n_minus_1() {
    for order in BilaplacianOrder::ALL {
        // The held part is flat, so the k-th derivative's jump is its value at the rim, by one-sided differences.
        let jumps = [16, 32, 64].map(|cells| {
            let (z, pitch) = strip(cells, of_order(order));
            let slope = (z[1] - z[0]) / pitch;
            let curvature = (z[2] - 2.0 * z[1] + z[0]) / (pitch * pitch);
            [z[0].abs(), slope.abs(), curvature.abs()]
        });
        let continuous = order.number() as usize;
        for derivative in 0..continuous {
            let of = jumps.map(|jump| jump[derivative]);
            assert!(
                of[2] == 0.0 || (of[1] < 0.75 * of[0] && of[2] < 0.75 * of[1]),
                "{order:?} {derivative}: {of:?}"
            );
        }
        if continuous < 3 {
            let of = jumps.map(|jump| jump[continuous]);
            assert!(of[2] > 0.8 * of[0] && of[2] > 0.5, "{order:?} {continuous}: {of:?}");
        }
    }
}

#[test]
fn stretching_pulls_the_beam_straight_as_the_formula_says() {
    // −k_s z″/D² + k_b z⁗ = 0 with flat ends: z = ½ + b t + c sinh λt, λ² = k_s / (k_b D²), over the free part.
    for stretching in [8.0, 200.0, 5000.0] {
        let errors = [16, 32, 64].map(|cells| {
            let (heights, pitch) = strip(
                cells,
                bilaplacian(
                    BilaplacianOrder::ThinPlate,
                    3.0 * stretching,
                    3.0,
                    Discretisation::CotangentArea,
                ),
            );
            let length = 1.0 - 2.0 / cells as f64;
            let lambda = (stretching / 2.0).sqrt() * length;
            let c = 0.5 / ((lambda / 2.0).sinh() - lambda / 2.0 * (lambda / 2.0).cosh());
            let b = -c * lambda * (lambda / 2.0).cosh();
            let exact = |t: f64| 0.5 + b * t + c * (lambda * t).sinh();
            let errors = heights
                .iter()
                .enumerate()
                .map(|(i, z)| (z - exact(i as f64 * pitch - 0.5)).abs());
            errors.fold(0.0, f64::max)
        });
        assert!(
            errors[2] < 0.02 && errors[1] < 0.7 * errors[0] && errors[2] < 0.7 * errors[1],
            "{stretching}: {errors:?}"
        );
    }
}

#[test]
fn without_bending_it_is_a_membrane_of_any_stretching() {
    let membrane = strip(20, of_order(BilaplacianOrder::Membrane)).0;
    for stretching in [1e-3, 1.0, 1e6] {
        let mut scene = Scene::new(shapes::grid(20, 20))
            .with(Role::Fixed, |p| p.x < 0.02)
            .with(Role::Handle(0), |p| p.x > 0.98);
        scene.method = bilaplacian(
            BilaplacianOrder::CurvatureVariation,
            stretching,
            0.0,
            Discretisation::CotangentArea,
        );
        assert_eq!(scene.method.ordering_power(), Some(1));
        let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
        for (p, d) in scene.positions().iter().zip(&displacements) {
            assert!((d.z - p.x).abs() < 1e-6, "{p} {d}");
        }
    }
    assert!(membrane.windows(2).all(|z| z[1] > z[0]));
}

/// Every combination of the options; options that make other triangles are combined with the defaults of the others.
fn methods() -> Vec<Method> {
    let mut methods = Vec::new();
    for order in BilaplacianOrder::ALL {
        for discretisation in Discretisation::ALL {
            for stretching in [0.0, 30.0] {
                methods.push(bilaplacian(order, stretching, 1.0, discretisation));
            }
        }
        for (triangulation, anisotropy) in [
            (TriangulationKind::IntrinsicDelaunay, 0.0),
            (TriangulationKind::Tufted, 0.0),
            (TriangulationKind::AsIs, 0.7),
            (TriangulationKind::Tufted, 1.0),
        ] {
            let mut options = Bilaplacian::default();
            options.order = order;
            options.triangulation = triangulation;
            options.anisotropy = anisotropy;
            methods.push(Method::from(options));
        }
    }
    methods
}

/// Whether a system was refused with a place, which on sound shapes only order 3 may be.
fn refused(scene: &Scene, error: &BindError, label: &str) {
    let Some(options) = scene.method.options::<Bilaplacian>() else {
        unreachable!()
    };
    assert!(
        options.order == BilaplacianOrder::CurvatureVariation
            || label.starts_with("broken")
            || label.starts_with("soup"),
        "{label}: {error}"
    );
    assert!(
        error
            .vertex()
            .is_some_and(|vertex| (vertex as usize) < scene.roles.len()),
        "{label}: {error}"
    );
    assert_eq!(
        error.to_string().contains("`order`"),
        options.operator_power() > 1,
        "{label}: {error}"
    );
}

#[test]
fn the_laws_hold_for_every_option_on_every_class() {
    let mut bound_count = 0;
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            let mut scene = Scene::new(drawn.clone()).with_ends(fixed);
            for method in methods() {
                let label = format!("{name} {fixed} {method:?}");
                scene.method = method;
                let mut bound = match scene.try_bind() {
                    Ok(bound) => bound,
                    Err(error) => {
                        refused(&scene, &error, &label);
                        continue;
                    }
                };
                bound_count += 1;
                let targets: Vec<DAffine3> = (0..scene.handle_count)
                    .map(|handle| turned(scene.positions()[0], 0.7 + handle as f64, DVec3::X))
                    .collect();
                let by_bases = step(&mut bound, &targets);
                let by_solving = back_substitute(&mut bound, &targets);
                let size = by_solving.iter().map(|d| d.length()).fold(0.0, f64::max);
                assert!(apart(&by_bases, &by_solving) < 2e-6 * size, "{label}");
                let mut out = vec![DVec3::ZERO; bound.vertex_count()];
                let energy = bound.step(&mut out).unwrap().energy;
                // Triangles without area and a third power make a stiff spot.
                let slack = if name == "broken" { 1e-3 } else { 1e-5 };
                let independent = bound.energy_of(&by_solving).unwrap();
                assert!(
                    (energy - independent).abs() <= slack * independent + 1e-9,
                    "{label}: {energy} {independent}"
                );
                if !fixed {
                    let all = vec![DAffine3::from_translation(DVec3::Z); scene.handle_count];
                    let worst = step(&mut bound, &all)
                        .iter()
                        .map(|d| d.distance(DVec3::Z))
                        .fold(0.0, f64::max);
                    assert!(worst < 1e-9 || name == "broken", "{label}: {worst:e}");
                }
            }
        }
    }
    assert!(bound_count > 150, "{bound_count}");
}

#[test]
fn no_option_depends_on_the_unit() {
    let small = shapes::tube(16, 24, 4.0);
    // A power of two, so that the larger shape is the same to the last bit.
    let scale = DAffine3::from_scale(DVec3::splat(1024.0));
    let ends = |drawn: Drawn, method: &Method| {
        let mut scene = Scene::new(drawn).with_ends(true);
        scene.method = method.clone();
        scene
    };
    for method in methods() {
        let here = ends(small.clone(), &method);
        let there = ends(shapes::moved(&small, scale), &method);
        let motion = turned(DVec3::ZERO, 0.9, DVec3::X);
        let moved_here = here.moved(&vec![motion; here.handle_count]);
        let moved_there = there.moved(&vec![scale * motion * scale.inverse(); there.handle_count]);
        let scaled: Vec<DVec3> = moved_there.iter().map(|d| *d / 1024.0).collect();
        let apart = apart(&moved_here, &scaled);
        assert!(apart < 1e-6 * here.diagonal(), "{method:?}: {apart:e}");
    }
}

#[test]
fn a_band_as_wide_as_the_order_ends_the_influence() {
    for order in BilaplacianOrder::ALL {
        for rings in 1..=3 {
            let (from, to) = (0.5 - 0.01, 0.5 + 0.01 + f64::from(rings - 1) / 24.0);
            let mut scene = Scene::new(shapes::grid(24, 24))
                .with(Role::Fixed, |p| p.x > from && p.x < to)
                .with(Role::Handle(0), |p| p.x > 0.99);
            scene.method = of_order(order);
            let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
            let beyond = scene.positions().iter().zip(&displacements).filter(|(p, _)| p.x < from);
            let moved = beyond.map(|(_, d)| d.length()).fold(0.0, f64::max);
            assert_eq!(moved > 0.0, rings < order.number(), "{order:?} {rings}: {moved}");
        }
    }
}

/// A square sheet sheared by `angle_rad`, its rim held and a disc inside lifted.
fn sheared(angle_rad: f64, discretisation: Discretisation) -> Vec<DVec3> {
    let (sin, cos) = angle_rad.sin_cos();
    let sheet = shapes::grid(24, 24);
    let positions = sheet
        .positions
        .iter()
        .map(|p| DVec3::new(p.x - p.y * cos, p.y * sin, 0.0));
    let positions = positions.collect();
    let square = |p: DVec3| DVec3::new(p.x + p.y / sin * cos, p.y / sin, 0.0);
    let rim = |p: DVec3| p.x.min(p.y).min(1.0 - p.x).min(1.0 - p.y);
    let mut scene = Scene::new(Drawn { positions, ..sheet })
        .with(Role::Fixed, |p| rim(square(p)) < 0.06)
        .with(Role::Handle(0), |p| {
            square(p).distance(DVec3::new(0.7, 0.4, 0.0)) < 0.12
        });
    scene.method = bilaplacian(BilaplacianOrder::ThinPlate, 0.0, 1.0, discretisation);
    scene.moved(&[DAffine3::from_translation(DVec3::Z)])
}

#[test]
fn the_discretisations_agree_on_equilateral_triangles_and_not_on_others() {
    // The grid's diagonals are all parallel: sheared by 60 degrees, every triangle is equilateral.
    for (angle_rad, agree) in [(60.0_f64.to_radians(), true), (2.5, false)] {
        let [uniform, cotangent, best] = Discretisation::ALL.map(|discretisation| sheared(angle_rad, discretisation));
        assert!(best.iter().all(|d| d.z > -0.2 && d.z < 1.2));
        assert!(apart(&best, &cotangent) < 1e-6, "one area for all");
        assert_eq!(apart(&best, &uniform) < 1e-6, agree, "{}", apart(&best, &uniform));
    }
}

#[test]
fn without_areas_dense_vertices_pull_harder() {
    // A strip whose columns get closer and closer: only the areas distinguish the beam from its parameter.
    let error = |discretisation| {
        let sheet = shapes::grid(48, 8);
        let positions = sheet
            .positions
            .iter()
            .map(|p| DVec3::new(p.x * p.x, p.y * 0.2, 0.0))
            .collect();
        let mut scene = Scene::new(Drawn { positions, ..sheet })
            .with(Role::Fixed, |p| p.x.sqrt() < 1.5 / 48.0)
            .with(Role::Handle(0), |p| p.x.sqrt() > 1.0 - 1.5 / 48.0);
        scene.method = bilaplacian(BilaplacianOrder::ThinPlate, 0.0, 1.0, discretisation);
        let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
        let exact = |s: f64| s * s * (3.0 - 2.0 * s);
        let errors = scene
            .positions()
            .iter()
            .zip(&displacements)
            .map(|(p, d)| (d.z - exact(p.x)).abs());
        errors.fold(0.0, f64::max)
    };
    let [uniform, cotangent, best] = Discretisation::ALL.map(error);
    assert!(
        best < 0.5 * cotangent && best < 0.5 * uniform,
        "{best} {cotangent} {uniform}"
    );
}
