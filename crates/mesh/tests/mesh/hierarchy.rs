//! The hierarchy answers like a search of every triangle.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use glam::{DAffine3, DVec3};
use pliant_mesh::{Bvh, Hit, Model, SurfaceVertex, shapes};

fn hit_point(model: &Model, hit: &Hit) -> DVec3 {
    let corners = model.surface.corners(hit.triangle as usize);
    corners
        .iter()
        .zip(hit.barycentric)
        .map(|(&corner, weight)| weight * corner)
        .sum()
}

/// Directions over the whole sphere.
fn directions() -> impl Iterator<Item = DVec3> {
    shapes::icosphere(2).positions.into_iter()
}

#[test]
fn rays_from_within_a_closed_surface_always_hit_it() {
    for offset in [DVec3::ZERO, DVec3::new(4e5, 5e6, 30.0)] {
        let sphere = shapes::moved(&shapes::icosphere(3), DAffine3::from_translation(offset));
        let model = shapes::model(sphere);
        let bvh = Bvh::build(&model.surface.positions, &model.surface.triangles);
        // Aimed at vertices and at the middles of edges, where rays could slip through.
        let targets = model.surface.positions.iter().copied().chain(
            model
                .topology
                .edges()
                .map(|edge| edge.map(|v| model.surface.positions[v.index()]))
                .map(|[a, b]| 0.5 * (a + b)),
        );
        for target in targets {
            let hit = bvh.ray(offset, target - offset).unwrap();
            assert!((hit.distance - 1.0).abs() < 1e-8);
            assert!(hit_point(&model, &hit).distance(target) < 1e-8);
            assert!((hit.barycentric.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn the_first_hit_is_that_of_every_triangle_tried() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let bounds = model.bounds().unwrap();
        let all = Bvh::build(&model.surface.positions, &model.surface.triangles);
        let each: Vec<Bvh> = model
            .surface
            .triangles
            .iter()
            .map(|&t| Bvh::build(&model.surface.positions, &[t]))
            .collect();
        for direction in directions().step_by(5) {
            let origin = bounds.centre() - bounds.diagonal() * direction + 0.1 * bounds.extent();
            let first = each
                .iter()
                .filter_map(|one| one.ray(origin, direction))
                .map(|hit| hit.distance)
                .reduce(f64::min);
            assert_eq!(all.ray(origin, direction).map(|hit| hit.distance), first, "{class}");
        }
    }
}

#[test]
fn nearest_vertices_are_those_of_every_vertex_tried() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let positions = &model.surface.positions;
        let bvh = Bvh::build(positions, &model.surface.triangles);
        let bounds = model.bounds().unwrap();
        for direction in directions().step_by(7) {
            let centre = bounds.centre() + 0.6 * bounds.diagonal() * direction;
            let (nearest, distance) = bvh.nearest_vertex(centre).unwrap();
            let least = positions.iter().map(|p| p.distance(centre)).reduce(f64::min);
            assert_eq!(Some(distance), least, "{class}");
            assert_eq!(positions[nearest.index()].distance(centre), distance, "{class}");
        }
    }
}

#[test]
fn a_refitted_hierarchy_answers_as_a_new_one_and_its_copy_as_before() {
    let everywhere = |p: DVec3| 3.0 * p + DVec3::new(p.y * p.y, 5.0, p.x.sin());
    let in_a_corner = |p: DVec3| if p.x > 0.9 { p + DVec3::new(0.3, 0.0, p.x) } else { p };
    // Meshes of several blocks of boxes and positions, and of one.
    for (around, across) in [(120, 90), (30, 14)] {
        let model = shapes::model(shapes::torus(around, across));
        let (rest, triangles) = (&model.surface.positions, &model.surface.triangles);
        for bend in [&in_a_corner as &dyn Fn(DVec3) -> DVec3, &everywhere] {
            let before = Bvh::build(rest, triangles);
            let mut bvh = before.clone();
            let bent: Vec<DVec3> = rest.iter().map(|&p| bend(p)).collect();
            bvh.refit(|v| bent[v.index()]);
            let [old, fresh] = [rest, &bent].map(|positions| Bvh::build(positions, triangles));
            let mut hits = 0;
            for direction in directions() {
                let origin = DVec3::new(1.0, 1.0, 0.0) - 20.0 * direction;
                for (one, other) in [(&bvh, &fresh), (&before, &old)] {
                    let (hit, expected) = (one.ray(origin, direction), other.ray(origin, direction));
                    assert_eq!(hit.map(|h| h.distance), expected.map(|h| h.distance));
                    hits += usize::from(hit.is_some());
                    assert_eq!(one.nearest_vertex(origin), other.nearest_vertex(origin));
                }
            }
            assert!(hits > 10, "{hits}");
        }
    }
}

#[test]
fn an_empty_and_a_flat_hierarchy_answer() {
    let empty = Bvh::build(&[], &[]);
    assert_eq!(empty.ray(DVec3::ZERO, DVec3::X), None);
    assert_eq!(empty.nearest_vertex(DVec3::ZERO), None);
    let sheet = shapes::model(shapes::grid(4, 4));
    let bvh = Bvh::build(&sheet.surface.positions, &sheet.surface.triangles);
    let down = bvh.ray(DVec3::new(0.3, 0.6, 2.0), -DVec3::Z).unwrap();
    assert_eq!(down.distance, 2.0);
    assert_eq!(
        bvh.ray(DVec3::new(0.3, 0.6, 2.0), DVec3::Z),
        None,
        "nothing behind the origin"
    );
    assert_eq!(
        bvh.ray(DVec3::new(0.3, 0.6, 2.0), DVec3::ZERO),
        None,
        "no direction, no hit"
    );
}

#[test]
fn planes_find_every_vertex_before_them_and_none_far_behind() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let rest = &model.surface.positions;
        let mut bvh = Bvh::build(rest, &model.surface.triangles);
        let bounds = model.bounds().unwrap();
        let aside = 0.7 * bounds.extent();
        for positions in [rest.clone(), rest.iter().map(|&p| p + aside).collect()] {
            bvh.refit(|v| positions[v.index()]);
            for direction in directions().step_by(5) {
                let at = bounds.centre() + 0.2 * bounds.diagonal() * direction;
                let across = direction.any_orthonormal_vector();
                let planes =
                    [direction, across, (direction + across).normalize()].map(|normal| normal.extend(-normal.dot(at)));
                let is_before = |p: DVec3| planes.iter().all(|plane| plane.dot(p.extend(1.0)) >= 0.0);
                let mut met = Vec::new();
                bvh.vertices_within(&planes, |vertex, position| {
                    assert_eq!(position, positions[vertex.index()]);
                    met.push(vertex.index());
                });
                assert!(met.is_sorted_by(|a, b| a < b), "{class}");
                let missed = (0..positions.len()).find(|v| is_before(positions[*v]) && met.binary_search(v).is_err());
                assert_eq!(missed, None, "{class}");
                let nothing = [direction.extend(-direction.dot(bounds.centre()) - 3.0 * bounds.diagonal())];
                bvh.vertices_within(&nothing, |_, _| panic!("{class}: nothing lies that far away"));
            }
        }
    }
}

/// This took minutes when every pair of triangles had a union of the same area.
#[test]
fn triangles_in_one_place_or_on_one_line_have_a_hierarchy_like_any_other() {
    let count = 60_000;
    let corners: Vec<[SurfaceVertex; 3]> = (0..count)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(SurfaceVertex))
        .collect();
    for step in [0.0, 1.0] {
        let mut positions: Vec<DVec3> = (0..3 * count).map(|v| DVec3::X * (step * f64::from(v / 3))).collect();
        // A part that gives the whole a size.
        positions[0].y = 1000.0;
        let bvh = Bvh::build(&positions, &corners);
        let place = DVec3::X * (step * 777.0) + DVec3::Z;
        let (vertex, distance) = bvh.nearest_vertex(place).unwrap();
        assert!((distance - 1.0).abs() < 1e-9, "{vertex:?} at {distance}");
    }
}
