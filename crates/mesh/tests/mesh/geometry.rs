//! Areas, angles and boxes.

use glam::DVec3;
use pliant_mesh::geometry::{area_of_lengths, edge_lengths, mixed_corner_areas};
use pliant_mesh::{bounding_box, cotangents, face_area, face_areas, mixed_voronoi_areas, shapes};

#[test]
fn mixed_areas_share_out_the_surface() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let whole: f64 = face_areas(&model.surface, &model.surface.positions).iter().sum();
        let shares = mixed_voronoi_areas(&model.surface);
        assert!(shares.iter().all(|&share| share >= 0.0 && share.is_finite()), "{class}");
        assert!((shares.iter().sum::<f64>() - whole).abs() < 1e-8 * whole, "{class}");
    }
}

#[test]
fn a_right_angle_is_shared_as_by_circumcentre_and_an_obtuse_one_by_halves() {
    let [right, others @ ..] = mixed_corner_areas([5.0, 3.0, 4.0]);
    assert!((right - 3.0).abs() < 1e-12 && others.iter().all(|share| (share - 1.5).abs() < 1e-12));
    let obtuse = [3.0, 2.0, 2.0];
    let area = area_of_lengths(obtuse);
    assert_eq!(mixed_corner_areas(obtuse), [0.5 * area, 0.25 * area, 0.25 * area]);
    assert_eq!(mixed_corner_areas([2.0, 1.0, 1.0]), [0.0; 3]);
}

#[test]
fn cotangents_are_those_of_the_angles() {
    let corners = [
        DVec3::new(0.3, -1.0, 2.0),
        DVec3::new(1.5, 0.2, 2.2),
        DVec3::new(-0.4, 0.9, 1.0),
    ];
    let cot = cotangents(edge_lengths(corners));
    for i in 0..3 {
        let [a, b] = [1, 2].map(|k| corners[(i + k) % 3] - corners[i]);
        assert!((cot[i] - 1.0 / a.angle_between(b).tan()).abs() < 1e-12);
    }
    // cot α cot β + cot β cot γ + cot γ cot α = 1 in every triangle.
    assert!((cot[0] * cot[1] + cot[1] * cot[2] + cot[2] * cot[0] - 1.0).abs() < 1e-12);
}

#[test]
fn the_area_of_a_needle_is_right_to_the_last_digits() {
    // Kahan's own example: the textbook formula loses every digit.
    let height = 1e-9;
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, height, 0.0)];
    let area = area_of_lengths([(1.0 + height * height).sqrt(), height, 1.0]);
    assert!((area / face_area(corners) - 1.0).abs() < 1e-6);
    assert!((area_of_lengths([100_000.0, 99_999.999_79, 0.000_29]) - 10.0).abs() < 0.1);
    assert_eq!(area_of_lengths([3.0, 1.0, 1.0]), 0.0);
}

#[test]
fn boxes_hold_what_they_bound() {
    assert_eq!(bounding_box(&[]), None);
    let bounds = bounding_box(&shapes::bar(3, 4, 12).positions);
    assert_eq!(
        bounds.map(|b| (b.min, b.max, b.diagonal())),
        Some((DVec3::ZERO, DVec3::new(3.0, 4.0, 12.0), 13.0))
    );
}
