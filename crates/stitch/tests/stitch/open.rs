//! Borders that filling leaves open: outer borders of open sheets, and faulty ones.

use glam::DVec3;
use pliant_deform::Budget;
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, shapes};
use pliant_stitch::{BorderFault, Filled, Holes, Reason, StitchError, Unfilled, fill};

use crate::made::{model, without};

fn try_fill(model: &Model, holes: Holes) -> Result<Filled, StitchError> {
    fill(model, holes, Budget::default(), &Progress::new(), &Cancel::new())
}

/// A relief from 0 to 1 along x and y with two holes.
fn relief() -> Drawn {
    let mut sheet = shapes::grid(30, 30);
    for p in &mut sheet.positions {
        p.z = 0.1 * (9.0 * p.x).sin() * (7.0 * p.y).cos();
    }
    let holes = [[0.3, 0.4], [0.7, 0.6]].map(|[x, y]| DVec3::new(x, y, 0.0));
    without(&sheet, |p| {
        holes.iter().any(|hole| p.with_z(0.0).distance(*hole) < 0.12)
    })
}

/// For a sheet in any direction, and with either side outwards.
#[test]
fn the_outer_border_of_a_sheet_is_filled_only_if_it_is_named() {
    for flip in [false, true] {
        let mut sheet = relief();
        let turn = glam::DQuat::from_rotation_x(2.0) * glam::DQuat::from_rotation_z(1.0);
        sheet.positions.iter_mut().for_each(|p| *p = turn * *p);
        if flip {
            sheet.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
        }
        let sheet = model(sheet);
        let filled = try_fill(&sheet, Holes::Every).unwrap();
        assert_eq!(filled.holes.len(), 2);
        let outer = filled.unfilled[0];
        assert_eq!((outer.reason, outer.count), (Reason::Outer, 1));
        for holes in [Holes::Largest(1), Holes::At(outer.vertex)] {
            let named = try_fill(&sheet, holes).unwrap();
            assert_eq!(named.holes.len(), 1);
            assert!(named.holes[0].borders[0].length > 3.0 && named.unfilled.is_empty());
        }
    }
    let whole = model(shapes::grid(5, 5));
    let refused = try_fill(&whole, Holes::Every).unwrap_err();
    assert!(matches!(refused, StitchError::OnlyOuterBorders { .. }), "{refused}");
}

/// Tubes, and spheres with openings of up to a third of their area, are no sheets.
#[test]
fn every_border_of_a_hollow_shape_is_a_hole() {
    let ball = |height: f64| without(&shapes::icosphere(4), move |p| p.z > height);
    for (shape, count) in [
        (shapes::tube(24, 3, 0.5), 2),
        (shapes::tube(24, 30, 5.0), 2),
        (ball(0.8), 1),
        (ball(0.4), 1),
    ] {
        let filled = try_fill(&model(shape), Holes::Every).unwrap();
        assert_eq!((filled.holes.len(), filled.unfilled.len()), (count, 0));
    }
}

#[test]
fn faulty_borders_are_summed_up_by_their_faults() {
    let mut shape = without(&shapes::icosphere(3), |p| p.z > 0.9);
    for k in 0..5 {
        let first = shape.positions.len() as u32;
        let at = |x: f64, y: f64| DVec3::new(3.0 + f64::from(k) + x, y, 0.0);
        shape.positions.extend([at(0.0, 0.0), at(0.5, 0.0), at(0.0, 0.5)]);
        shape
            .triangles
            .push([0, 1, 2].map(|corner| DrawnVertex(first + corner)));
    }
    let shape = model(Drawn::once(shape.positions, shape.triangles));
    let filled = try_fill(&shape, Holes::Every).unwrap();
    let lone = Unfilled {
        reason: Reason::Faulty(BorderFault::LoneTriangle),
        count: 5,
        vertex: filled.unfilled[0].vertex,
    };
    assert_eq!((filled.holes.len(), &filled.unfilled[..]), (1, &[lone][..]));
    assert!(
        lone.to_string().starts_with("5 borders (the first at vertex "),
        "{lone}"
    );
}
