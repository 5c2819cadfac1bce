//! Self-intersections are those that trying every pair finds, and only those that the deformation made.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use crate::geometry::triangle_intersection;
use crate::{Bvh, Cancel, Drawn, Model, Progress, SelfIntersections, SurfaceVertex, shapes};
use glam::{DAffine3, DVec3};

/// The pairs that are found after the vertices were moved.
fn found(model: &Model, moved: &[DVec3], most: usize) -> SelfIntersections {
    let mut bvh = Bvh::build(&model.surface.positions, &model.surface.triangles);
    bvh.refit(|v| moved[v.index()]);
    let (surface, topology) = (&model.surface, &model.topology);
    bvh.new_self_intersections(surface, topology, most, &Progress::new(), &Cancel::new())
        .unwrap()
}

fn every_pair(triangles: &[[SurfaceVertex; 3]], positions: &[DVec3]) -> Vec<[[SurfaceVertex; 3]; 2]> {
    let corners = |t: usize| triangles[t].map(|v| positions[v.index()]);
    let pairs = (0..triangles.len()).flat_map(|a| (a + 1..triangles.len()).map(move |b| (a, b)));
    pairs
        .filter(|&(a, b)| triangle_intersection(corners(a), corners(b)).is_some())
        .map(|(a, b)| ordered([triangles[a], triangles[b]]))
        .collect()
}

fn ordered(mut pair: [[SurfaceVertex; 3]; 2]) -> [[SurfaceVertex; 3]; 2] {
    pair.sort_unstable();
    pair
}

/// The shape bent along its longest side until its ends pass through each other.
fn bent(drawn: Drawn) -> (Model, Vec<DVec3>) {
    let model = shapes::model(drawn);
    let bounds = model.bounds().unwrap();
    let along = bounds.extent().max_position();
    let across = (along + 1) % 3;
    let moved = model.surface.positions.iter().map(|p| {
        let share = (p[along] - bounds.min[along]) / bounds.extent()[along];
        let (angle, radius) = (1.1 * std::f64::consts::TAU * share, 2.5 + p[across]);
        let mut q = *p;
        (q[along], q[across]) = (radius * angle.cos(), radius * angle.sin());
        q
    });
    let moved = moved.collect();
    (model, moved)
}

fn bent_tube() -> (Model, Vec<DVec3>) {
    bent(shapes::tube(16, 60, 12.0))
}

#[test]
fn the_pairs_are_those_of_every_pair_tried() {
    let (model, moved) = bent_tube();
    let mut pairs: Vec<_> = found(&model, &moved, usize::MAX)
        .pairs
        .iter()
        .map(|pair| ordered(pair.triangles))
        .collect();
    pairs.sort_unstable();
    let mut wanted = every_pair(&model.surface.triangles, &moved);
    wanted.sort_unstable();
    assert!(wanted.len() > 50, "{}", wanted.len());
    assert!(pairs == wanted, "{} {}", pairs.len(), wanted.len());
}

#[test]
fn no_shape_at_rest_and_no_rigid_motion_of_any_makes_a_new_one() {
    let motion = DAffine3::from_rotation_y(0.7) * DAffine3::from_translation(DVec3::new(0.3, -0.2, 5.0));
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        assert!(found(&model, &model.surface.positions, 10).pairs.is_empty(), "{class}");
        let moved: Vec<DVec3> = model
            .surface
            .positions
            .iter()
            .map(|p| motion.transform_point3(*p))
            .collect();
        let found = found(&model, &moved, 10);
        assert!(found.pairs.is_empty(), "{class}: {:?}", found.pairs);
    }
}

#[test]
fn a_crossing_that_was_there_at_rest_is_no_news_where_it_shifts() {
    let pair = shapes::together(&[
        shapes::icosphere(3),
        shapes::moved(&shapes::icosphere(3), DAffine3::from_translation(DVec3::X)),
    ]);
    let model = shapes::model(pair);
    // Both balls are swollen a little, one more than the other.
    let swollen = |p: &DVec3| *p + 0.004 * (*p - DVec3::X * 0.5);
    let moved: Vec<DVec3> = model.surface.positions.iter().map(swollen).collect();
    let before = every_pair(&model.surface.triangles, &model.surface.positions);
    let after = every_pair(&model.surface.triangles, &moved);
    assert!(!before.is_empty() && !after.is_empty());
    assert!(found(&model, &moved, 10).pairs.is_empty());
    // A third ball that comes into one of them counts.
    let far = shapes::moved(&shapes::icosphere(2), DAffine3::from_translation(DVec3::Y * 4.0));
    let drawn = shapes::together(&[shapes::icosphere(3), far]);
    let model = shapes::model(drawn);
    let moved: Vec<DVec3> = model
        .surface
        .positions
        .iter()
        .map(|p| if p.y > 2.0 { *p - DVec3::Y * 2.5 } else { *p })
        .collect();
    let found = found(&model, &moved, usize::MAX);
    assert!(found.are_all && found.pairs.len() > 20);
    for pair in &found.pairs {
        for end in pair.segment {
            assert!((end.length() - 1.0).abs() < 0.05 && (end.distance(DVec3::Y * 1.5) - 1.0).abs() < 0.1);
        }
    }
}

#[test]
fn triangles_that_are_joined_to_no_other_are_no_news() {
    let mut soup = shapes::soup(&shapes::tube(16, 60, 12.0));
    for corners in &soup.triangles {
        let middle = corners.iter().map(|v| soup.positions[v.index()]).sum::<DVec3>() / 3.0;
        for v in corners {
            soup.positions[v.index()] = soup.positions[v.index()].lerp(middle, 0.01);
        }
    }
    let (model, moved) = bent(soup);
    assert!(every_pair(&model.surface.triangles, &moved).len() > 50);
    assert!(found(&model, &moved, 10).pairs.is_empty());
}

#[test]
fn pairs_are_at_one_place_where_they_hang_together() {
    // Two balls enter a third one, at opposite sides.
    let ball = |x: f64| shapes::moved(&shapes::icosphere(3), DAffine3::from_translation(DVec3::X * x));
    let model = shapes::model(shapes::together(&[ball(0.0), ball(4.0), ball(-4.0)]));
    let near = |p: &DVec3| *p - DVec3::X * if p.x.abs() > 2.0 { 2.5 * p.x.signum() } else { 0.0 };
    let moved: Vec<DVec3> = model.surface.positions.iter().map(near).collect();
    let found = found(&model, &moved, usize::MAX);
    let places = found.places();
    assert_eq!(places.len(), 2, "{places:?}");
    assert_eq!(places.iter().map(Vec::len).sum::<usize>(), found.pairs.len());
    for place in places {
        let sides = place.iter().map(|&pair| found.pairs[pair].segment[0].x > 0.0);
        let right = sides.filter(|is_right| *is_right).count();
        assert!(right == 0 || right == place.len());
    }
}

#[test]
fn the_search_ends_when_it_is_told_and_says_so_and_the_threads_change_nothing() {
    let (model, moved) = bent_tube();
    let all = found(&model, &moved, usize::MAX);
    let few = found(&model, &moved, 5);
    assert!(all.are_all);
    assert_eq!(few.pairs, all.pairs[..5]);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(pool.install(|| found(&model, &moved, usize::MAX)) == all);
    }
    let bvh = Bvh::build(&moved, &model.surface.triangles);
    let cancel = Cancel::new();
    cancel.cancel();
    let (surface, topology) = (&model.surface, &model.topology);
    assert!(
        bvh.new_self_intersections(surface, topology, 5, &Progress::new(), &cancel)
            .is_err()
    );
}
