//! The laws of flow, on classes of surfaces.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may panic, and tells its figures"
)]

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::Budget;
use pliant_flow::{Advection, Flow, FlowError, FlowSettings};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, shapes};

const STEP: f64 = 1.0 / 60.0;

/// The small shapes of all classes, and sheets of slivers.
fn classes() -> Vec<(&'static str, Drawn)> {
    let mut classes = shapes::classes();
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1e-3, 1.0));
    classes.push(("slivers", shapes::moved(&shapes::grid(12, 12), flat)));
    let thin = DAffine3::from_scale(DVec3::new(1.0, 1.0, 1e-4));
    classes.push(("closed slivers", shapes::moved(&shapes::icosphere(3), thin)));
    classes
}

fn flow(model: &Model) -> Flow<'_> {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    Flow::bind(&model.surface, &model.topology, Budget::default(), &progress, &cancel).unwrap()
}

fn steps(flow: &mut Flow<'_>, count: usize, settings: &FlowSettings) {
    for _ in 0..count {
        flow.step(STEP, settings, &Cancel::new()).unwrap();
    }
}

fn everywhere(model: &Model) -> Vec<f64> {
    vec![1.0; model.surface.positions.len()]
}

/// The vertices at which `is_inside` holds, as amounts.
fn amounts(model: &Model, is_inside: impl Fn(DVec3) -> bool) -> Vec<f64> {
    let of = |p: &DVec3| f64::from(u8::from(is_inside(*p)));
    model.surface.positions.iter().map(of).collect()
}

/// A field with swirls and divergence, of about the speed of the shape's size a second.
fn wild(model: &Model) -> impl Fn(DVec3) -> DVec3 + Sync {
    let bounds = pliant_mesh::bounding_box(&model.surface.positions).unwrap();
    let (middle, size) = (bounds.centre(), bounds.diagonal());
    move |p: DVec3| {
        let q = (p - middle) * (9.0 / size);
        size * DVec3::new(
            (q.y * 1.3 + 0.2).sin(),
            (q.z - q.x * 0.7).cos(),
            (q.x * 1.1 + q.y).sin(),
        )
    }
}

/// Flow by a wild field, with dye on one side.
fn wild_flow(model: &Model) -> Flow<'_> {
    let mut flow = flow(model);
    flow.add_velocity(&everywhere(model), wild(model));
    let middle = pliant_mesh::bounding_box(&model.surface.positions).unwrap().centre();
    flow.pour(&amounts(model, |p| p.x > middle.x), [0.9, 0.2, 0.1]);
    flow
}

fn norm(field: &[DVec3]) -> f64 {
    field.iter().map(|v| v.length_squared()).sum::<f64>().sqrt()
}

/// How far two fields differ, relative to the first one. Triangles of the shapes it is used on are about equal.
fn change(from: &[DVec3], to: &[DVec3]) -> f64 {
    let differences: Vec<DVec3> = from.iter().zip(to).map(|(a, b)| *a - *b).collect();
    norm(&differences) / norm(from)
}

/// The root of the integral of the squared speed.
fn speed(flow: &Flow<'_>) -> f64 {
    (2.0 * flow.kinetic_energy()).sqrt()
}

#[test]
fn no_divergence_is_left_after_projection() {
    for (name, drawn) in classes() {
        let model = shapes::model(drawn);
        let mut flow = wild_flow(&model);
        let unit = speed(&flow) / flow.mean_edge();
        assert!(flow.divergence() > 1e-6 * unit, "{name}: it diverges before");
        flow.project().unwrap();
        let left = flow.divergence() / unit;
        println!("{name}: {left:.1e}");
        assert!(left < 1e-9, "{name}: {left:e}");
        steps(&mut flow, 3, &FlowSettings::default());
        let left = flow.divergence() / unit;
        assert!(left < 1e-9, "{name}, after steps: {left:e}");
    }
}

#[test]
fn a_gradient_is_projected_to_zero() {
    // The tangential part of a constant is the gradient of a coordinate.
    for (name, drawn) in classes() {
        let model = shapes::model(drawn);
        let mut flow = flow(&model);
        flow.add_velocity(&everywhere(&model), |_| DVec3::new(0.3, -0.8, 0.5));
        let before = flow.kinetic_energy();
        flow.project().unwrap();
        let left = (flow.kinetic_energy() / before).sqrt();
        println!("{name}: {left:.1e}");
        assert!(left < 1e-7, "{name}: {left:e}");
    }
}

#[test]
fn a_projected_velocity_stays_as_it_is() {
    for (name, drawn) in classes() {
        let model = shapes::model(drawn);
        let mut flow = wild_flow(&model);
        let given = flow.velocities();
        flow.project().unwrap();
        let first = flow.velocities();
        flow.project().unwrap();
        let changed = change(&first, &flow.velocities()) * norm(&first) / norm(&given);
        assert!(changed < 1e-9, "{name}: {changed:e}");
    }
}

#[test]
fn a_turning_sphere_keeps_turning_and_its_dye_comes_round() {
    let model = shapes::model(shapes::icosphere(4));
    let edge = model.surface.positions[0]
        .distance(model.surface.positions[model.topology.neighbours(pliant_mesh::SurfaceVertex(0))[0].index()]);
    for axis in [DVec3::Z, DVec3::new(1.0, 2.0, -0.5).normalize()] {
        let mut flow = flow(&model);
        flow.add_velocity(&everywhere(&model), |p| axis.cross(p));
        flow.project().unwrap();
        let start = axis.any_orthonormal_vector();
        flow.pour(&amounts(&model, |p| p.distance(start) < 0.4), [0.0, 0.0, 1.0]);
        let before = flow.velocities();
        steps(&mut flow, 200, &FlowSettings::default());
        let changed = change(&before, &flow.velocities());
        let middle: DVec3 = model
            .surface
            .positions
            .iter()
            .zip(flow.dyes())
            .map(|(p, dye)| *p * dye[3])
            .sum();
        let wanted = DQuat::from_axis_angle(axis, 200.0 * STEP) * start;
        let missed = middle.normalize().distance(wanted);
        println!("changed {changed:.4}, missed {missed:.4} of edge {edge:.4}");
        assert!(changed < 0.02, "{changed}");
        assert!(missed < 2.0 * edge, "{missed}, edge {edge}");
    }
}

#[test]
fn the_integral_of_dye_is_kept() {
    let finer = || [("finer sphere", shapes::icosphere(3))].into_iter();
    let by_second = classes()
        .into_iter()
        .chain(finer())
        .map(|class| (class, Advection::SecondOrder));
    for ((name, drawn), advection) in by_second.chain(finer().map(|class| (class, Advection::FirstOrder))) {
        let model = shapes::model(drawn);
        let mut flow = wild_flow(&model);
        let before = flow.dye_integral();
        let settings = FlowSettings {
            advection,
            ..FlowSettings::default()
        };
        let mut worst: f64 = 0.0;
        for _ in 0..500 {
            steps(&mut flow, 1, &settings);
            let off = |k: usize| (flow.dye_integral()[k] - before[k]).abs() / before[k];
            worst = (0..4).map(off).fold(worst, f64::max);
        }
        println!("{name}: {worst:.1e}");
        assert!(worst < 0.01, "{name}: {worst}");
        let dyes = flow.dyes();
        let is_dye = |dye: &[f64; 4]| dye.iter().all(|value| (-1e-12..=1.0 + 1e-12).contains(value));
        assert!(dyes.iter().all(is_dye), "{name}: no new extremes");
    }
}

#[test]
fn a_rotated_problem_has_the_rotated_result() {
    let rotation = DQuat::from_axis_angle(DVec3::new(0.4, -0.3, 0.8).normalize(), 1.1);
    for drawn in [
        shapes::torus(24, 12),
        shapes::uv_sphere(11, 17),
        shapes::tube(12, 9, 2.0),
    ] {
        let run = |turn: DQuat| {
            let model = shapes::model(shapes::moved(&drawn, DAffine3::from_quat(turn)));
            let back = turn.inverse();
            let mut flow = flow(&model);
            let field = |p: DVec3| DVec3::new((p.y * 2.3).sin(), (p.z - p.x).cos(), (p.x * 1.7 + p.y).sin());
            flow.add_velocity(&everywhere(&model), |p| turn * field(back * p));
            flow.pour(&amounts(&model, |p| (back * p).x > 0.123), [0.9, 0.2, 0.1]);
            let settings = FlowSettings {
                gravity: turn * DVec3::new(0.1, 0.2, -2.0),
                viscosity: 0.001,
                confinement: 0.5,
                ..FlowSettings::default()
            };
            steps(&mut flow, 20, &settings);
            let of_surface = flow.dyes();
            // By the numbers of the file: a turned surface has another order.
            let dyes: Vec<[f64; 4]> = (0..model.drawn.vertex_count() as u32)
                .map(|v| of_surface[model.drawn.surface_vertex(DrawnVertex(v)).unwrap().index()])
                .collect();
            (flow.kinetic_energy(), dyes)
        };
        let (still, turned) = (run(DQuat::IDENTITY), run(rotation));
        let worst = |k: usize| {
            still
                .1
                .iter()
                .zip(&turned.1)
                .map(|(a, b)| (a[k] - b[k]).abs())
                .fold(0.0, f64::max)
        };
        let worst = (0..4).map(worst).fold(0.0, f64::max);
        let energy = (still.0 - turned.0).abs() / still.0;
        println!("dye {worst:.1e}, energy {energy:.1e}");
        assert!(worst < 1e-6 && energy < 1e-6, "dye {worst:e}, energy {energy:e}");
    }
}

#[test]
fn a_torus_keeps_its_harmonic_flows() {
    let model = shapes::model(shapes::torus(64, 32));
    let ring = |p: DVec3| DVec3::new(p.x, p.y, 0.0).length();
    let around = |p: DVec3| DVec3::Z.cross(p) / (ring(p) * ring(p));
    let across = |p: DVec3| {
        let out = DVec3::new(p.x, p.y, 0.0) / ring(p);
        let from_middle = p - out;
        // Around the tube, with the same flow through each parallel.
        out.cross(DVec3::Z).cross(from_middle) / (ring(p) * from_middle.length())
    };
    let fields: [(&str, &(dyn Fn(DVec3) -> DVec3 + Sync)); 2] = [("around", &around), ("across", &across)];
    for (name, field) in fields {
        let mut flow = flow(&model);
        flow.add_velocity(&everywhere(&model), field);
        let given = flow.velocities();
        flow.project().unwrap();
        let projected = flow.velocities();
        let by_projection = change(&given, &projected);
        steps(&mut flow, 200, &FlowSettings::default());
        let by_steps = change(&projected, &flow.velocities());
        println!("{name}: projection {by_projection:.4}, steps {by_steps:.4}");
        assert!(by_projection < 0.02, "{name}: {by_projection}");
        assert!(by_steps < 0.02, "{name}: {by_steps}");
    }
}

#[test]
fn without_force_kinetic_energy_never_grows() {
    for (name, drawn) in classes() {
        for viscosity in [0.0, 0.01] {
            let model = shapes::model(drawn.clone());
            let mut flow = wild_flow(&model);
            let settings = FlowSettings {
                viscosity,
                ..FlowSettings::default()
            };
            flow.project().unwrap();
            let mut energy = flow.kinetic_energy();
            let first = energy;
            for step in 0..60 {
                steps(&mut flow, 1, &settings);
                let next = flow.kinetic_energy();
                assert!(
                    next <= energy * (1.0 + 1e-12),
                    "{name}, step {step}: {energy} to {next}"
                );
                energy = next;
            }
            println!("{name}, viscosity {viscosity}: {:.3} of the energy", energy / first);
        }
    }
}

#[test]
fn a_shear_slips_along_borders_and_viscosity_slows_it() {
    // Each parallel of a tube turns at a speed of its own.
    let model = shapes::model(shapes::tube(48, 24, 2.0));
    let mut flow = flow(&model);
    flow.add_velocity(&everywhere(&model), |p| DVec3::Z.cross(p) * (1.0 + 0.5 * p.z));
    flow.project().unwrap();
    let before = flow.velocities();
    steps(&mut flow, 100, &FlowSettings::default());
    let changed = change(&before, &flow.velocities());
    println!("changed {changed:.4}");
    assert!(changed < 0.02, "{changed}");
    let at_end = |flow: &Flow<'_>, top: bool| {
        let velocities = flow.velocities();
        let is_there = |t: &usize| {
            model
                .surface
                .corners(*t)
                .iter()
                .any(|p| if top { p.z > 1.99 } else { p.z < 0.01 })
        };
        let there: Vec<f64> = (0..velocities.len())
            .filter(is_there)
            .map(|t| velocities[t].length())
            .collect();
        there.iter().sum::<f64>() / there.len() as f64
    };
    assert!((at_end(&flow, true) - 2.0).abs() < 0.1 && (at_end(&flow, false) - 1.0).abs() < 0.1);
    let viscous = FlowSettings {
        viscosity: 0.5,
        ..FlowSettings::default()
    };
    steps(&mut flow, 100, &viscous);
    let difference = at_end(&flow, true) - at_end(&flow, false);
    println!("difference {difference:.4}");
    // The slowest mode of a difference along 2 decays by exp(−ν t (π / 2)²), but nothing slows the mean.
    assert!(difference > 0.05 && difference < 0.2, "{difference}");
}

#[test]
fn gravity_pulls_dye_down_and_nothing_else() {
    let model = shapes::model(shapes::icosphere(4));
    let settings = FlowSettings {
        gravity: DVec3::new(0.0, 0.0, -3.0),
        ..FlowSettings::default()
    };
    let mut clear = flow(&model);
    steps(&mut clear, 20, &settings);
    assert!(clear.kinetic_energy() < 1e-20);
    let mut flow = flow(&model);
    flow.pour(&amounts(&model, |p| p.distance(DVec3::X) < 0.5), [1.0, 1.0, 1.0]);
    let height = |flow: &Flow<'_>| -> f64 {
        let dyes = flow.dyes();
        let sum = |of: &dyn Fn(usize) -> f64| (0..dyes.len()).map(|v| dyes[v][3] * of(v)).sum::<f64>();
        sum(&|v| model.surface.positions[v].z) / sum(&|_| 1.0)
    };
    let mut last = height(&flow);
    for _ in 0..4 {
        steps(&mut flow, 15, &settings);
        let next = height(&flow);
        assert!(next < last, "{last} to {next}");
        last = next;
    }
    println!("height {last:.3}");
    assert!(last < -0.2, "{last}");
}

#[test]
fn confinement_keeps_swirls() {
    let model = shapes::model(shapes::icosphere(4));
    let energy = |confinement: f64| {
        let mut flow = wild_flow(&model);
        let settings = FlowSettings {
            confinement,
            ..FlowSettings::default()
        };
        steps(&mut flow, 60, &settings);
        flow.kinetic_energy()
    };
    let (without, with) = (energy(0.0), energy(2.0));
    println!("{without:.4} {with:.4}");
    assert!(with > 1.02 * without);
}

#[test]
fn components_are_apart() {
    let drawn = shapes::together(&[
        shapes::icosphere(2),
        shapes::moved(&shapes::torus(12, 8), DAffine3::from_translation(DVec3::X * 3.0)),
    ]);
    let model = shapes::model(drawn);
    let mut flow = flow(&model);
    flow.add_velocity(&amounts(&model, |p| p.x < 1.2), |p| DVec3::Z.cross(p));
    flow.pour(&amounts(&model, |p| p.x > 3.0), [1.0, 0.0, 0.0]);
    let dyes = flow.dyes();
    steps(&mut flow, 10, &FlowSettings::default());
    for (t, velocity) in flow.velocities().iter().enumerate() {
        let is_moved = model.surface.corners(t)[0].x < 1.2;
        assert_eq!(*velocity != DVec3::ZERO, is_moved);
    }
    assert_eq!(flow.dyes(), dyes, "where nothing moves, dye stays to the bit");
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let shape = shapes::together(&[
        shapes::icosphere(4),
        shapes::moved(&shapes::grid(40, 40), DAffine3::from_translation(DVec3::X * 3.0)),
    ]);
    for drawn in [shapes::icosphere(5), shape] {
        let model = shapes::model(drawn);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut flow = wild_flow(&model);
                let settings = FlowSettings {
                    gravity: DVec3::NEG_Z,
                    viscosity: 0.001,
                    confinement: 1.0,
                    ..FlowSettings::default()
                };
                steps(&mut flow, 4, &settings);
                let dyes: Vec<u64> = flow.dyes().into_iter().flatten().map(f64::to_bits).collect();
                let speeds: Vec<u64> = flow
                    .velocities()
                    .iter()
                    .flat_map(|v| v.to_array())
                    .map(f64::to_bits)
                    .collect();
                (dyes, speeds)
            })
        };
        let one = run(1);
        assert!(run(2) == one);
        assert!(run(3) == one);
    }
}

#[test]
fn every_class_flows_without_numbers_that_are_none_even_fast() {
    for (name, drawn) in classes() {
        let model = shapes::model(drawn);
        let mut flow = wild_flow(&model);
        let field = wild(&model);
        flow.add_velocity(&everywhere(&model), |p| 50.0 * field(p));
        let settings = FlowSettings {
            gravity: DVec3::NEG_Y,
            viscosity: 1.0,
            confinement: 5.0,
            ..FlowSettings::default()
        };
        steps(&mut flow, 10, &settings);
        assert!(flow.velocities().iter().all(|v| v.is_finite()), "{name}");
        assert!(flow.dyes().iter().flatten().all(|value| value.is_finite()), "{name}");
        let is_cut = matches!(name, "non-manifold edge" | "non-manifold vertex" | "broken");
        assert!(is_cut || flow.cut_vertices() == 0, "{name}");
    }
}

#[test]
fn bad_input_is_refused_in_words() {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let points = shapes::model(Drawn::once(vec![DVec3::ZERO, DVec3::X], Vec::new()));
    let refused = Flow::bind(&points.surface, &points.topology, Budget::default(), &progress, &cancel).err();
    assert_eq!(refused, Some(FlowError::NoTriangles));
    let model = shapes::model(shapes::icosphere(3));
    let small = Budget {
        bytes: 1000,
        ..Budget::default()
    };
    let refused = Flow::bind(&model.surface, &model.topology, small, &progress, &cancel).err();
    assert_eq!(refused, Some(FlowError::Memory { vertices: 642 }));
    let mut fast = flow(&model);
    fast.add_velocity(&everywhere(&model), |p| DVec3::Z.cross(p) * 1e200);
    let refused = fast.step(STEP, &FlowSettings::default(), &cancel);
    assert_eq!(refused, Err(FlowError::NotFinite));
}

#[test]
fn a_raised_flag_ends_binding_and_steps() {
    let model = shapes::model(shapes::icosphere(3));
    for looks in 0..12 {
        let cancel = Cancel::after_looks(looks);
        let bound = Flow::bind(
            &model.surface,
            &model.topology,
            Budget::default(),
            &Progress::new(),
            &cancel,
        );
        match bound {
            Err(error) => assert!(matches!(error, FlowError::Cancelled(_)), "{error}"),
            Ok(mut flow) => {
                flow.add_velocity(&everywhere(&model), |p| DVec3::Z.cross(p));
                cancel.cancel();
                let stopped = flow.step(STEP, &FlowSettings::default(), &cancel);
                assert!(matches!(stopped, Err(FlowError::Cancelled(_))));
            }
        }
    }
}
