//! The laws of the shown normals: those of the shape, with the file's smooth and hard edges.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use glam::{DAffine3, DQuat, DVec3, Vec3};
use pliant_io::Appearance;
use pliant_mesh::{Drawn, DrawnVertex, Model, SurfaceVertex, shapes};
use pliant_picture::drawing::Drawing;

/// The shown normals of the shape moved by `displacements`.
fn shown(model: &Model, stored: Option<&[[f32; 3]]>, displacements: &[DVec3]) -> Vec<Vec3> {
    let appearance = Appearance {
        normals: stored.map(<[_]>::to_vec),
        ..Appearance::default()
    };
    let drawing = Drawing::new(model, appearance, Default::default());
    // Memory that another pose has used changes nothing.
    drawing.put_back(drawing.pose(model, &vec![DVec3::ONE; displacements.len()]));
    let pose = drawing.pose(model, displacements);
    pose.normals.into_iter().map(Vec3::from).collect()
}

/// A bend and a twist, by surface vertex.
fn bent(model: &Model) -> Vec<DVec3> {
    let bounds = model.bounds().unwrap();
    let (centre, size) = (bounds.centre(), bounds.diagonal());
    let moved = |&p: &DVec3| {
        let q = (p - centre) / size;
        let turned = DQuat::from_rotation_y(1.3 * q.y) * q + DVec3::X * (0.4 * q.y * q.y);
        centre + turned * size - p
    };
    model.surface.positions.iter().map(moved).collect()
}

/// Normals by the area of the triangles at each drawn vertex's surface vertex, except where these nearly cancel.
fn expected(model: &Model, displacements: &[DVec3]) -> Vec<Option<DVec3>> {
    let surface = &model.surface;
    let at = |v: SurfaceVertex| surface.positions[v.index()] + displacements[v.index()];
    let mut sums = vec![DVec3::ZERO; surface.positions.len()];
    let mut areas = vec![0.0; sums.len()];
    for corners in &surface.triangles {
        let [a, b, c] = corners.map(at);
        let doubled = (b - a).cross(c - a);
        for corner in corners {
            sums[corner.index()] += doubled;
            areas[corner.index()] += doubled.length();
        }
    }
    let drawn = model.drawn.surface_vertices();
    drawn
        .map(|v| {
            let v = v?.index();
            (sums[v].length() > 1e-3 * areas[v]).then(|| sums[v].normalize())
        })
        .collect()
}

#[test]
fn without_stored_ones_they_are_the_means_of_the_triangles_by_area() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let displacements = bent(&model);
        let mut compared = 0;
        for (normal, expected) in shown(&model, None, &displacements)
            .iter()
            .zip(expected(&model, &displacements))
        {
            let Some(expected) = expected else { continue };
            assert!(
                normal.as_dvec3().distance(expected) < 1e-4,
                "{class}: {normal} {expected}"
            );
            compared += 1;
        }
        assert!(compared > 2, "{class}");
    }
}

#[test]
fn at_rest_the_files_own_are_shown_to_the_bit() {
    for (class, drawn) in shapes::classes() {
        let stored: Vec<[f32; 3]> = (0..drawn.positions.len())
            .map(|v| {
                DQuat::from_rotation_x(0.3 * (v % 7) as f64)
                    .mul_vec3(DVec3::Y)
                    .as_vec3()
                    .to_array()
            })
            .collect();
        let model = shapes::model(drawn);
        let rest = vec![DVec3::ZERO; model.surface.positions.len()];
        let shown = shown(&model, Some(&stored), &rest);
        assert!(
            shown
                .iter()
                .zip(&stored)
                .all(|(shown, stored)| shown.to_array() == *stored),
            "{class}"
        );
    }
}

#[test]
fn hard_edges_stay_hard() {
    // Each triangle has its own three vertices, with its own normal.
    let bar = shapes::soup(&shapes::bar(6, 2, 2));
    let of_triangle = |corners: &[DVec3; 3]| (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    let corners = |positions: &[DVec3], triangle: &[DrawnVertex; 3]| triangle.map(|v| positions[v.index()]);
    let mut stored = vec![[0.0; 3]; bar.positions.len()];
    for triangle in &bar.triangles {
        let normal = of_triangle(&corners(&bar.positions, triangle)).as_vec3().to_array();
        triangle.iter().for_each(|v| stored[v.index()] = normal);
    }
    let triangles = bar.triangles.clone();
    let model = shapes::model(bar);
    let displacements = bent(&model);
    let mut moved = Vec::new();
    model.drawn_positions(&displacements, &mut moved);
    // The triangles of a vertex that have one normal, as on a side of the bar, share it.
    let shown = shown(&model, Some(&stored), &displacements);
    for triangle in &triangles {
        let own = of_triangle(&corners(&moved, triangle));
        for v in triangle {
            let normal = shown[v.index()].as_dvec3();
            assert!(normal.dot(own) > 0.9, "{normal} {own}");
        }
    }
    // A turn of the whole shape turns its normals.
    let turn = DAffine3::from_rotation_x(1.0) * DAffine3::from_rotation_z(0.4);
    let turned: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .map(|p| turn.transform_point3(*p) - *p)
        .collect();
    let shown = self::shown(&model, Some(&stored), &turned);
    for (normal, stored) in shown.iter().zip(&stored) {
        let expected = turn.transform_vector3(Vec3::from(*stored).as_dvec3());
        assert!(normal.as_dvec3().distance(expected) < 1e-5, "{normal} {expected}");
    }
}

#[test]
fn what_is_small_in_a_large_scene_has_exact_ones_too() {
    let small = shapes::moved(&shapes::icosphere(3), DAffine3::from_scale(DVec3::splat(1e-5)));
    let place = DAffine3::from_translation(DVec3::new(0.3, 0.4, 0.5));
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let large = Drawn::once(
        vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)],
        vec![[0, 1, 2].map(DrawnVertex)],
    );
    let model = shapes::model(shapes::together(&[shapes::moved(&small, place), large]));
    let displacements = bent(&model);
    let expected = expected(&model, &displacements);
    for (normal, expected) in shown(&model, None, &displacements).iter().zip(expected) {
        let off = expected.map_or(0.0, |expected| normal.as_dvec3().distance(expected));
        assert!(off < 1e-4, "{normal}: {off:e}");
    }
}
