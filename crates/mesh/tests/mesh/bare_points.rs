//! Vertices that no triangle uses become bare points: solved and moved like others, beside an unchanged surface.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use glam::{DAffine3, DVec3};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Inspection, Model, Progress, WeldOptions, shapes};

fn points(positions: Vec<DVec3>) -> Drawn {
    Drawn::once(positions, Vec::new())
}

/// Points on a slanted line, none of which is a vertex of the unit shapes.
fn line(count: usize) -> Vec<DVec3> {
    (0..count)
        .map(|k| DVec3::new(0.2, 0.3, 0.4) + DVec3::new(0.1, -0.05, 0.02) * k as f64)
        .collect()
}

fn surface_shapes() -> Vec<(&'static str, Drawn)> {
    let apart = shapes::moved(&shapes::bar(2, 2, 2), DAffine3::from_translation(DVec3::X * 9.0));
    vec![
        ("closed", shapes::icosphere(2)),
        ("with border", shapes::grid(5, 4)),
        ("several parts", shapes::together(&[shapes::icosphere(2), apart])),
        ("non-manifold", shapes::non_manifold_fan(5)),
        ("broken", shapes::broken(&shapes::icosphere(1))),
        ("soup", shapes::soup(&shapes::uv_sphere(6, 8))),
    ]
}

#[test]
fn points_beside_a_surface_leave_it_as_it_is() {
    for (class, shape) in surface_shapes() {
        // One point is so far away that a common grid or tolerance would join vertices of the surface.
        let mut strays = line(20);
        strays.push(DVec3::splat(1e9));
        for order in [0, 1] {
            let mut parts = [shape.clone(), points(strays.clone())];
            parts.rotate_left(order);
            let (alone, beside) = (shapes::model(shape.clone()), shapes::model(shapes::together(&parts)));
            let first_bare = beside.topology.bare_points().start;
            assert_eq!(first_bare, alone.topology.bare_points().start, "{class}");
            assert_eq!(beside.surface.triangles, alone.surface.triangles, "{class}");
            assert_eq!(
                beside.surface.positions[..first_bare],
                alone.surface.positions[..first_bare],
                "{class}"
            );
            let extra = alone.topology.bare_points().len();
            assert_eq!(beside.topology.bare_points().len(), strays.len() + extra, "{class}");
            let count = alone.findings.components.count;
            assert_eq!(beside.findings.components.count, count, "{class}");
            assert_eq!(beside.findings.loose_bits.count, alone.findings.loose_bits.count);
            assert_eq!(beside.findings.inside_out_components.count, 0, "{class}");
            for part in 0..count {
                let faces = |model: &Model| model.topology.components()[part].face_count;
                assert_eq!(faces(&beside), faces(&alone), "{class}");
            }
            let stray_parts = &beside.topology.components()[count..];
            assert!(
                stray_parts
                    .iter()
                    .all(|part| (part.vertex_count, part.face_count) == (1, 0))
            );
            if extra == 0 {
                assert_eq!(beside.bounds(), alone.bounds(), "{class}");
            }
        }
    }
}

#[test]
fn equal_points_are_one_and_those_on_a_vertex_are_its_twins() {
    let shape = shapes::icosphere(2);
    let corner = shape.positions[7];
    let strays = vec![
        corner,
        corner + DVec3::X * 1e-9,
        DVec3::ZERO,
        DVec3::ZERO,
        DVec3::X * 1e-3,
    ];
    for order in [0, 1] {
        let mut parts = [points(strays.clone()), shape.clone()];
        parts.rotate_left(order);
        let first = if order == 0 { 0 } else { shape.positions.len() as u32 };
        let of_corner = if order == 0 { strays.len() as u32 + 7 } else { 7 };
        let drawn = shapes::together(&parts);
        let model = shapes::model(drawn.clone());
        let at = |stray: u32| model.drawn.surface_vertex(DrawnVertex(first + stray)).unwrap();
        assert_eq!(model.drawn.surface_vertex(DrawnVertex(of_corner)), Some(at(0)));
        assert_eq!(at(0), at(1));
        assert_eq!(at(2), at(3));
        assert_ne!(at(2), at(4));
        assert_eq!(model.topology.bare_points().len(), 2);
        assert_eq!(model.rest().positions, drawn.positions, "no drawn vertex moves");
        let given = WeldOptions { distance: Some(2e-3) };
        let given = Model::weld(drawn, &given, &Progress::new(), &Cancel::new()).unwrap();
        assert_eq!(given.topology.bare_points().len(), 1, "the last one joins those at 0");
    }
}

#[test]
fn every_finite_point_moves_with_its_displacement_and_no_other() {
    let mut cloud = line(1000);
    cloud[10] = DVec3::NAN;
    cloud[20] = DVec3::splat(1e300);
    cloud[30] = cloud[31];
    let model = shapes::model(points(cloud.clone()));
    assert_eq!(model.surface.positions.len(), 997);
    assert_eq!(model.topology.bare_points(), 0..997);
    let displacements: Vec<DVec3> = (0..997).map(|v| DVec3::splat(f64::from(v) + 1.0)).collect();
    let mut out = Vec::new();
    model.drawn_positions(&displacements, &mut out);
    for (v, (moved, rest)) in out.iter().zip(&cloud).enumerate() {
        match model.drawn.surface_vertex(DrawnVertex(v as u32)) {
            Some(surface) => {
                assert_eq!(model.surface.positions[surface.index()], *rest);
                assert_eq!(*moved, *rest + displacements[surface.index()]);
            }
            None => assert!(v == 10 || v == 20),
        }
    }
    let joined = model.drawn.surface_vertex(DrawnVertex(31)).unwrap();
    assert_eq!(model.first_file_vertex(joined), FileVertex(30));
}

#[test]
fn an_inspection_counts_the_points_and_lists_only_parts_of_triangles() {
    let drawn = shapes::together(&[shapes::grid(3, 3), points(line(5))]);
    let look = |drawn| Inspection::of(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
    let both = look(drawn);
    assert_eq!((both.surface_vertices, both.bare_points), (16 + 5, 5));
    assert_eq!(both.components.len(), 1);
    assert_eq!(both.findings.unreferenced_vertices.count, 5);
    assert_eq!(both.bounds, look(shapes::grid(3, 3)).bounds);
    let cloud = look(points(line(5)));
    assert_eq!((cloud.surface_vertices, cloud.bare_points), (5, 5));
    assert!(cloud.components.is_empty() && cloud.bounds.is_some());
}
