//! The faults of a mesh are found, and their places.

#![allow(clippy::expect_used, reason = "a test that fails may panic")]

use glam::{DAffine3, DQuat, DVec3};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FindingKind, Inspection, Named, Progress, WeldOptions, shapes};

fn placed(drawn: &Drawn, scale: f64, by: DVec3) -> Drawn {
    shapes::moved(
        drawn,
        DAffine3::from_scale_rotation_translation(DVec3::splat(scale), DQuat::IDENTITY, by),
    )
}

fn turned_inside_out(mut drawn: Drawn) -> Drawn {
    drawn.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    drawn
}

#[test]
fn a_part_that_faces_inwards_is_found_and_a_cavity_is_none() {
    for far in [DVec3::ZERO, DVec3::new(4e6, 5e5, -3e6)] {
        let ball = |scale, x| placed(&shapes::icosphere(2), scale, DVec3::X * x + far);
        let count = |parts: &[Drawn]| {
            shapes::model(shapes::together(parts))
                .findings
                .inside_out_components
                .count
        };
        assert_eq!(count(&[ball(1.0, 0.0)]), 0);
        assert_eq!(count(&[turned_inside_out(ball(1.0, 0.0))]), 1);
        assert_eq!(count(&[ball(1.0, 0.0), turned_inside_out(ball(0.5, 0.0))]), 0, "hollow");
        assert_eq!(count(&[ball(1.0, 0.0), turned_inside_out(ball(0.5, 3.0))]), 1, "beside");
    }
    let open = shapes::model(turned_inside_out(shapes::grid(3, 3)));
    assert!(open.findings.inside_out_components.is_empty(), "a sheet has no inside");
}

#[test]
fn bits_beside_a_large_part_are_loose_and_equal_parts_are_not() {
    let bit = Drawn::once(
        vec![DVec3::X * 9.0, DVec3::X * 9.5, DVec3::Y * 9.0],
        vec![[0, 1, 2].map(DrawnVertex)],
    );
    let large = shapes::uv_sphere(20, 40);
    let first = large.positions.len() as u32;
    let model = shapes::model(shapes::together(&[large.clone(), bit]));
    assert_eq!(model.findings.loose_bits.examples, [first]);
    let two = shapes::together(&[placed(&large, 1.0, DVec3::X * 5.0), large]);
    assert!(shapes::model(two).findings.loose_bits.is_empty());
}

#[test]
fn borders_that_are_nearly_joined_are_told_and_a_distance_joins_them() {
    let sheet = shapes::grid(8, 8);
    let beside = |gap: f64| shapes::together(&[sheet.clone(), placed(&sheet, 1.0, DVec3::X * (1.0 + gap))]);
    let count = |drawn: Drawn, distance: Option<f64>| {
        let inspection = Inspection::of(drawn, &WeldOptions { distance }, &Progress::new(), &Cancel::new());
        inspection
            .expect("nobody cancels it")
            .findings
            .nearly_joined_vertices
            .count
    };
    for gap in [1e-3, 5e-3] {
        assert_eq!(count(beside(gap), None), 18, "both sides of the gap");
        assert_eq!(count(beside(gap), Some(0.01)), 0);
    }
    for gap in [0.0, 0.1] {
        assert_eq!(count(beside(gap), None), 0);
    }
    for (class, drawn) in shapes::classes() {
        assert_eq!(count(drawn, None), 0, "{class}");
    }
}

#[test]
fn specks_are_small_and_far_away_and_stand_outside_of_what_is_looked_at() {
    let ball = shapes::icosphere(4);
    let bit = |x: f64| placed(&shapes::bar(1, 1, 1), 0.01, DVec3::X * x);
    let model = shapes::model(shapes::together(&[ball.clone(), bit(1.5), bit(400.0)]));
    assert_eq!(model.specks(), [false, false, true]);
    let near = shapes::model(shapes::together(&[ball.clone(), bit(1.5)]));
    assert_eq!(model.bounds_without_specks(), near.bounds());
    let twins = shapes::model(shapes::together(&[ball.clone(), placed(&ball, 1.0, DVec3::X * 400.0)]));
    assert_eq!(twins.specks(), [false, false]);
    assert!(shapes::model(Drawn::default()).bounds_without_specks().is_none());
}

/// On every class of mesh, and on one with every fault: each reported fault has its place.
#[test]
fn every_example_stands_where_it_was_found() {
    let mut all: Vec<Drawn> = shapes::classes().into_iter().map(|(_, drawn)| drawn).collect();
    all.push(shapes::broken(&shapes::icosphere(1)));
    let mut seen = 0;
    for drawn in all {
        let model = shapes::model(drawn);
        let (located_findings, rest) = (model.located_findings(), model.rest());
        let sentences: Vec<String> = located_findings
            .iter()
            .map(|finding| finding.sentence.clone())
            .collect();
        assert_eq!(sentences, model.findings.sentences());
        for finding in &located_findings {
            assert_eq!(finding.count, model.findings.of(finding.kind).count);
            assert_eq!(finding.examples.len(), model.findings.of(finding.kind).examples.len());
            for example in &finding.examples {
                seen += 1;
                match (finding.kind, finding.kind.named(), example.position) {
                    (FindingKind::NonFiniteVertices | FindingKind::NonFiniteTriangles, _, place) => {
                        assert_eq!(place, None);
                    }
                    (_, Named::FileVertex, place) => {
                        assert_eq!(place, Some(rest.positions[example.number as usize]));
                    }
                    (_, Named::DrawnTriangle, place) => {
                        let corners = rest.triangles[example.number as usize];
                        let corners = corners.map(|v| rest.positions[v.index()]);
                        assert_eq!(place, Some(corners.iter().sum::<DVec3>() / 3.0));
                    }
                }
            }
        }
    }
    assert!(seen > 10);
}

#[test]
fn a_look_finds_what_welding_finds() {
    let mut all: Vec<Drawn> = shapes::classes().into_iter().map(|(_, drawn)| drawn).collect();
    all.push(shapes::broken(&shapes::icosphere(1)));
    all.push(Drawn::default());
    for drawn in all {
        let model = shapes::model(drawn.clone());
        let inspection = Inspection::of(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new());
        let inspection = inspection.expect("nobody cancels it");
        assert_eq!(inspection.findings, model.findings);
        assert_eq!(inspection.located_findings, model.located_findings());
        // Bare points, which have no face, are counted separately.
        let with_faces = model.topology.components().iter().filter(|part| part.face_count > 0);
        assert_eq!(inspection.components, with_faces.cloned().collect::<Vec<_>>());
        assert_eq!(inspection.bounds, model.bounds());
        let counts = [model.surface.positions.len(), model.surface.triangles.len()];
        assert_eq!([inspection.surface_vertices, inspection.surface_triangles], counts);
        let drawn = &model.drawn;
        let counts = [drawn.file_vertex_count(), drawn.vertex_count(), drawn.triangle_count()];
        assert_eq!(
            [
                inspection.file_vertices,
                inspection.drawn_vertices,
                inspection.drawn_triangles
            ],
            counts
        );
    }
}
