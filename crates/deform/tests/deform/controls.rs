//! The laws of cages and lattices that a person brings and moves by hand.

use std::sync::Arc;

use crate::cage::cage;
use crate::rig::{Scene, apart, settle, step, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{
    Attachment, AttachmentRefused, BindError, CageCoordinates, ControlLattice, ControlMesh, Method, OptionValue, Role,
    SolveError,
};
use pliant_mesh::shapes;

/// Every method with control points, by name for messages.
fn methods() -> Vec<(String, Method)> {
    let lattice = Method::from_name("lattice").unwrap();
    let bernstein = lattice.with([("basis", OptionValue::Name("bernstein"))]).unwrap();
    let cages = CageCoordinates::ALL.map(|coordinates| (format!("{coordinates:?}"), cage(coordinates)));
    [("lattice".to_owned(), lattice), ("bernstein".to_owned(), bernstein)]
        .into_iter()
        .chain(cages)
        .collect()
}

/// The scene with the cage or lattice that the method makes for it.
fn brought(mut scene: Scene) -> Scene {
    let bound = scene.bind();
    let (name, attachment) = bound.attachment().unwrap();
    scene.attachments = vec![(name, attachment.clone())];
    scene
}

fn sphere(method: &Method) -> Scene {
    let mut scene = Scene::new(shapes::icosphere(3));
    scene.method = method.clone();
    scene
}

/// A bar with a fixed end and a handle on the other.
fn bar(method: &Method) -> Scene {
    let mut scene = Scene::new(shapes::bar(20, 4, 4));
    scene.method = method.clone();
    let high = scene.model.bounds().unwrap().max.x;
    scene
        .with(Role::Fixed, |p| p.x < 0.1 * high)
        .with(Role::Handle(0), |p| p.x > 0.9 * high)
}

/// The control points' rest positions, and the same with those moved that pass a test.
fn moved(scene: &Scene, change: impl Fn(usize, DVec3) -> DVec3) -> Arc<Vec<DVec3>> {
    let rest = scene.method.control_rest(&scene.attachments[0].1);
    Arc::new(
        rest.iter()
            .enumerate()
            .map(|(number, point)| change(number, *point))
            .collect(),
    )
}

fn bent(number: usize, point: DVec3) -> DVec3 {
    let wave = (number as f64 * 1.7).sin();
    point + 0.2 * DVec3::new(wave, (0.5 + wave).cos(), wave * wave)
}

#[test]
fn control_points_moved_by_an_affine_map_move_everything_in_them_by_it() {
    let affine = DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    );
    let similar = turned(DVec3::X, 1.1, DVec3::Y) * DAffine3::from_scale(DVec3::splat(1.7));
    for (name, method) in methods() {
        let scene = brought(sphere(&method));
        // Green coordinates follow only similarities.
        let (map, most) = if name == "Green" {
            (similar, 1e-6)
        } else {
            (affine, 1e-9)
        };
        let mut bound = scene.bind();
        bound
            .set_controls(&moved(&scene, |_, p| map.transform_point3(p)))
            .unwrap();
        let displacements = step(&mut bound, &[]);
        let expected = scene.positions().iter().map(|p| map.transform_point3(*p) - *p);
        let error = apart(&displacements, &expected.collect::<Vec<_>>());
        assert!(error < most, "{name}: {error:e}");
        for jacobian in bound.jacobians().unwrap() {
            let expected = map.matrix3 - DMat3::IDENTITY;
            assert!(jacobian.as_dmat3().abs_diff_eq(expected, 1e-4), "{name}: {jacobian}");
        }
    }
}

#[test]
fn moved_there_and_back_everything_rests_to_the_bit_and_unmoved_the_handles_do_what_they_do_without() {
    for (name, method) in methods() {
        let plain = bar(&method);
        let target = [turned(plain.positions()[0], 0.4, DVec3::Y)];
        let (without, _) = settle(&mut plain.bind(), &target);
        let scene = brought(plain);
        let mut bound = scene.bind();
        assert_eq!(settle(&mut bound, &target).0, without, "{name}");
        bound.set_controls(&moved(&scene, bent)).unwrap();
        assert_ne!(settle(&mut bound, &target).0, without, "{name}");
        bound.set_controls(&moved(&scene, |_, p| p)).unwrap();
        // An iterative method continues from its last shape, and forgets that shape at rest.
        step(&mut bound, &[DAffine3::IDENTITY]);
        assert_eq!(settle(&mut bound, &target).0, without, "{name}");
        let rest = step(&mut bound, &[DAffine3::IDENTITY]);
        assert!(rest.iter().all(|d| *d == DVec3::ZERO), "{name}");
        assert!(
            bound.jacobians().unwrap().iter().all(|j| *j == glam::Mat3::ZERO),
            "{name}"
        );
        let rest = scene.method.control_rest(&scene.attachments[0].1);
        assert_eq!(bound.control_positions(), rest, "{name}");
    }
}

#[test]
fn what_is_fixed_stays_and_handles_are_met_beside_the_hand() {
    for (name, method) in methods() {
        let scene = brought(bar(&method));
        let mut bound = scene.bind();
        let missed = |bound: &mut pliant_deform::Bound, target: DAffine3| {
            let mut displacements = vec![DVec3::ZERO; scene.roles.len()];
            bound.set_targets(&[target]).unwrap();
            let step = bound.step(&mut displacements).unwrap();
            (step.handle_residual / scene.diagonal(), displacements)
        };
        let size = scene.diagonal();
        let places = moved(&scene, |number, p| match number % 5 {
            0 => p + DVec3::Z * 0.2 * size,
            _ => p,
        });
        let targets = [DAffine3::from_translation(DVec3::Y * 0.1 * size), DAffine3::IDENTITY];
        let alone = targets.map(|target| missed(&mut bound, target));
        bound.set_controls(&places).unwrap();
        for (target, (before, alone)) in targets.into_iter().zip(alone) {
            let (after, displacements) = missed(&mut bound, target);
            assert!(after < before + 0.01, "{name}: {before} {after}");
            let roles = scene.roles.iter().zip(&displacements);
            let mut fixed = roles.filter(|(role, _)| **role == Role::Fixed);
            assert!(fixed.all(|(_, d)| *d == DVec3::ZERO), "{name}");
            assert!(apart(&displacements, &alone) > 0.01 * size, "{name}");
        }
    }
}

#[test]
fn without_handles_control_points_are_where_the_hand_put_them() {
    for (name, method) in methods() {
        let high = Scene::new(shapes::bar(20, 4, 4)).model.bounds().unwrap().max.x;
        let mut scene = Scene::new(shapes::bar(20, 4, 4)).with(Role::Fixed, |p| p.x < 0.1 * high);
        scene.method = method;
        let scene = brought(scene);
        let places = moved(&scene, bent);
        let mut bound = scene.bind();
        bound.set_controls(&places).unwrap();
        let displacements = step(&mut bound, &[]);
        assert!(displacements.iter().any(|d| d.length() > 0.01), "{name}");
        let farthest = bound.control_positions();
        let farthest = farthest.iter().zip(places.iter()).map(|(a, b)| a.distance(*b));
        assert!(farthest.fold(0.0, f64::max) < 1e-12, "{name}");
        for (role, displacement) in scene.roles.iter().zip(&displacements) {
            assert!(*role != Role::Fixed || *displacement == DVec3::ZERO, "{name}");
        }
        // The positions may come with the binding too.
        let mut scene = scene;
        let (own, attachment) = &scene.attachments[0];
        scene.attachments = vec![(*own, attachment.with_moved(places))];
        assert_eq!(step(&mut scene.bind(), &[]), displacements, "{name}");
    }
}

#[test]
fn jacobians_are_the_derivative_with_moved_controls() {
    const STEP: f64 = 1e-5;
    for (name, method) in methods() {
        // Each vertex of the star is a small step along an axis from the middle one.
        let base = bar(&method);
        let probe = base
            .positions()
            .iter()
            .position(|p| (p.x - 0.5 * base.model.bounds().unwrap().max.x).abs() < 0.06 * base.diagonal())
            .unwrap();
        let at = |shift: DVec3| {
            let mut scene = bar(&method);
            scene.model.surface.positions[probe] += shift;
            scene
        };
        let attachment = brought(at(DVec3::ZERO)).attachments;
        let displaced = |shift: DVec3| {
            let mut scene = at(shift);
            scene.attachments = attachment.clone();
            let mut bound = scene.bind();
            bound.set_controls(&moved(&scene, bent)).unwrap();
            let mut displacements = vec![DVec3::ZERO; scene.roles.len()];
            bound.set_targets(&[turned(DVec3::ZERO, 0.3, DVec3::Y)]).unwrap();
            // One step: how many there are to the end may differ between two shapes that hardly do.
            bound.step(&mut displacements).unwrap();
            (displacements[probe], bound.jacobians().unwrap()[probe])
        };
        let jacobian = displaced(DVec3::ZERO).1.as_dmat3();
        for (axis, direction) in DVec3::AXES.into_iter().enumerate() {
            let ahead = displaced(direction * STEP).0;
            let behind = displaced(-direction * STEP).0;
            let difference = (ahead - behind) / (2.0 * STEP);
            let error = (difference - jacobian.col(axis)).length();
            assert!(
                error < 1e-3 * (1.0 + difference.length()),
                "{name} {axis}: {error} {difference}"
            );
        }
    }
}

/// A test's change of a cage's vertices and triangles.
type Change<'a> = &'a dyn Fn(&mut Vec<DVec3>, &mut Vec<[u32; 3]>);

fn refused(scene: &Scene) -> String {
    match scene.try_bind().unwrap_err() {
        error @ BindError::Attachment { .. } => error.to_string(),
        other => panic!("{other}"),
    }
}

#[test]
fn what_is_no_cage_around_the_region_is_refused_in_words() {
    let scene = brought(sphere(&cage(CageCoordinates::Harmonic)));
    let Attachment::Mesh(mesh) = scene.attachments[0].1.clone() else {
        panic!("a cage is a mesh");
    };
    let with = |change: Change<'_>| {
        let (mut rest, mut triangles) = (mesh.rest.to_vec(), mesh.triangles.to_vec());
        change(&mut rest, &mut triangles);
        let mut scene = sphere(&scene.method);
        scene.attachments = vec![(
            "cage",
            Attachment::Mesh(ControlMesh {
                moved: Arc::new(rest.clone()),
                rest: Arc::new(rest),
                triangles: Arc::new(triangles),
            }),
        )];
        scene
    };
    let count = mesh.rest.len() as u32;
    let cases: [(&str, Change<'_>); 8] = [
        ("is open at the edge", &|_, triangles| {
            triangles.truncate(triangles.len() - 1)
        }),
        ("more than two triangles at the edge", &|_, triangles| {
            triangles.extend([triangles[0], [triangles[0][0], triangles[0][2], triangles[0][1]]]);
        }),
        ("face different sides at the edge", &|_, triangles| {
            triangles[3].swap(0, 1)
        }),
        ("no area in its triangle 5", &|rest, triangles| {
            let [a, b, c] = triangles[5].map(|v| v as usize);
            rest[a] = 0.5 * (rest[b] + rest[c]);
        }),
        ("no finite position at its point 7", &|rest, _| rest[7].y = f64::NAN),
        ("no triangle at its vertex", &|rest, _| rest.push(DVec3::ONE)),
        ("but has", &|_, triangles| triangles[2][1] = count),
        ("outside, but harmonic coordinates", &|rest, _| {
            rest.iter_mut().for_each(|p| *p *= 0.5);
        }),
    ];
    for (sentence, change) in cases {
        let said = refused(&with(change));
        assert!(said.starts_with("the cage ") && said.contains(sentence), "{said}");
    }
    // Mean value coordinates are defined everywhere, and a cage that faces inward is turned.
    let mut small = with(&|rest, _| rest.iter_mut().for_each(|p| *p *= 0.5));
    small.method = cage(CageCoordinates::MeanValue);
    let warnings = small.bind().warnings().to_vec();
    let count = small.roles.len();
    assert!(
        warnings.iter().any(|w| w.contains("vertices lie outside the cage")),
        "{warnings:?} {count}"
    );
    let inward = with(&|_, triangles| triangles.iter_mut().for_each(|t| t.swap(0, 1)));
    let outward = with(&|_, _| {});
    let shift = |scene: &Scene| {
        let mut bound = scene.bind();
        bound.set_controls(&moved(scene, bent)).unwrap();
        step(&mut bound, &[])
    };
    assert!(apart(&shift(&inward), &shift(&outward)) < 1e-12);
}

#[test]
fn the_vertices_outside_a_cage_are_counted_one_by_one() {
    let mut scene = brought(sphere(&cage(CageCoordinates::Green)));
    let (_, Attachment::Mesh(mesh)) = &scene.attachments[0] else {
        panic!("a cage is a mesh");
    };
    // Moved aside, the cage leaves outside the points with a winding number of 0.
    let rest: Vec<DVec3> = mesh.rest.iter().map(|p| *p + DVec3::new(0.9, 0.05, 0.02)).collect();
    let winding = |point: &DVec3| {
        let angle = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| (rest[v as usize] - *point).normalize());
            2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
        };
        mesh.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
    };
    let expected = scene.positions().iter().filter(|point| winding(point) < 0.5).count();
    let triangles = Arc::clone(&mesh.triangles);
    scene.attachments[0].1 = Attachment::Mesh(ControlMesh {
        moved: Arc::new(rest.clone()),
        rest: Arc::new(rest),
        triangles,
    });
    let said = refused(&scene);
    assert!(
        expected > 0 && said.contains(&format!("leaves {expected} of")),
        "{expected}: {said}"
    );
}

#[test]
fn what_is_no_lattice_and_what_does_not_fit_the_binding_is_refused_in_words() {
    let scene = brought(sphere(&Method::from_name("lattice").unwrap()));
    let Attachment::Lattice(lattice) = scene.attachments[0].1.clone() else {
        panic!("a lattice is one");
    };
    let of = |lattice: ControlLattice| {
        let mut scene = sphere(&scene.method);
        scene.attachments = vec![("lattice", Attachment::Lattice(lattice))];
        refused(&scene)
    };
    let counts = ControlLattice {
        counts: [7, 3, 7],
        ..lattice.clone()
    };
    assert!(of(counts).contains("3 control points along y"));
    let flat = ControlLattice {
        high: lattice.low + DVec3::new(1.0, 1.0, 0.0),
        ..lattice.clone()
    };
    assert!(of(flat).contains("without extent along z"));
    let short = ControlLattice {
        moved: Arc::new(vec![DVec3::ZERO; 5]),
        ..lattice
    };
    assert!(of(short).contains("has 5 moved points, but 343 points"));
    let mut bound = scene.bind();
    let nowhere = bound.set_controls(&Arc::new(vec![DVec3::NAN; 343])).unwrap_err();
    assert!(matches!(
        nowhere,
        SolveError::Controls {
            refused: AttachmentRefused::NotFinite { point: 0 },
            ..
        }
    ));
    assert!(bound.set_controls(&Arc::new(Vec::new())).is_err());
    // A cage that the method made can be moved only after it was brought.
    let made = sphere(&scene.method).bind().set_controls(&moved(&scene, bent));
    assert_eq!(made, Err(SolveError::NoControls));
    // Another method ignores it.
    let mut other = sphere(&Method::from_name("rbf").unwrap()).with(Role::Handle(0), |p| p.z > 0.6);
    let without = other.moved(&[turned(DVec3::ZERO, 0.3, DVec3::X)]);
    other.attachments = scene.attachments;
    assert_eq!(other.moved(&[turned(DVec3::ZERO, 0.3, DVec3::X)]), without);
}

#[test]
fn a_lattice_bends_as_its_box_and_counts_say_whatever_the_resolution() {
    let coarse = Method::from_name("lattice").unwrap();
    let coarse = coarse.with([("resolution", OptionValue::Whole(2))]).unwrap();
    let mut scene = brought(sphere(&Method::from_name("lattice").unwrap()));
    let places = moved(&scene, bent);
    let shape = |scene: &Scene| {
        let mut bound = scene.bind();
        bound.set_controls(&places).unwrap();
        step(&mut bound, &[])
    };
    let expected = shape(&scene);
    scene.method = coarse;
    assert_eq!(shape(&scene), expected);
}

#[test]
fn a_person_begins_with_few_points_of_a_lattice_on_its_box() {
    let declaration = Method::from_name("lattice").unwrap().declaration();
    let method = (declaration.first_choice)();
    let scene = brought(sphere(&method));
    let rest = scene.method.control_rest(&scene.attachments[0].1);
    assert_eq!(rest.len(), 3 * 4 * 3);
    let bounds = scene.model.bounds().unwrap();
    let beyond = |p: &DVec3| (bounds.min - *p).max(*p - bounds.max).max_element();
    let farthest = rest.iter().map(beyond).fold(0.0, f64::max);
    assert!((0.0..=0.06 * bounds.diagonal()).contains(&farthest), "{farthest}");
}

#[test]
fn no_control_point_swings_far_beyond_a_handle_that_is_close_to_what_is_fixed() {
    let lattice = |norm| {
        let lattice = Method::from_name("lattice").unwrap();
        (norm, lattice.with([("norm", OptionValue::Name(norm))]).unwrap())
    };
    let fitted = [
        lattice("bending"),
        lattice("displacement"),
        ("mean-value", cage(CageCoordinates::MeanValue)),
        ("harmonic", cage(CageCoordinates::Harmonic)),
    ];
    for (name, method) in fitted {
        for side in [0.3, 0.6] {
            let mut scene = Scene::new(shapes::tube(24, 60, 8.0));
            scene.method = method.clone();
            let scene = scene
                .with(Role::Fixed, |p| p.z < 4.0)
                .with(Role::Handle(0), |p| (4.8..5.3).contains(&p.z) && p.x > side);
            let way = DVec3::new(0.3, 0.0, 0.4);
            let mut bound = scene.bind();
            let rest = bound.control_positions();
            let (displacements, _) = settle(&mut bound, &[DAffine3::from_translation(way)]);
            let swung = apart(&bound.control_positions(), &rest);
            assert!(swung <= 2.5 * way.length(), "{name} {side}: {swung}");
            let torn = displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
            assert!(torn <= 2.5 * way.length(), "{name} {side}: {torn}");
        }
    }
}
