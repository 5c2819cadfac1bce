//! Laws of surfaces on which thousands of triangles share a vertex or an edge.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};
use pliant_deform::{Arap, ArapEnergy, Bilaplacian, BilaplacianOrder, BindError, Budget, Limit, Method, Primo, Role};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Progress, SurfaceVertex, shapes};

use crate::rig::{Scene, settle};

/// A cone: this many triangles around a tip.
pub fn fan(count: usize) -> Drawn {
    let around = |place: usize| {
        let (sin, cos) = (TAU * place as f64 / count as f64).sin_cos();
        DVec3::new(cos, sin, 0.0)
    };
    let mut positions: Vec<DVec3> = std::iter::once(DVec3::Z * 0.2).chain((0..count).map(around)).collect();
    let outside: Vec<DVec3> = positions[1..].iter().map(|p| *p * 1.5 - DVec3::Z * 0.1).collect();
    positions.extend(outside);
    let ring = move |ring: usize, place: usize| 1 + ring * count + place % count;
    let triangles = (0..count).flat_map(move |place| {
        let ([a, b], [c, d]) = ([0, 1].map(|k| ring(0, place + k)), [0, 1].map(|k| ring(1, place + k)));
        [[0, a, b], [a, c, b], [b, c, d]]
    });
    let triangles = triangles.map(|corners| corners.map(|v| DrawnVertex(v as u32)));
    Drawn::once(positions, triangles.collect())
}

/// The vertices with the largest x move, those with the least are fixed.
fn scene(drawn: Drawn, method: Method) -> Scene {
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.x < -0.8)
        .with(Role::Handle(0), |p| p.x > 0.8);
    scene.method = method;
    scene
}

fn bilaplacian(order: BilaplacianOrder) -> Method {
    let mut options = Bilaplacian::default();
    options.order = order;
    options.into()
}

fn methods() -> Vec<Method> {
    let arap = |energy| {
        let mut arap = Arap::default();
        arap.energy = energy;
        arap.coarse_above = 500;
        arap.into()
    };
    let energies = [ArapEnergy::Spokes, ArapEnergy::SpokesAndRims, ArapEnergy::Smooth];
    let mut methods: Vec<Method> = BilaplacianOrder::ALL.into_iter().map(bilaplacian).collect();
    methods.extend(energies.map(arap));
    methods.push(Primo::default().into());
    methods
}

#[test]
fn every_method_s_factor_grows_as_a_crowded_vertex_or_edge_does() {
    for (name, drawn) in [
        ("vertex", fan as fn(usize) -> Drawn),
        ("edge", shapes::non_manifold_fan),
    ] {
        for method in methods() {
            let [once, twice] = [800, 1600].map(|count| scene(drawn(count), method.clone()).bind().factor_len());
            assert!(twice < 3 * once, "{name}, {method:?}: {once} {twice}");
        }
    }
}

#[test]
fn a_crowded_surface_bends_by_every_method() {
    for drawn in [fan(800), shapes::non_manifold_fan(800)] {
        for method in methods() {
            let scene = scene(drawn.clone(), method.clone());
            let target = DAffine3::from_translation(DVec3::new(0.0, 0.1, 0.3)) * DAffine3::from_rotation_y(-0.3);
            let (shape, _) = settle(&mut scene.bind(), &[target]);
            let largest = shape.iter().map(|d| d.length()).fold(0.0, f64::max);
            assert!(largest > 0.2 && largest < 2.0, "{method:?}: {largest}");
        }
    }
}

#[test]
fn a_surface_that_nothing_holds_moves_rigidly_with_its_handle_around_hubs_too() {
    let shift = DVec3::new(0.3, -0.2, 0.5);
    for order in BilaplacianOrder::ALL {
        let mut scene = Scene::new(fan(800)).with(Role::Handle(0), |p| p.x > 0.8);
        scene.method = bilaplacian(order);
        for d in scene.moved(&[DAffine3::from_translation(shift)]) {
            assert!(d.distance(shift) < 1e-9, "{order:?}: {d}");
        }
    }
}

#[test]
fn what_exceeds_the_budget_is_refused_in_words_that_name_the_crowded_vertex() {
    for method in methods() {
        let scene = scene(fan(800), method.clone());
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let ordering = method.ordering(&scene.model.topology, &progress, &cancel).unwrap();
        let bind = |bytes| {
            let problem = scene.problem(&method);
            let budget = Budget {
                bytes,
                ..Budget::default()
            };
            problem.bind_within(ordering.as_ref(), budget, &progress, &cancel)
        };
        let refused = bind(100_000).err();
        let Some(BindError::Budget {
            crowded: Some(crowded),
            limit: Limit::Bytes(100_000),
            ..
        }) = refused
        else {
            unreachable!("{method:?}: {refused:?}")
        };
        let ring = scene.model.topology.neighbours(SurfaceVertex(crowded.vertex));
        assert_eq!((ring.len(), crowded.neighbours), (800, 800));
        let words = refused.unwrap().renumbered(|_| 77).to_string();
        assert!(words.contains("vertex 77, which has 800 neighbours"), "{words}");
        assert!(bind(1 << 30).is_ok(), "{method:?}");
        // A handle at each vertex is too much for any method.
        let refused = bind(100).err();
        assert!(
            matches!(refused, Some(BindError::Handles { handle_count: 1, .. })),
            "{refused:?}"
        );
    }
}

#[test]
fn operations_beyond_a_surface_s_are_refused_in_words_and_those_of_a_surface_never() {
    for method in methods() {
        let bound = |drawn: Drawn, operations: u64| {
            let mut scene = Scene::new(drawn)
                .with(Role::Fixed, |p| p.x < 0.1)
                .with(Role::Handle(0), |p| p.x > 0.9);
            scene.method = method.clone();
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let ordering = method.ordering(&scene.model.topology, &progress, &cancel).unwrap();
            let budget = Budget {
                operations,
                ..Budget::default()
            };
            let bound = scene
                .problem(&method)
                .bind_within(ordering.as_ref(), budget, &progress, &cancel);
            bound.map(|bound| bound.factor_len())
        };
        for surface in [shapes::grid(60, 60), shapes::grid(900, 2), shapes::torus(60, 40)] {
            assert!(bound(surface, 0).is_ok(), "{method:?}");
        }
        // Prisms are joined along edges, and these are still the sheet's.
        if method.options::<Primo>().is_some() {
            continue;
        }
        let refused = bound(shapes::tangle(170), 1_000_000).unwrap_err();
        let is_for_operations = matches!(
            refused,
            BindError::Budget {
                limit: Limit::Operations(_),
                ..
            }
        );
        let words = refused.to_string();
        assert!(
            is_for_operations && words.contains("operations allowed"),
            "{method:?}: {words}"
        );
        assert!(words.contains("make the region smaller"), "{words}");
    }
}

#[test]
fn an_energy_beyond_all_numbers_is_refused_by_every_method() {
    for mut method in methods() {
        if let Some(arap) = method.options::<Arap>() {
            let mut arap = arap.clone();
            arap.coarse_above = usize::MAX;
            method = arap.into();
        }
        let scene = scene(shapes::grid(8, 8), method.clone());
        let bound = &mut scene.bind();
        let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
        for far in [1e170, 1e300] {
            let turn = DAffine3::from_rotation_z(1.0);
            bound
                .set_targets(&[DAffine3::from_translation(DVec3::splat(far)) * turn])
                .unwrap();
            let step = bound.step(&mut displacements);
            assert!(step.is_err(), "{method:?} {far:e}: {step:?}");
            assert!(displacements.iter().all(|d| *d == DVec3::ZERO));
            // It continues from there.
            bound
                .set_targets(&[DAffine3::from_translation(DVec3::X * 0.1)])
                .unwrap();
            let step = bound.step(&mut displacements).unwrap();
            assert!(step.energy.is_finite(), "{method:?}");
        }
    }
}

#[test]
fn a_strip_too_long_for_its_order_is_refused_at_once_and_a_lower_order_bends_it() {
    // It is held at both ends.
    let long = |order, cells| {
        let mut scene = Scene::new(shapes::grid(cells, 1))
            .with(Role::Fixed, |p| p.x < 1e-6)
            .with(Role::Handle(0), |p| p.x > 1.0 - 1e-6);
        scene.method = bilaplacian(order);
        scene
    };
    let of_three = long(BilaplacianOrder::CurvatureVariation, 21_000).try_bind().err();
    let Some(BindError::Slender {
        edges, order: Some(3), ..
    }) = of_three
    else {
        unreachable!("{of_three:?}")
    };
    assert!((10_000..10_600).contains(&edges), "{edges}");
    assert!(long(BilaplacianOrder::Membrane, 21_000).try_bind().is_ok());
    let of_two = long(BilaplacianOrder::ThinPlate, 210_000).try_bind().err();
    let Some(BindError::Slender {
        edges, order: Some(2), ..
    }) = of_two
    else {
        unreachable!("{of_two:?}")
    };
    assert!((100_000..106_000).contains(&edges), "{edges}");
    // Coupled prisms fail to converge on much shorter ones.
    let prisms = |cells| {
        let mut scene = long(BilaplacianOrder::Membrane, cells);
        scene.method = Primo::default().into();
        scene.try_bind()
    };
    let Some(BindError::Slender { edges, order: None, .. }) = prisms(31_000).err() else {
        unreachable!("it is too long")
    };
    assert!((15_000..15_600).contains(&edges), "{edges}");
    assert!(prisms(20_000).is_ok());
}
