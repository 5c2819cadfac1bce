//! Tubes between two borders.

use glam::{DQuat, DVec3};
use pliant_deform::Budget;
use pliant_mesh::{Cancel, Drawn, Model, Progress, SurfaceVertex, shapes};
use pliant_stitch::{Filled, Holes, StitchError, fill};

use crate::fill::with_patches;
use crate::made::{genus, model, without};

fn try_tube(model: &Model, vertices: [u32; 2]) -> Result<Filled, StitchError> {
    let holes = Holes::Between(vertices);
    fill(model, holes, Budget::default(), &Progress::new(), &Cancel::new())
}

/// A vertex of each border, longest border first.
fn on_borders(model: &Model) -> Vec<u32> {
    let mut loops = model.topology.boundary_loops();
    loops.sort_by_key(|own| std::cmp::Reverse(own.len()));
    let first = |own: &Vec<SurfaceVertex>| model.first_file_vertex(own[0]).0;
    loops.iter().map(first).collect()
}

fn check(model: &Model, tube: &Filled, components: usize, handles: i64) -> Model {
    let whole = shapes::model(with_patches(model, tube));
    let topology = &whole.topology;
    assert_eq!(
        topology.boundary_loops().len(),
        model.topology.boundary_loops().len() - 2
    );
    assert_eq!((topology.non_manifold_edges(), topology.misoriented_edges()), (0, 0));
    assert_eq!((topology.components().len(), genus(&whole)), (components, handles));
    assert!(tube.holes[0].is_faired);
    whole
}

/// The missing middle of a tube comes back, for ends with other counts of vertices and turned about the axis.
#[test]
fn the_middle_of_a_tube_comes_back() {
    for (count, turn) in [(32, 0.0), (32, 1.0), (21, 2.0)] {
        let mut both = shapes::tube(32, 8, 1.0);
        let mut other = shapes::tube(count, 8, 1.0);
        for p in &mut other.positions {
            *p = DQuat::from_rotation_z(turn) * *p + DVec3::Z * 2.0;
        }
        both = joined(both, other);
        let open = model(both);
        let inner: Vec<u32> = open
            .topology
            .boundary_loops()
            .iter()
            .filter(|own| (0.9..2.1).contains(&open.surface.positions[own[0].index()].z))
            .map(|own| open.first_file_vertex(own[0]).0)
            .collect();
        let tube = try_tube(&open, [inner[0], inner[1]]).unwrap();
        check(&open, &tube, 1, 0);
        let points = &tube.holes[0].points;
        assert!(!points.is_empty());
        for p in points {
            assert!((p.truncate().length() - 1.0).abs() < 0.03, "{count}, {turn}: {p}");
        }
    }
}

/// Two holes of one sphere become the ends of a handle, and those of two spheres one surface.
#[test]
fn a_tube_adds_a_handle_or_joins_two_components() {
    let holes = [DVec3::new(0.5, 0.0, 0.866), DVec3::new(-0.5, 0.0, 0.866)];
    let ball = without(&shapes::icosphere(4), |p| {
        holes.iter().any(|hole| p.normalize().distance(*hole) < 0.25)
    });
    let open = model(ball);
    let ends = on_borders(&open);
    let handle = try_tube(&open, [ends[0], ends[1]]).unwrap();
    let whole = check(&open, &handle, 1, 1);
    assert!(
        whole
            .surface
            .positions
            .iter()
            .all(|p| p.is_finite() && p.length() < 3.0)
    );

    let cap = without(&shapes::icosphere(3), |p| p.z > 0.8);
    let mut other = cap.clone();
    for p in &mut other.positions {
        *p = DQuat::from_rotation_x(2.8) * *p + DVec3::Z * 3.0;
    }
    let open = model(joined(cap, other));
    let ends = on_borders(&open);
    check(&open, &try_tube(&open, [ends[0], ends[1]]).unwrap(), 1, 0);
}

/// However far apart the borders are, the tube is as wide as they are.
#[test]
fn a_long_tube_keeps_its_width() {
    for gap in [3.0, 12.0, 40.0] {
        let mut other = shapes::tube(24, 6, 1.0);
        other.positions.iter_mut().for_each(|p| p.z += 1.0 + gap);
        let open = model(joined(shapes::tube(24, 6, 1.0), other));
        let loops = open.topology.boundary_loops();
        let height = |own: &Vec<SurfaceVertex>| open.surface.positions[own[0].index()].z;
        let inner = loops.iter().filter(|own| (0.5..1.5 + gap).contains(&height(own)));
        let ends: Vec<u32> = inner.map(|own| open.first_file_vertex(own[0]).0).collect();
        let tube = try_tube(&open, [ends[0], ends[1]]).unwrap();
        check(&open, &tube, 1, 0);
        for p in &tube.holes[0].points {
            assert!((p.truncate().length() - 1.0).abs() < 0.05, "{gap}: {p}");
        }
    }
}

#[test]
fn one_border_and_borders_that_touch_are_refused_in_words() {
    let open = model(shapes::tube(20, 4, 2.0));
    let refused = try_tube(&open, [0, 3]).unwrap_err();
    assert_eq!(refused, StitchError::SameBorder { vertices: [0, 3] });
    // Two squares of a grid that meet at a corner.
    let sheet = without(&shapes::grid(6, 6), |p| {
        let cell = [p.x, p.y].map(|x| (6.0 * x) as u32);
        cell == [2, 2] || cell == [3, 3]
    });
    let sheet = model(sheet);
    let ends = on_borders(&sheet);
    let refused = try_tube(&sheet, [ends[1], ends[2]]).unwrap_err();
    assert!(matches!(refused, StitchError::BordersTouch { .. }), "{refused}");
}

fn joined(a: Drawn, b: Drawn) -> Drawn {
    let first = a.positions.len() as u32;
    let positions = [a.positions, b.positions].concat();
    let moved = b
        .triangles
        .iter()
        .map(|corners| corners.map(|v| pliant_mesh::DrawnVertex(v.0 + first)));
    let triangles = a.triangles.iter().copied().chain(moved).collect();
    Drawn::once(positions, triangles)
}
