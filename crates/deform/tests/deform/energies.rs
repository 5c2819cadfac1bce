//! Energies against a second computation: cotangents from angles, dense matrices, quadratic forms.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method};
use pliant_mesh::{Drawn, shapes};

use crate::rig::{Scene, back_substitute, turned};

type Dense = Vec<Vec<f64>>;

/// −L and M of the survey's equations 6 and 7 with Meyer et al.'s areas, from the angles at each triangle's corners;
/// `stiffness` has a factor per vertex, and each triangle uses the mean.
fn operators(scene: &Scene, stiffness: &[f64]) -> (Dense, Vec<f64>) {
    let count = scene.roles.len();
    let (mut minus_laplacian, mut areas) = (vec![vec![0.0; count]; count], vec![0.0; count]);
    for corners in &scene.model.surface.triangles {
        let [a, b, c] = corners.map(|corner| corner.index());
        let p = scene.positions();
        let stiffness = (stiffness[a] + stiffness[b] + stiffness[c]) / 3.0;
        let angle = |at: usize, to: usize, other: usize| (p[to] - p[at]).angle_between(p[other] - p[at]);
        let triples = [(a, b, c), (b, c, a), (c, a, b)];
        let area = 0.5 * (p[b] - p[a]).cross(p[c] - p[a]).length();
        let angles = triples.map(|(at, to, other)| angle(at, to, other));
        let obtuse = angles.iter().position(|angle| *angle > std::f64::consts::FRAC_PI_2);
        for (corner, (at, to, other)) in triples.into_iter().enumerate() {
            let weight = 0.5 * stiffness / angles[corner].tan();
            for (i, j) in [(to, other), (other, to)] {
                minus_laplacian[i][j] -= weight;
                minus_laplacian[i][i] += weight;
            }
            areas[at] += match obtuse {
                Some(obtuse) if obtuse == corner => area / 2.0,
                Some(_) => area / 4.0,
                None => {
                    let (at_to, at_other) = (p[to].distance_squared(p[at]), p[other].distance_squared(p[at]));
                    // The edge to `to` is opposite the corner `other`.
                    (at_to / angle(other, at, to).tan() + at_other / angle(to, other, at).tan()) / 8.0
                }
            };
        }
    }
    (minus_laplacian, areas)
}

fn product(matrix: &Dense, field: &[f64]) -> Vec<f64> {
    matrix
        .iter()
        .map(|row| row.iter().zip(field).map(|(a, b)| a * b).sum())
        .collect()
}

/// ½ ∫ k_s s |∇d|² / D² + k_b D^(2 (n − 2)) s |∇ⁿ d|² over the three coordinates, where ∇²d is the Laplacian and s is
/// the painted stiffness, by the three products of n between d and d.
fn energy(scene: &Scene, options: &Bilaplacian, displacements: &[DVec3]) -> f64 {
    let (plain, areas) = operators(scene, &vec![1.0; scene.roles.len()]);
    let (stiff, _) = operators(scene, &scene.stiffness);
    let size = scene.size();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let order = options.order.number();
    let mut sum = 0.0;
    for axis in 0..3 {
        let d: Vec<f64> = displacements.iter().map(|d| d[axis]).collect();
        let bent: Vec<f64> = product(&plain, &d).iter().zip(&areas).map(|(v, m)| v / m).collect();
        let bending = match order {
            1 => dot(&d, &product(&stiff, &d)),
            2 => (0..d.len())
                .map(|v| scene.stiffness[v] * areas[v] * bent[v] * bent[v])
                .sum(),
            _ => dot(&bent, &product(&stiff, &bent)),
        };
        sum += 0.5 * options.stretching / size.powi(2) * dot(&d, &product(&stiff, &d));
        sum += 0.5 * options.bending * size.powi(2 * (order as i32 - 2)) * bending;
    }
    sum
}

/// Shapes without a triangle that would be mollified, few enough vertices for dense matrices.
fn sound() -> Vec<Drawn> {
    let mut slanted = DAffine3::from_scale(DVec3::new(40.0, 70.0, 25.0));
    slanted.matrix3.y_axis.x = 30.0;
    vec![
        shapes::moved(&shapes::icosphere(2), slanted),
        shapes::moved(&shapes::torus(12, 8), slanted),
        shapes::tube(10, 14, 5.0),
        shapes::moved(&shapes::grid(11, 9), slanted),
        shapes::non_manifold_fan(5),
        shapes::bowtie(),
    ]
}

#[test]
fn the_energy_of_a_step_is_the_quadratic_form_of_the_dense_matrix() {
    let mut compared = 0;
    for (number, drawn) in sound().into_iter().enumerate() {
        for order in BilaplacianOrder::ALL {
            for (stretching, bending) in [(0.0, 1.0), (300.0, 0.2), (5.0, 0.0)] {
                let mut options = Bilaplacian::default();
                (options.order, options.stretching, options.bending) = (order, stretching, bending);
                let mut scene = Scene::new(drawn.clone()).with_ends(true);
                // If stiffness varies, the thin plate does not consist of Laplacians: `plate` has its energy.
                if order != BilaplacianOrder::ThinPlate || bending == 0.0 {
                    for (vertex, stiffness) in scene.stiffness.iter_mut().enumerate() {
                        *stiffness = 0.5 + (vertex % 4) as f64;
                    }
                }
                scene.method = Method::from(options.clone());
                if bending == 0.0 {
                    // There is only stretching, so the order has no effect.
                    options.order = BilaplacianOrder::Membrane;
                }
                let bound = &mut scene.bind();
                let size = scene.diagonal();
                let targets: Vec<DAffine3> = (0..scene.handle_count)
                    .map(|handle| turned(scene.positions()[0], 0.6 + handle as f64, DVec3::X * 0.3 * size))
                    .collect();
                let solution = back_substitute(bound, &targets);
                let mut out = vec![DVec3::ZERO; solution.len()];
                let step = bound.step(&mut out).unwrap().energy;
                let dense = energy(&scene, &options, &solution);
                assert!(
                    (step - dense).abs() < 1e-6 * dense + 1e-12,
                    "{number} {options:?}: {step} {dense}"
                );
                // This holds for every shape that moves the vertices in a handle's reach.
                let shaken: Vec<DVec3> = solution
                    .iter()
                    .enumerate()
                    .map(|(v, d)| {
                        if *d == DVec3::ZERO {
                            *d
                        } else {
                            *d * (1.0 + 0.01 * (v % 7) as f64)
                        }
                    })
                    .collect();
                let (of_any, dense) = (bound.energy_of(&shaken).unwrap(), energy(&scene, &options, &shaken));
                assert!(
                    (of_any - dense).abs() < 1e-7 * dense + 1e-12,
                    "{number} {options:?}: {of_any} {dense}"
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 54);
}
