//! The laws of the lattice.

use crate::rig::{Scene, apart, eliminated, settle, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Constraints, Method, OptionValue, Problem, Role};
use pliant_mesh::{Cancel, Progress, shapes};

fn lattice(values: &[(&str, OptionValue)]) -> Method {
    let values = values.iter().copied();
    Method::from_name("lattice").unwrap().with(values).unwrap()
}

fn bases() -> Vec<Method> {
    let splines = (1..=3).map(|degree| lattice(&[("degree", OptionValue::Whole(degree))]));
    splines
        .chain([lattice(&[("basis", OptionValue::Name("bernstein"))])])
        .collect()
}

fn bar(method: Method) -> Scene {
    let mut scene = Scene::new(shapes::bar(12, 2, 2));
    scene.method = method;
    let (low, high) = (scene.model.bounds().unwrap().min.x, scene.model.bounds().unwrap().max.x);
    scene
        .with(Role::Fixed, |p| p.x < low + 0.1 * (high - low))
        .with(Role::Handle(0), |p| p.x > high - 0.1 * (high - low))
}

#[test]
fn linear_functions_are_reproduced() {
    let map = DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    );
    for method in bases() {
        for (handles, flat) in [(2, false), (1, true)] {
            let mut scene = Scene::new(shapes::icosphere(3));
            scene.method = method.clone();
            // The samples of a flat one do not determine its surroundings.
            let mut scene = scene.with(Role::Handle(0), |p| if flat { p.z == 1.0 } else { p.z > 0.6 });
            if !flat {
                scene = scene.with(Role::Handle(1), |p| p.z < -0.8);
            }
            if scene.handle_count < handles || !scene.roles.contains(&Role::Handle(0)) {
                scene.roles[0] = Role::Handle(0);
            }
            let map = if flat {
                DAffine3::from_translation(map.translation)
            } else {
                map
            };
            let displacements = scene.moved(&vec![map; handles]);
            let positions = scene.positions().iter();
            let expected: Vec<DVec3> = positions.map(|p| map.transform_point3(*p) - *p).collect();
            let error = apart(&displacements, &expected);
            assert!(error < 1e-9, "{method:?}: {error:e}");
        }
    }
}

/// B-splines by the recursion over knots, or Bernstein polynomials by binomials.
fn function(method: &Method, cells: usize, number: usize, t: f64) -> f64 {
    fn spline(degree: usize, number: usize, knot: &dyn Fn(usize) -> f64, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(knot(number) <= t && t < knot(number + 1));
        }
        let d = degree as f64;
        let step = knot(1) - knot(0);
        (t - knot(number)) / (d * step) * spline(degree - 1, number, knot, t)
            + (knot(number + degree + 1) - t) / (d * step) * spline(degree - 1, number + 1, knot, t)
    }
    if method.value("basis") == Some(OptionValue::Name("bernstein")) {
        let binomial = (0..number).fold(1.0, |product, k| product * (cells - k) as f64 / (k + 1) as f64);
        return binomial * t.powi(number as i32) * (1.0 - t).powi((cells - number) as i32);
    }
    let Some(OptionValue::Whole(degree)) = method.value("degree") else {
        unreachable!()
    };
    let knot = |number: usize| (number as f64 - f64::from(degree)) / cells as f64;
    spline(degree as usize, number, &knot, t)
}

#[test]
fn it_is_the_dense_definition() {
    for basis in bases() {
        for norm in ["bending", "displacement"] {
            let cells = 2;
            let values = [
                ("resolution", OptionValue::Whole(cells)),
                ("norm", OptionValue::Name(norm)),
                ("falloff", OptionValue::Number(0.0)),
            ];
            let scene = bar(basis.with(values).unwrap());
            let target = turned(DVec3::X, 0.8, DVec3::new(0.1, 0.4, -0.2));
            let mut held = bar(scene.method.clone());
            for role in &mut held.roles {
                if *role == Role::Fixed {
                    *role = Role::Handle(1);
                }
            }
            held.handle_count = 2;
            for (scene, targets) in [(scene, vec![target]), (held, vec![target, DAffine3::IDENTITY])] {
                let displacements = scene.moved(&targets);
                let error = |regularisation: f64| -> f64 {
                    let expected = by_definition(&scene, &target, cells as usize, (norm == "bending", regularisation));
                    let places = scene.roles.iter().zip(displacements.iter().zip(&expected));
                    let moving = places.filter(|(role, _)| **role != Role::Fixed);
                    moving
                        .map(|(_, (d, expected))| d.distance(*expected))
                        .fold(0.0, f64::max)
                };
                // The smallest one with which no point swings far.
                let errors = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3].map(error);
                let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(least < 1e-8, "{:?}: {errors:?}", scene.method);
            }
        }
    }
}

/// The textbook's field: an affine map if nothing is fixed, then a lattice by normal equations, all dense. The second
/// handle rests.
fn by_definition(scene: &Scene, target: &DAffine3, cells: usize, (bending, regularisation): (bool, f64)) -> Vec<DVec3> {
    let method = &scene.method;
    let moving = scene.roles.iter().zip(scene.positions());
    let moving: Vec<DVec3> = moving
        .filter(|(role, _)| **role != Role::Fixed)
        .map(|(_, p)| *p)
        .collect();
    let low = moving.iter().copied().reduce(DVec3::min).unwrap();
    let high = moving.iter().copied().reduce(DVec3::max).unwrap();
    let diagonal = low.distance(high);
    // All fixed vertices are near.
    let (low, high) = scene
        .positions()
        .iter()
        .fold((low, high), |(low, high), p| (low.min(*p), high.max(*p)));
    let (low, high) = (low - 0.05 * diagonal, high + 0.05 * diagonal);
    let mut samples = Vec::new();
    for role in [Role::Handle(0), Role::Handle(1), Role::Fixed] {
        let own = scene
            .roles
            .iter()
            .zip(scene.positions())
            .filter(|(other, _)| **other == role);
        let inside = |p: &DVec3| p.cmpge(low).all() && p.cmple(high).all();
        let own: Vec<DVec3> = own.map(|(_, p)| *p).filter(inside).collect();
        for &p in &own {
            let wanted = match role {
                Role::Handle(0) => target.transform_point3(p) - p,
                _ => DVec3::ZERO,
            };
            samples.push((p, wanted, 1.0 / own.len() as f64));
        }
    }
    // The affine part.
    let local = |p: DVec3| (p - 0.5 * (low + high)) / diagonal;
    let terms = |p: DVec3| [1.0, local(p).x, local(p).y, local(p).z];
    let change = (target.matrix3 - DMat3::IDENTITY) * diagonal;
    let (mut a, mut b) = (vec![vec![0.0; 4]; 4], vec![DVec3::ZERO; 4]);
    for (number, &(p, wanted, weight)) in samples.iter().enumerate() {
        let is_handle = number < scene.roles.iter().filter(|role| **role == Role::Handle(0)).count();
        for i in 0..4 {
            b[i] += weight * terms(p)[i] * wanted;
            for j in 0..4 {
                a[i][j] += weight * terms(p)[i] * terms(p)[j];
            }
            if i > 0 {
                a[i][i] += 0.01 * weight;
                if is_handle {
                    b[i] += 0.01 * weight * change.col(i - 1);
                }
            }
        }
    }
    let affine = eliminated(a, b);
    let is_held = scene.roles.contains(&Role::Fixed);
    let affine = |p: DVec3| -> DVec3 {
        if is_held {
            return DVec3::ZERO;
        }
        affine.iter().zip(terms(p)).map(|(a, term)| *a * term).sum()
    };
    // The lattice.
    let per_axis = (0..100).take_while(|&number| {
        let nonzero = |step: u32| function(method, cells, number, (f64::from(step) + 0.5) / 64.0) > 0.0;
        number <= cells + 3 && (0..64).any(nonzero)
    });
    let per_axis = if method.value("basis") == Some(OptionValue::Name("bernstein")) {
        cells + 1
    } else {
        per_axis.count()
    };
    let number = |i: usize, j: usize, k: usize| i + per_axis * (j + per_axis * k);
    let count = per_axis.pow(3);
    let row = |p: DVec3| {
        let t = (p - low) / (high - low);
        let mut row = vec![0.0; count];
        for k in 0..per_axis {
            for j in 0..per_axis {
                for i in 0..per_axis {
                    let [x, y, z] = [(i, t.x), (j, t.y), (k, t.z)].map(|(n, t)| function(method, cells, n, t));
                    row[number(i, j, k)] = x * y * z;
                }
            }
        }
        row
    };
    let (mut a, mut b) = (vec![vec![0.0; count]; count], vec![DVec3::ZERO; count]);
    let mut add = |row: &[f64], weight: f64, wanted: DVec3| {
        for i in (0..count).filter(|&i| row[i] != 0.0) {
            b[i] += weight * row[i] * wanted;
            for j in 0..count {
                a[i][j] += weight * row[i] * row[j];
            }
        }
    };
    for &(p, wanted, weight) in &samples {
        add(&row(p), weight, wanted - affine(p));
    }
    let mut stencil = |entries: &[(usize, f64)], factor: f64| {
        let mut row = vec![0.0; count];
        for &(at, value) in entries {
            row[at] = value;
        }
        add(&row, regularisation * factor, DVec3::ZERO);
    };
    let inside = 0..per_axis;
    for k in inside.clone() {
        for j in inside.clone() {
            for i in inside.clone() {
                let own = [i, j, k];
                stencil(&[(number(i, j, k), 1.0)], if bending { 0.01 } else { 1.0 });
                if !bending {
                    continue;
                }
                let step = |steps: [usize; 3]| {
                    let [i, j, k] = [0, 1, 2].map(|axis| own[axis] + steps[axis]);
                    (i.max(j).max(k) < per_axis).then(|| number(i, j, k))
                };
                for along in [[2, 0, 0], [0, 2, 0], [0, 0, 2]] {
                    if let Some(end) = step(along) {
                        let middle = step(along.map(|n| n / 2)).unwrap();
                        stencil(&[(number(i, j, k), 1.0), (middle, -2.0), (end, 1.0)], 1.0);
                    }
                }
                for across in [[1, 1, 0], [1, 0, 1], [0, 1, 1]] {
                    if let Some(end) = step(across) {
                        let first = across.iter().position(|n| *n == 1).unwrap();
                        let mut one = [0; 3];
                        one[first] = 1;
                        let other: [usize; 3] = std::array::from_fn(|axis| across[axis] - one[axis]);
                        let [one, other] = [one, other].map(|steps| step(steps).unwrap());
                        stencil(&[(number(i, j, k), 1.0), (one, -1.0), (other, -1.0), (end, 1.0)], 2.0);
                    }
                }
            }
        }
    }
    let controls = eliminated(a, b);
    let field = |p: &DVec3| {
        let lattice: DVec3 = row(*p).iter().zip(&controls).map(|(weight, d)| *d * *weight).sum();
        affine(*p) + lattice
    };
    scene.positions().iter().map(field).collect()
}

#[test]
fn finer_lattices_meet_the_handles_better() {
    let missed = |cells: u32| {
        let scene = bar(lattice(&[("resolution", OptionValue::Whole(cells))]));
        let mut bound = scene.bind();
        let mut displacements = vec![DVec3::ZERO; scene.roles.len()];
        bound.set_targets(&[turned(DVec3::X, 1.2, DVec3::Y * 0.3)]).unwrap();
        bound.step(&mut displacements).unwrap().handle_residual / scene.diagonal()
    };
    let [coarse, fine] = [1, 6].map(missed);
    assert!(fine < 0.1 * coarse && fine < 1e-4, "{coarse:e} {fine:e}");
}

#[test]
fn each_axis_can_have_its_own_resolution() {
    let target = turned(DVec3::X, 0.5, DVec3::Y * 0.2);
    let alike = bar(lattice(&[("resolution", OptionValue::Whole(3))])).moved(&[target]);
    let each = ["resolution_x", "resolution_y", "resolution_z"].map(|name| (name, OptionValue::Whole(3)));
    assert!(bar(lattice(&each)).moved(&[target]) == alike);
    for name in ["resolution_x", "resolution_y", "resolution_z"] {
        let other = lattice(&[("resolution", OptionValue::Whole(3)), (name, OptionValue::Whole(5))]);
        assert!(apart(&bar(other).moved(&[target]), &alike) > 1e-6, "{name}");
    }
}

#[test]
fn the_field_fades_in_from_what_is_fixed() {
    let scene = bar(lattice(&[("falloff", OptionValue::Number(0.3))]));
    let (displacements, _) = settle(&mut scene.bind(), &[turned(DVec3::X, 0.8, DVec3::Y * 0.5)]);
    let fixed = scene.roles.iter().zip(scene.positions());
    let fixed: Vec<DVec3> = fixed
        .filter(|(role, _)| **role == Role::Fixed)
        .map(|(_, p)| *p)
        .collect();
    let moving = scene.roles.iter().zip(scene.positions()).zip(&displacements);
    for ((role, p), d) in moving {
        let distance = fixed.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
        let share = distance / scene.diagonal();
        let most = 3.0 * (share / 0.25).powi(2) * 1.5 * scene.diagonal();
        assert!(*role != Role::Free || d.length() < most, "{share}: {}", d.length());
    }
}

#[test]
fn soft_handles_yield_and_follow_their_weight() {
    let reached = |weight: f64| {
        let mut scene = bar(lattice(&[]));
        // The middle moves away between two held ends.
        for role in &mut scene.roles {
            if matches!(role, Role::Handle(_)) {
                *role = Role::Fixed;
            }
        }
        let middle = scene.model.bounds().unwrap().centre().x;
        let mut scene = scene.with(Role::Handle(0), |p| (p.x - middle).abs() < 0.05 * scene_length());
        scene.soft = vec![Some(weight)];
        let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Y)]);
        let own = scene
            .roles
            .iter()
            .zip(&displacements)
            .filter(|(role, _)| **role == Role::Handle(0));
        let (count, sum) = own.fold((0.0, 0.0), |(count, sum), (_, d)| (count + 1.0, sum + d.y));
        sum / count
    };
    let ways = [1e-2, 1.0, 1e2, 1e6].map(reached);
    assert!(ways.is_sorted() && ways[0] < 0.3 && ways[3] > 0.95, "{ways:?}");
}

/// The bar's length along x.
fn scene_length() -> f64 {
    bar(lattice(&[])).model.bounds().unwrap().extent().x
}

#[test]
fn what_exceeds_the_budget_and_what_is_cancelled_is_refused() {
    let scene = bar(lattice(&[("resolution", OptionValue::Whole(10))]));
    let cancel = Cancel::new();
    cancel.cancel();
    let problem = Problem {
        constraints: Constraints::default(),
        ..scene.problem(&scene.method)
    };
    let cancelled = problem.bind(None, &Progress::new(), &cancel).unwrap_err();
    assert!(
        matches!(cancelled, pliant_deform::BindError::Cancelled(_)),
        "{cancelled}"
    );
    // 13³ control points: a matrix of 38 MB.
    let budget = pliant_deform::Budget {
        bytes: 30 << 20,
        ..Default::default()
    };
    let refused = problem
        .bind_within(None, budget, &Progress::new(), &Cancel::new())
        .unwrap_err();
    assert!(refused.to_string().contains("30 MiB"), "{refused}");
}
