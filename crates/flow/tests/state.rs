//! A flow that goes back to a state, and the brushes that change it between two steps.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Budget;
use pliant_flow::{Flow, FlowSettings};
use pliant_mesh::{Cancel, Model, Progress, shapes};

fn bound(model: &Arc<Model>, displacements: Option<&[DVec3]>) -> Flow<'static> {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    Flow::bind_shape(model, displacements, Budget::default(), &progress, &cancel).unwrap()
}

fn stir(flow: &mut Flow<'_>, model: &Model) {
    let positions = &model.surface.positions;
    let dyed: Vec<f64> = positions.iter().map(|p| f64::from(u8::from(p.x > 0.2))).collect();
    flow.pour(&dyed, [0.8, 0.1, 0.4]);
    flow.add_velocity(&vec![1.0; positions.len()], |p| {
        DVec3::new(p.y, (3.0 * p.z).sin(), -p.x)
    });
}

fn steps(flow: &mut Flow<'_>, count: usize) {
    for _ in 0..count {
        flow.step(1.0 / 60.0, &FlowSettings::default(), &Cancel::new()).unwrap();
    }
}

#[test]
fn a_flow_that_is_taken_to_a_state_is_there_on_every_class_of_surface() {
    for (name, drawn) in shapes::classes() {
        let model = Arc::new(shapes::model(drawn));
        let (mut flow, mut other) = (bound(&model, None), bound(&model, None));
        stir(&mut flow, &model);
        steps(&mut flow, 2);
        let (velocities, dyes) = (flow.velocities(), flow.dyes());
        other.set_state(|triangle| velocities[triangle], |vertex| dyes[vertex]);
        assert_eq!(other.dyes(), dyes, "{name}");
        let fastest = velocities.iter().map(|v| v.length()).fold(0.0, f64::max);
        for (there, here) in other.velocities().iter().zip(&velocities) {
            assert!(there.distance(*here) <= 1e-12 * fastest, "{name}");
        }
        // Neither of them has flowed before, so they go on alike.
        let mut third = bound(&model, None);
        third.set_state(|triangle| velocities[triangle], |vertex| dyes[vertex]);
        steps(&mut other, 2);
        steps(&mut third, 2);
        assert_eq!(
            (other.velocities(), other.dyes()),
            (third.velocities(), third.dyes()),
            "{name}"
        );
    }
}

#[test]
fn a_bent_shape_flows_as_a_model_of_that_shape_to_the_bit() {
    let model = Arc::new(shapes::model(shapes::icosphere(3)));
    let bend: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .map(|p| DVec3::Y * (0.3 * p.x * p.x))
        .collect();
    let mut own = Model::clone(&model);
    let moved = own.surface.positions.iter_mut().zip(&bend);
    moved.for_each(|(position, displacement)| *position += *displacement);
    let own = Arc::new(own);
    let (mut bent, mut flow) = (bound(&model, Some(&bend)), bound(&own, None));
    stir(&mut bent, &own);
    stir(&mut flow, &own);
    steps(&mut bent, 3);
    steps(&mut flow, 3);
    assert_eq!((bent.velocities(), bent.dyes()), (flow.velocities(), flow.dyes()));
}

#[test]
fn a_push_sets_the_tangential_velocity_and_a_wash_takes_dye_away() {
    let model = Arc::new(shapes::model(shapes::icosphere(3)));
    let mut flow = bound(&model, None);
    stir(&mut flow, &model);
    let count = model.surface.positions.len();
    let before = flow.velocities();
    let towards = DVec3::new(1.0, 2.0, -0.5);
    flow.push(&vec![0.25; count], towards);
    for (triangle, (velocity, before)) in flow.velocities().iter().zip(&before).enumerate() {
        let normal = pliant_mesh::face_normal(model.surface.corners(triangle));
        let tangent = towards - normal * normal.dot(towards);
        assert!(velocity.distance(before.lerp(tangent, 0.25)) < 1e-12);
    }
    let dyes = flow.dyes();
    flow.clear(&vec![0.5; count]);
    for (after, before) in flow.dyes().iter().zip(&dyes) {
        assert_eq!(*after, before.map(|value| 0.5 * value));
    }
    // Half of it is what flows on from here.
    let poured = flow.dye_integral()[3];
    steps(&mut flow, 5);
    assert!((flow.dye_integral()[3] / poured - 1.0).abs() < 0.01);
}

#[test]
fn a_bare_point_keeps_its_dye() {
    let mut drawn = shapes::icosphere(2);
    drawn.positions.push(DVec3::new(5.0, 0.0, 0.0));
    let model = Arc::new(shapes::model(drawn));
    let bare = model.surface.positions.iter().position(|p| p.x > 4.0).unwrap();
    let mut flow = bound(&model, None);
    stir(&mut flow, &model);
    let before = flow.dyes();
    steps(&mut flow, 5);
    let after = flow.dyes();
    assert!(before[bare][3] == 1.0 && after[bare] == before[bare]);
    assert_ne!(after, before, "the rest flows");
}
