//! The laws of coordinates in a cage, and each against its definition.

use std::f64::consts::PI;

use crate::cage::made_for;
use crate::rig::turned;
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::stages::cage::{Mesh, green, green_moved, harmonic, mean_value};
use pliant_mesh::shapes;

fn sphere() -> Mesh {
    let drawn = shapes::icosphere(1);
    let faces = drawn.triangles.iter().map(|t| t.map(|v| v.0)).collect();
    (drawn.positions, faces)
}

/// Places inside the sphere that are in no plane of its faces.
fn inside() -> Vec<DVec3> {
    let along = |k: u32| (f64::from(k) * 0.618).fract() * 1.2 - 0.6;
    (1..40)
        .map(|k| DVec3::new(along(k), along(3 * k + 1), along(7 * k + 2)) * 0.8)
        .collect()
}

fn all_cages() -> Vec<(&'static str, Mesh, Vec<DVec3>)> {
    let mut all = vec![("sphere", sphere(), inside())];
    for (name, drawn) in shapes::classes() {
        for detail in [3, 6] {
            let (mesh, points) = made_for(&drawn, detail);
            all.push((name, mesh, points));
        }
    }
    all
}

fn linear(mesh: &Mesh, weights: impl Iterator<Item = f64>) -> (f64, DVec3) {
    let terms = mesh.0.iter().zip(weights);
    terms.fold((0.0, DVec3::ZERO), |(sum, point), (vertex, weight)| {
        (sum + weight, point + *vertex * weight)
    })
}

fn face_normals((vertices, faces): &Mesh) -> Vec<DVec3> {
    let normal = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| vertices[v as usize]);
        (b - a).cross(c - a).normalize()
    };
    faces.iter().map(normal).collect()
}

#[test]
fn mean_value_coordinates_sum_to_one_and_reproduce_the_point() {
    for (name, mesh, points) in all_cages() {
        for (point, weights) in points.iter().zip(mean_value(&mesh, &points)) {
            let (sum, found) = linear(&mesh, weights.iter().map(|(weight, _)| *weight));
            assert!((sum - 1.0).abs() < 1e-9, "{name}: {sum}");
            assert!(found.distance(*point) < 1e-9, "{name}: {:e}", found.distance(*point));
        }
    }
}

#[test]
fn green_coordinates_sum_to_one_and_reproduce_the_point() {
    for (name, mesh, points) in all_cages() {
        let normals = face_normals(&mesh);
        for point in points {
            let weights = green(&mesh, point);
            let (sum, mut found) = linear(&mesh, weights.iter().map(|(weight, _)| *weight));
            for (normal, (weight, _)) in normals.iter().zip(&weights[mesh.0.len()..]) {
                found += *normal * *weight;
                assert!(*weight >= 0.0);
            }
            assert!((sum - 1.0).abs() < 1e-9, "{name}: {sum}");
            assert!(found.distance(point) < 1e-9, "{name}: {:e}", found.distance(point));
        }
    }
}

#[test]
fn harmonic_coordinates_sum_to_one_reproduce_the_point_and_are_not_negative() {
    for (name, drawn) in shapes::classes() {
        let (mesh, points) = made_for(&drawn, 3);
        let longest = shapes::model(drawn).bounds().unwrap();
        let voxel = longest.extent().max_element() / longest.diagonal() / 3.0;
        for (point, weights) in points.iter().zip(harmonic(&mesh, voxel / 6.0, &points).unwrap()) {
            assert!(weights.iter().all(|weight| *weight >= 0.0), "{name}");
            let (sum, found) = linear(&mesh, weights.into_iter());
            assert!((sum - 1.0).abs() < 1e-9, "{name}: {sum}");
            assert!(found.distance(*point) < 1e-9, "{name}: {:e}", found.distance(*point));
        }
    }
}

#[test]
fn on_the_cage_coordinates_are_those_of_the_face() {
    let mesh = sphere();
    let (vertices, faces) = &mesh;
    let normals = face_normals(&mesh);
    for (face, normal) in faces.iter().zip(&normals).step_by(7) {
        for barycentric in [[0.2, 0.5, 0.3], [0.0, 0.4, 0.6], [1.0, 0.0, 0.0]] {
            let corners = face.map(|v| vertices[v as usize]);
            let point = (0..3).map(|k| corners[k] * barycentric[k]).sum::<DVec3>();
            let weights = &mean_value(&mesh, &[point])[0];
            for (vertex, (weight, gradient)) in weights.iter().enumerate() {
                let corner = face.iter().position(|v| *v as usize == vertex);
                let expected = corner.map_or(0.0, |corner| barycentric[corner]);
                assert!(
                    (weight - expected).abs() < 1e-9 && gradient.is_finite(),
                    "{weight} {expected}"
                );
            }
            // On it to rounding, Green's are those of one side; a little within they are continuous.
            let within = green_moved(&mesh, vertices, point - *normal * 1e-7);
            assert!(
                within.distance(point - *normal * 1e-7) < 1e-7,
                "{:e}",
                within.distance(point)
            );
            let on = green(&mesh, point);
            assert!(
                on.iter()
                    .all(|(weight, gradient)| weight.is_finite() && gradient.is_finite())
            );
        }
    }
}

#[test]
fn outside_everything_stays_finite() {
    let mesh = sphere();
    let points = [DVec3::X * 2.0, DVec3::new(5.0, -3.0, 0.1), DVec3::splat(1e6)];
    for (point, weights) in points.iter().zip(mean_value(&mesh, &points)) {
        assert!(
            weights
                .iter()
                .all(|(weight, gradient)| weight.is_finite() && gradient.is_finite())
        );
        assert!(
            green(&mesh, *point)
                .iter()
                .all(|(weight, gradient)| weight.is_finite() && gradient.is_finite())
        );
    }
    let harmonic = harmonic(&mesh, 0.1, &points).unwrap();
    assert!(harmonic.iter().flatten().all(|weight| weight.is_finite()));
}

#[test]
fn gradients_are_the_derivatives_of_the_coordinates() {
    let mesh = sphere();
    let step = 1e-5;
    for point in inside() {
        let mean = |p: DVec3| mean_value(&mesh, &[p]).remove(0);
        let greens = |p: DVec3| green(&mesh, p);
        for at in [&mean as &dyn Fn(DVec3) -> Vec<(f64, DVec3)>, &greens] {
            let here = at(point);
            for axis in 0..3 {
                let [ahead, behind] = [1.0, -1.0].map(|sign| at(point + DVec3::AXES[axis] * sign * step));
                for ((own, ahead), behind) in here.iter().zip(&ahead).zip(&behind) {
                    let difference = (ahead.0 - behind.0) / (2.0 * step);
                    assert!((own.1[axis] - difference).abs() < 1e-7, "{} {difference}", own.1[axis]);
                }
            }
        }
    }
}

/// Figure 4 of [JSW05], line by line.
fn mean_value_by_definition((vertices, faces): &Mesh, x: DVec3) -> Vec<f64> {
    let d: Vec<f64> = vertices.iter().map(|p| p.distance(x)).collect();
    let u: Vec<DVec3> = vertices.iter().zip(&d).map(|(p, d)| (*p - x) / *d).collect();
    let mut weights = vec![0.0; vertices.len()];
    for face in faces {
        let [a, b, c] = face.map(|v| v as usize);
        let numbers = [a, b, c];
        let length = [u[b].distance(u[c]), u[c].distance(u[a]), u[a].distance(u[b])];
        let theta = length.map(|l| 2.0 * (0.5 * l).asin());
        let h = 0.5 * theta.iter().sum::<f64>();
        let sign = u[a].dot(u[b].cross(u[c])).signum();
        let cosine: Vec<f64> = (0..3)
            .map(|i| 2.0 * h.sin() * (h - theta[i]).sin() / (theta[(i + 1) % 3].sin() * theta[(i + 2) % 3].sin()) - 1.0)
            .collect();
        let sine: Vec<f64> = cosine.iter().map(|c| sign * (1.0 - c * c).max(0.0).sqrt()).collect();
        for i in 0..3 {
            let (next, last) = ((i + 1) % 3, (i + 2) % 3);
            weights[numbers[i]] += (theta[i] - cosine[next] * theta[last] - cosine[last] * theta[next])
                / (d[numbers[i]] * theta[next].sin() * sine[last]);
        }
    }
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

#[test]
fn mean_value_coordinates_are_those_of_the_definition() {
    let mesh = sphere();
    let points = inside();
    for (point, weights) in points.iter().zip(mean_value(&mesh, &points)) {
        for ((weight, _), expected) in weights.iter().zip(mean_value_by_definition(&mesh, *point)) {
            assert!((weight - expected).abs() < 1e-8, "{weight} {expected}");
        }
    }
}

/// Both potentials of a face by a rule of degree 5 on 4⁵ parts of it.
fn potentials(corners: [DVec3; 3], normal: DVec3, p: DVec3) -> ([f64; 3], f64) {
    let root = 15.0_f64.sqrt();
    let (near, far) = ((6.0 - root) / 21.0, (6.0 + root) / 21.0);
    let mut rule = vec![([1.0 / 3.0; 3], 9.0 / 40.0)];
    for (at, weight) in [(near, (155.0 - root) / 1200.0), (far, (155.0 + root) / 1200.0)] {
        for corner in 0..3 {
            let mut barycentric = [at; 3];
            barycentric[corner] = 1.0 - 2.0 * at;
            rule.push((barycentric, weight));
        }
    }
    let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    let parts = 32_i32;
    let (mut double, mut single) = ([0.0; 3], 0.0);
    let share = area / f64::from(parts * parts);
    for i in 0..parts {
        for j in 0..parts - i {
            for up in [true, false] {
                if !up && i + j + 1 >= parts {
                    continue;
                }
                let places = if up {
                    [(i, j), (i + 1, j), (i, j + 1)]
                } else {
                    [(i + 1, j + 1), (i, j + 1), (i + 1, j)]
                };
                let places = places.map(|(i, j)| [i, j].map(|k| f64::from(k) / f64::from(parts)));
                for (barycentric, weight) in &rule {
                    let at = |k: usize| (0..3).map(|c| places[c][k] * barycentric[c]).sum::<f64>();
                    let hats = [1.0 - at(0) - at(1), at(0), at(1)];
                    let q: DVec3 = (0..3).map(|c| corners[c] * hats[c]).sum();
                    let r = (q - p).length();
                    single += weight * share / (4.0 * PI * r);
                    for corner in 0..3 {
                        double[corner] += weight * share * hats[corner] * (q - p).dot(normal) / (4.0 * PI * r.powi(3));
                    }
                }
            }
        }
    }
    (double, single)
}

#[test]
fn green_coordinates_are_the_integrals_of_the_definition() {
    let mesh = sphere();
    let normals = face_normals(&mesh);
    for point in inside().into_iter().step_by(6).map(|p| p * 0.8) {
        let found = green(&mesh, point);
        let mut expected = vec![0.0; found.len()];
        for (number, (face, normal)) in mesh.1.iter().zip(&normals).enumerate() {
            let (double, single) = potentials(face.map(|v| mesh.0[v as usize]), *normal, point);
            for (vertex, double) in face.iter().zip(double) {
                expected[*vertex as usize] += double;
            }
            expected[mesh.0.len() + number] = single;
        }
        for ((found, _), expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-8, "{found} {expected}");
        }
    }
}

/// A cube of 12 triangles.
fn cube() -> Mesh {
    let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    ((0..8).map(corner).collect(), faces.collect())
}

/// A vertex' hat function on the cube's walls.
fn hat((vertices, faces): &Mesh, vertex: u32, q: DVec3) -> f64 {
    for face in faces {
        let [a, b, c] = face.map(|v| vertices[v as usize]);
        let normal = (b - a).cross(c - a);
        let areas =
            [(b, c), (c, a), (a, b)].map(|(from, to)| (from - q).cross(to - q).dot(normal) / normal.length_squared());
        if (q - a).dot(normal).abs() < 1e-9 && areas.iter().all(|area| *area >= -1e-9) {
            return face
                .iter()
                .zip(areas)
                .filter(|(v, _)| **v == vertex)
                .map(|(_, area)| area)
                .sum();
        }
    }
    panic!("{q} lies on no wall");
}

#[test]
fn harmonic_coordinates_are_the_plain_iteration_on_the_grid() {
    let mesh = cube();
    let step = 0.11;
    let low = -DVec3::new(1.371_71, 1.413_73, 1.293_17) * step;
    let node = |i: [i32; 3]| low + DVec3::from_array(i.map(f64::from)) * step;
    let is_in = |i: [i32; 3]| node(i).cmpgt(DVec3::ZERO).all() && node(i).cmplt(DVec3::ONE).all();
    let count = 13;
    let number = |i: [i32; 3]| (i[0] + count * (i[1] + count * i[2])) as usize;
    let all: Vec<[i32; 3]> = (0..count.pow(3))
        .map(|n| [n % count, n / count % count, n / count / count])
        .collect();
    let vertex = 3;
    // Each node's constant, its weight, and its neighbours.
    let balance = |i: [i32; 3]| {
        let (mut constant, mut weight, mut beside) = (0.0, 0.0, Vec::new());
        for axis in 0..3 {
            for sign in [-1, 1] {
                let mut next = i;
                next[axis] += sign;
                if is_in(next) {
                    weight += 1.0;
                    beside.push(number(next));
                } else {
                    let mut wall = node(i);
                    wall[axis] = if sign > 0 { 1.0 } else { 0.0 };
                    let share = step / wall.distance(node(i));
                    weight += share;
                    constant += share * hat(&mesh, vertex, wall);
                }
            }
        }
        (constant, weight, beside)
    };
    let balances: Vec<_> = all
        .iter()
        .filter(|i| is_in(**i))
        .map(|i| (number(*i), balance(*i)))
        .collect();
    let mut values = vec![0.0; all.len()];
    for _ in 0..600 {
        for (own, (constant, weight, beside)) in &balances {
            values[*own] = (constant + beside.iter().map(|n| values[*n]).sum::<f64>()) / weight;
        }
    }
    let spline = |x: f64| match x.abs() {
        x if x < 1.0 => 2.0 / 3.0 - x * x + 0.5 * x * x * x,
        x if x < 2.0 => (2.0 - x).powi(3) / 6.0,
        _ => 0.0,
    };
    let points: Vec<DVec3> = inside().into_iter().map(|p| DVec3::splat(0.5) + 0.4 * p).collect();
    for (point, found) in points.iter().zip(harmonic(&mesh, step, &points).unwrap()) {
        let expected: f64 = all
            .iter()
            .map(|i| {
                let x = (*point - node(*i)) / step;
                values[number(*i)] * spline(x.x) * spline(x.y) * spline(x.z)
            })
            .sum();
        let found = found[vertex as usize];
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
}

#[test]
fn green_coordinates_turn_and_scale_a_cage_exactly() {
    let mesh = sphere();
    let motion = turned(DVec3::X, 2.1, DVec3::new(3.0, -1.0, 0.5)) * DAffine3::from_scale(DVec3::splat(0.6));
    let moved: Vec<DVec3> = mesh.0.iter().map(|p| motion.transform_point3(*p)).collect();
    for point in inside() {
        let error = green_moved(&mesh, &moved, point).distance(motion.transform_point3(point));
        assert!(error < 1e-9, "{error:e}");
    }
}

/// The longest axis of the ellipse that a small circle becomes, over its shortest.
fn roundness(map: impl Fn(DVec3) -> DVec3, point: DVec3) -> f64 {
    let step = 1e-4;
    let column = |axis: DVec3| (map(point + axis * step) - map(point - axis * step)) / (2.0 * step);
    let jacobian = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    let lengths = (0..400).map(|k| {
        let height = 1.0 - (2.0 * f64::from(k) + 1.0) / 400.0;
        let (sin, cos) = (f64::from(k) * 2.399_963).sin_cos();
        let across = (1.0 - height * height).sqrt();
        (jacobian * DVec3::new(across * cos, across * sin, height)).length()
    });
    let (low, high) = lengths.fold((f64::INFINITY, 0.0_f64), |(low, high), l| (low.min(l), high.max(l)));
    high / low
}

#[test]
fn green_coordinates_keep_small_circles_round_where_mean_values_do_not() {
    let mesh = sphere();
    let maps: [fn(DVec3) -> DVec3; 3] = [
        |p| DVec3::new(2.0 * p.x, p.y, p.z),
        |p| DVec3::new(p.x + 0.8 * p.y, p.y, p.z),
        |p| {
            DVec3::new(
                (1.0 + p.x) * (1.2 * p.y).cos() - 1.0,
                (1.0 + p.x) * (1.2 * p.y).sin() * 1.5,
                p.z,
            )
        },
    ];
    for (map, least) in maps.into_iter().zip([0.65; 3]) {
        let mut excess = [0.0; 2];
        let moved: Vec<DVec3> = mesh.0.iter().map(|p| map(*p)).collect();
        for point in inside().into_iter().step_by(5) {
            let green = roundness(|p| green_moved(&mesh, &moved, p), point);
            let mean = |p: DVec3| {
                let weights = mean_value(&mesh, &[p]).remove(0);
                moved.iter().zip(weights).map(|(v, (weight, _))| *v * weight).sum()
            };
            let mean_value = roundness(mean, point);
            excess[0] += green - 1.0;
            excess[1] += mean_value - 1.0;
            assert!(green < mean_value, "{green} {mean_value}");
        }
        assert!(excess[0] < least * excess[1], "{excess:?}");
    }
}
