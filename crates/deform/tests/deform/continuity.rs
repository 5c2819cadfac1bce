//! The continuity with which the bi-Laplacian joins constrained vertices, boundary by boundary.

use glam::DVec3;
use pliant_deform::{BilaplacianOrder, BindError, METHODS, Method, OptionValue, Role};
use pliant_mesh::shapes;

use crate::bilaplacian::of_order;
use crate::rig::{Scene, apart, back_substitute, settle, step, turned};
use crate::strip::{heights, largest_error};

/// Heights along a unit strip that joins the fixed end with the continuity `near` and the lifted one with `far`, from
/// the last held row to the first lifted one, and their pitch.
fn strip(cells: usize, order: BilaplacianOrder, near: f64, far: f64) -> (Vec<f64>, f64) {
    let continuity = |p: &DVec3| if p.x < 0.5 { near } else { far };
    heights(cells, of_order(order), |scene| {
        scene.continuity = scene.positions().iter().map(continuity).collect();
    })
}

type Polynomial = fn(f64) -> f64;

/// Order, continuity at the fixed end and at the lifted one, and the beam's polynomial with these ends.
const BEAMS: [(BilaplacianOrder, f64, f64, Polynomial); 9] = [
    (BilaplacianOrder::ThinPlate, 0.0, 0.0, |s| s),
    (BilaplacianOrder::ThinPlate, 0.0, 1.0, |s| 0.5 * s * (3.0 - s * s)),
    (BilaplacianOrder::ThinPlate, 1.0, 0.0, |s| 0.5 * s * s * (3.0 - s)),
    (BilaplacianOrder::ThinPlate, 2.0, 1.0, |s| s * s * (3.0 - 2.0 * s)),
    (BilaplacianOrder::CurvatureVariation, 2.0, 2.0, |s| {
        s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
    }),
    (BilaplacianOrder::CurvatureVariation, 1.0, 2.0, |s| {
        s * s * (10.0 - 15.0 * s * s + 8.0 * s * s * s) / 3.0
    }),
    (BilaplacianOrder::CurvatureVariation, 0.0, 2.0, |s| {
        s * (15.0 - 10.0 * s * s + 3.0 * s * s * s * s) / 8.0
    }),
    (BilaplacianOrder::CurvatureVariation, 1.0, 1.0, |s| {
        0.5 * s * s * (5.0 - 5.0 * s * s + 2.0 * s * s * s)
    }),
    (BilaplacianOrder::CurvatureVariation, 0.0, 0.0, |s| s),
];

#[test]
fn strips_converge_to_the_beams_with_these_ends() {
    for (order, near, far, exact) in BEAMS {
        let errors = [16, 32, 64].map(|cells| {
            let (heights, pitch) = strip(cells, order, near, far);
            largest_error(&heights, pitch, exact)
        });
        let falls = errors[2] < 1e-6 || (errors[1] < 0.65 * errors[0] && errors[2] < 0.65 * errors[1]);
        assert!(errors[2] < 0.04 && falls, "{order:?} {near} {far}: {errors:?}");
    }
}

#[test]
fn the_surface_joins_with_the_continuity_that_was_asked_for_and_no_more() {
    for (order, near, far) in BEAMS.map(|(order, near, far, _)| (order, near, far)) {
        let ends = [16, 32, 64].map(|cells| {
            let (z, pitch) = strip(cells, order, near, far);
            let turned: Vec<f64> = z.iter().rev().map(|z| 1.0 - z).collect();
            // The held part is flat: the k-th derivative's jump is its value there, by one-sided differences.
            [z, turned].map(|z| {
                [
                    z[0],
                    (z[1] - z[0]) / pitch,
                    (z[2] - 2.0 * z[1] + z[0]) / (pitch * pitch),
                ]
            })
        });
        for (end, continuity) in [near, far].into_iter().enumerate() {
            let kept = (continuity as usize).min(order.number() as usize - 1);
            for derivative in 0..=kept {
                let [a, b, c] = ends.map(|end_jumps| end_jumps[end][derivative].abs());
                assert!(
                    c < 1e-9 || (b < 0.75 * a && c < 0.75 * b),
                    "{order:?} {near} {far} {derivative}: {a} {b} {c}"
                );
            }
            // The next derivative jumps: a slope at a hinge, a curvature at an end that only keeps the tangents.
            if kept < 2 {
                let jump = ends.map(|end_jumps| end_jumps[end][kept + 1].abs());
                assert!(
                    jump[2] > 0.5 && (jump[2] / jump[1] - 1.0).abs() < 0.2,
                    "{order:?} {near} {far}: {jump:?}"
                );
            }
        }
    }
}

#[test]
fn a_hinge_with_a_spring_turns_as_far_at_every_resolution() {
    for (order, whole) in [
        (BilaplacianOrder::ThinPlate, 0.0),
        (BilaplacianOrder::CurvatureVariation, 1.0),
    ] {
        let mut last = f64::INFINITY;
        for share in [0.0, 0.3, 0.6, 0.9, 1.0] {
            let jump = [24, 48, 96].map(|cells| {
                let (z, pitch) = strip(cells, order, whole + share, 2.0);
                if whole == 0.0 {
                    (z[1] - z[0]) / pitch
                } else {
                    (z[2] - 2.0 * z[1] + z[0]) / (pitch * pitch)
                }
            });
            assert!(jump[2] < last, "{order:?} {share}: {jump:?}");
            last = jump[2];
            if share < 1.0 {
                assert!((jump[2] / jump[1] - 1.0).abs() < 0.15, "{order:?} {share}: {jump:?}");
            }
        }
    }
}

#[test]
fn full_continuity_changes_nothing_and_every_class_binds_with_any() {
    for (name, drawn) in shapes::classes() {
        for order in [BilaplacianOrder::ThinPlate, BilaplacianOrder::CurvatureVariation] {
            for fixed in [true, false] {
                let mut scene = Scene::new(drawn.clone()).with_ends(fixed);
                scene.method = of_order(order);
                let targets = vec![turned(scene.positions()[0], 0.7, DVec3::X); scene.handle_count];
                let Ok(mut plain) = scene.try_bind() else { continue };
                let plain = step(&mut plain, &targets);
                scene.continuity = vec![2.0; scene.roles.len()];
                let full = scene.moved(&targets);
                assert!(
                    apart(&plain, &full) < 1e-9 * scene.diagonal(),
                    "{name} {order:?} {}",
                    apart(&plain, &full)
                );
                scene.continuity = (0..scene.roles.len()).map(|vertex| (vertex % 5) as f64 / 2.0).collect();
                match scene.try_bind() {
                    Ok(mut bound) => {
                        let by_bases = step(&mut bound, &targets);
                        let size = by_bases.iter().map(|d| d.length()).fold(0.0, f64::max);
                        let by_solving = back_substitute(&mut bound, &targets);
                        assert!(apart(&by_bases, &by_solving) < 2e-6 * size, "{name} {order:?}");
                    }
                    Err(error) => {
                        assert!(error.vertex().is_some(), "{name}: {error}");
                        assert_eq!(order, BilaplacianOrder::CurvatureVariation, "{name}: {error}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_continuity_out_of_range_is_refused() {
    for value in [-0.1, 2.1, f64::NAN] {
        let mut scene = Scene::new(shapes::grid(4, 4)).with_ends(true);
        scene.continuity = vec![1.0; scene.roles.len()];
        scene.continuity[3] = value;
        assert!(matches!(scene.try_bind(), Err(BindError::Continuity { vertex: 3, .. })));
    }
}

#[test]
fn continuity_changes_what_the_methods_do_that_have_it_and_nothing_else() {
    let bent = |method: &Method, continuity: f64| {
        let mut scene = Scene::new(shapes::tube(8, 14, 5.0))
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 4.5);
        scene.method = method.clone();
        scene.continuity = vec![continuity; scene.positions().len()];
        settle(&mut scene.bind(), &[turned(DVec3::ZERO, 0.7, DVec3::Y)]).0
    };
    let membrane = Method::from_name("bilaplacian").unwrap();
    let membrane = membrane.with([("order", OptionValue::Whole(1))]).unwrap();
    let every = METHODS.iter().map(|method| (method.default)());
    for method in every.chain([membrane]) {
        let difference = apart(&bent(&method, 0.0), &bent(&method, 2.0));
        let is_changed = difference > 1e-3;
        assert_eq!(is_changed, method.has_continuity(), "{} {difference}", method.name());
    }
}
