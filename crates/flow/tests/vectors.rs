//! Results don't depend on the width of the processor's vectors.
//!
//! In a program of its own, because the choice of vectors is the whole process's.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use pliant_deform::Budget;
use pliant_flow::{Flow, FlowSettings};
use pliant_mesh::{Cancel, Progress, Vectors, shapes};

#[test]
fn a_flow_has_the_same_bits_with_all_vectors() {
    for drawn in [shapes::torus(40, 20), shapes::grid(30, 20)] {
        let model = shapes::model(drawn);
        let run = || {
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let mut flow = Flow::bind(&model.surface, &model.topology, Budget::default(), &progress, &cancel).unwrap();
            let dyed: Vec<f64> = model.surface.positions.iter().map(|p| p.x.clamp(0.0, 1.0)).collect();
            flow.pour(&dyed, [0.8, 0.1, 0.4]);
            flow.add_velocity(&vec![1.0; dyed.len()], |p| {
                DVec3::new(p.y, (3.0 * p.z).sin(), -p.x) * 2.0
            });
            for _ in 0..5 {
                flow.step(1.0 / 60.0, &FlowSettings::default(), &cancel).unwrap();
            }
            (flow.dyes(), flow.velocities())
        };
        let available: Vec<Vectors> = Vectors::ALL
            .into_iter()
            .filter(|vectors| vectors.is_available())
            .collect();
        let mut results = available.iter().map(|vectors| {
            assert!(vectors.choose());
            run()
        });
        let widest = results.next().unwrap();
        for result in results {
            assert!(result == widest, "the width of vectors changed a flow");
        }
    }
}
