//! Mirror symmetry: the plane of a symmetric shape is found wherever the shape is, a shape without one has none, and
//! counterparts leave no vertex out.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::collections::BTreeSet;
use std::f64::consts::PI;

use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_mesh::{
    Bvh, Cancel, Counterparts, Drawn, DrawnVertex, MirrorPlane, Model, Progress, SurfaceVertex, mirror_planes, shapes,
    symmetry_plane,
};

fn plane_of(model: &Model) -> Option<MirrorPlane> {
    let surface = &model.surface;
    let bvh = Bvh::build(&surface.positions, &surface.triangles);
    symmetry_plane(surface, &model.topology, &bvh, &Progress::new(), &Cancel::new()).unwrap()
}

fn counterparts(model: &Model, plane: MirrorPlane) -> Counterparts {
    let surface = &model.surface;
    let bvh = Bvh::build(&surface.positions, &surface.triangles);
    let (progress, cancel) = (Progress::new(), Cancel::new());
    Counterparts::find(surface, &model.topology, &bvh, plane, &progress, &cancel).unwrap()
}

/// A body with x = 0 as its only plane of symmetry: longer than high, with a hump in front and a belly below.
fn creature() -> Drawn {
    let mut drawn = shapes::icosphere(4);
    for p in &mut drawn.positions {
        let hump = 0.8 * (-8.0 * p.distance_squared(DVec3::new(0.0, 0.6, 0.8))).exp();
        let arms = 0.7 * (-12.0 * DVec3::new(p.x.abs(), p.y, p.z).distance_squared(DVec3::new(0.9, 0.3, 0.3))).exp();
        *p *= DVec3::new(0.8 + arms, 1.7 + hump, 1.1 + 0.5 * hump + 0.2 * p.y);
    }
    drawn
}

fn motions() -> [DAffine3; 3] {
    let turn = |x: f64, y: f64, z: f64| DQuat::from_euler(glam::EulerRot::XYZ, x, y, z);
    [
        DAffine3::IDENTITY,
        DAffine3::from_rotation_translation(turn(0.4, -0.9, 1.7), DVec3::new(3.0, -2.0, 5.0)),
        DAffine3::from_scale_rotation_translation(DVec3::splat(1e-3), turn(2.0, 0.3, -0.6), DVec3::splat(7.0)),
    ]
}

#[test]
fn the_plane_is_found_wherever_the_shape_stands() {
    for motion in motions() {
        let plane = plane_of(&shapes::model(shapes::moved(&creature(), motion))).unwrap();
        let normal = motion.transform_vector3(DVec3::X).normalize();
        let size = motion.transform_vector3(DVec3::X).length();
        assert!(plane.normal().dot(normal).abs() > 1.0 - 1e-9, "{plane:?} {normal}");
        assert!(plane.height(motion.translation).abs() < 1e-5 * size, "{plane:?}");
    }
}

#[test]
fn what_one_side_lacks_does_not_tilt_the_plane() {
    let mut drawn = creature();
    let bag = |p: DVec3| 0.3 * (-20.0 * p.distance_squared(DVec3::new(0.8, -0.9, 0.2))).exp();
    drawn.positions.iter_mut().for_each(|p| *p += p.normalize() * bag(*p));
    let plane = plane_of(&shapes::model(drawn)).unwrap();
    assert!(plane.normal().x.abs() > (2.0_f64.to_radians()).cos(), "{plane:?}");
}

#[test]
fn a_shape_without_a_plane_has_none() {
    // A tube along a helix: one hand, across any plane.
    let helix = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.25 * angle);
    let mut drawn = shapes::tube(12, 240, 1.0);
    let (min, max) = drawn
        .positions
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.z), b.max(p.z)));
    for p in &mut drawn.positions {
        let angle = 8.0 * (p.z - min) / (max - min);
        let out = DVec2::new(p.x, p.y) * 0.08;
        *p = helix(angle) + DVec3::new(angle.cos(), angle.sin(), 0.0) * out.x + DVec3::Z * out.y;
    }
    assert_eq!(plane_of(&shapes::model(drawn)), None);
}

#[test]
fn of_planes_that_fit_alike_it_is_that_across_x() {
    for drawn in [shapes::icosphere(3), shapes::bar(4, 4, 4), shapes::torus(40, 20)] {
        let plane = plane_of(&shapes::model(drawn)).unwrap();
        assert!(plane.normal().x.abs() > 1.0 - 1e-6, "{plane:?}");
    }
}

#[test]
fn the_plane_of_nothing_is_none() {
    for drawn in [Drawn::default(), shapes::grid(1, 1)] {
        let model = shapes::model(drawn);
        if let Some(plane) = plane_of(&model) {
            assert!(plane.normal().is_finite() && plane.distance().is_finite());
        }
    }
}

#[test]
fn mirroring_twice_is_where_one_was_and_the_plane_stays() {
    let plane = MirrorPlane::new(DVec3::new(1.0, -2.0, 0.5), 0.7).unwrap();
    let point = DVec3::new(0.3, 4.0, -2.0);
    assert!(plane.mirrored(plane.mirrored(point)).distance(point) < 1e-14);
    assert!((plane.height(point) + plane.height(plane.mirrored(point))).abs() < 1e-14);
    assert!((plane.reflection() * point).distance(plane.mirrored_vector(point)) < 1e-14);
    assert_eq!(MirrorPlane::across(1, 2.0).axis(), Some(1));
    assert_eq!(plane.axis(), None);
    assert_eq!(MirrorPlane::new(DVec3::ZERO, 1.0), None);
}

#[test]
fn counterparts_go_both_ways_and_leave_no_vertex_of_a_symmetric_shape_out() {
    // Rotated within itself, so that no vertex is the image of another.
    let turned = DAffine3::from_axis_angle(DVec3::new(0.3, 1.0, 0.2).normalize(), 0.37);
    for drawn in [creature(), shapes::moved(&shapes::icosphere(4), turned)] {
        let model = shapes::model(drawn);
        let plane = MirrorPlane::across(0, 0.0);
        let all = counterparts(&model, plane);
        let positions = &model.surface.positions;
        for vertex in (0..positions.len() as u32).map(SurfaceVertex) {
            let own = all.of(vertex);
            let position = positions[vertex.index()];
            let edges = model
                .topology
                .neighbours(vertex)
                .iter()
                .map(|v| position.distance(positions[v.index()]));
            let edge = edges.fold(0.0, f64::max);
            assert!(!own.is_empty() || position.x.abs() < edge, "{vertex:?} at {position}");
            for &other in own {
                assert!(all.of(other).contains(&vertex));
                let apart = plane.mirrored(position).distance(positions[other.index()]);
                assert!(apart < 2.0 * edge, "{apart} {edge}");
            }
        }
    }
}

#[test]
fn a_limb_that_is_bent_on_one_side_has_its_counterparts_along_the_surface() {
    // Arms along z on both sides of a trunk that is oval, so that each vertex' true counterpart is known.
    let (rings, segments) = (96, 36);
    let radius = |z: f64| {
        if z.abs() < 1.2 {
            1.0 - 0.4 * z * z
        } else {
            0.424 * (1.0 - ((z.abs() - 1.2) / 1.8).powi(2)).max(0.0).sqrt()
        }
    };
    let profile = |share: f64| {
        let z = 3.0 * (PI * share).cos();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { radius(z) }, z)
    };
    let mut drawn = shapes::turned(rings, segments, profile);
    for p in &mut drawn.positions {
        p.y *= 1.3;
        let beyond = (p.z - 1.5).clamp(0.0, 1.0);
        let hinge = DVec3::Z * 1.5;
        *p = hinge + DQuat::from_rotation_y(0.7 * beyond) * (*p - hinge);
    }
    let ring = |vertex: usize| {
        if vertex == 0 {
            (0, 0)
        } else {
            (1 + (vertex - 1) / segments, (vertex - 1) % segments)
        }
    };
    let at = |(ring, segment): (usize, usize)| match ring {
        // The poles are one vertex each.
        0 => 0,
        _ if ring == rings => (rings - 1) * segments + 1,
        _ => 1 + (ring - 1) * segments + segment,
    };
    let model = shapes::model(drawn);
    let all = counterparts(&model, MirrorPlane::across(2, 0.0));
    let positions = &model.surface.positions;
    let surface = |drawn: usize| model.drawn.surface_vertex(DrawnVertex(drawn as u32)).unwrap();
    for drawn in 0..positions.len() {
        let is_alone = all.of(surface(drawn)).is_empty();
        assert!(
            !is_alone || ring(drawn).0 == rings / 2,
            "{drawn} at {}",
            positions[surface(drawn).index()]
        );
    }
    // Each part of the bent arm, from its tip on, has nearly all of its true counterpart, in one piece.
    for beyond in [24, 32, 40] {
        let part = (0..positions.len()).filter(|&drawn| ring(drawn).0 <= beyond);
        let truth = |drawn: usize| {
            let (ring, segment) = ring(drawn);
            surface(at((rings - ring, segment)))
        };
        let (mut found, mut expected) = (BTreeSet::new(), BTreeSet::new());
        for drawn in part {
            found.extend(all.of(surface(drawn)));
            expected.insert(truth(drawn));
        }
        let (common, either) = (found.intersection(&expected).count(), found.union(&expected).count());
        assert!(
            common as f64 >= 0.8 * either as f64,
            "{beyond} rings: {common} of {either}"
        );
        let mut front: Vec<SurfaceVertex> = found.pop_first().into_iter().collect();
        while let Some(vertex) = front.pop() {
            front.extend(
                model
                    .topology
                    .neighbours(vertex)
                    .iter()
                    .filter(|other| found.remove(other)),
            );
        }
        assert!(found.is_empty(), "{beyond} rings: {} vertices are apart", found.len());
    }
}

/// Two legs that hang down from a bend, a tube of radius 1 whose ends are 8 below; each is turned forward by an angle in
/// radians below y = −2. Ring `r` of 121 is the image of ring 120 − r.
fn legs(forward_rad: [f64; 2]) -> Drawn {
    let (apart, leg) = (1.25, 8.0);
    let mut tube = shapes::tube(36, 120, 2.0 * leg + PI * apart);
    for p in &mut tube.positions {
        let bend = (p.z - leg).clamp(0.0, PI * apart) / apart;
        let below = (leg - p.z).max(p.z - leg - PI * apart).max(0.0);
        let out = DVec3::new(-bend.cos(), bend.sin(), 0.0);
        // Not round, so that a turn about the leg shows.
        let [x, z] = [p.x, 1.3 * p.y];
        *p = (apart + x) * out + DVec3::new(0.0, -below, z);
        let hip = DVec3::new(0.0, -2.0, 0.0);
        let angle = (-2.0 - p.y).clamp(0.0, 1.0) * forward_rad[usize::from(p.x > 0.0)];
        *p = hip + DQuat::from_rotation_x(angle) * (*p - hip);
    }
    tube
}

#[test]
fn near_legs_that_stand_unevenly_are_each_other_s_counterparts_without_rags() {
    for forward_rad in [[0.0, 0.0], [0.0, 0.25], [0.12, -0.12]] {
        let (model, hanging) = (shapes::model(legs(forward_rad)), legs([0.0, 0.0]));
        let all = counterparts(&model, MirrorPlane::across(0, 0.0));
        let surface = |drawn: usize| model.drawn.surface_vertex(DrawnVertex(drawn as u32)).unwrap();
        let mut place = vec![DVec3::ZERO; model.surface.positions.len()];
        for (drawn, p) in hanging.positions.iter().enumerate() {
            place[surface(drawn).index()] = *p;
        }
        let (mut off, mut count, mut torn) = (0.0, 0.0, 0.0);
        for (vertex, own) in (0..).map(SurfaceVertex).zip(&place) {
            let image = *own * DVec3::new(-1.0, 1.0, 1.0);
            for other in all.of(vertex) {
                off += image.distance(place[other.index()]);
                count += 1.0;
            }
            for beside in model.topology.neighbours(vertex) {
                let of_beside = all.of(*beside).iter();
                let farthest = of_beside.flat_map(|other| {
                    let own = all.of(vertex).iter();
                    own.map(|own| place[own.index()].distance(place[other.index()]))
                });
                torn += if farthest.fold(0.0, f64::max) > 0.9 { 1.0 } else { 0.0 };
            }
        }
        // Edges are 0.2 long.
        assert!(off < 0.5 * count, "{forward_rad:?}: {}", off / count);
        assert!(torn < 0.15 * count, "{forward_rad:?}: {torn} of {count}");
    }
}

#[test]
fn limbs_that_all_stand_unevenly_do_not_hide_the_trunk_s_plane() {
    // Four legs and a neck, each turned by its own angle: a third of the surface is elsewhere on the other side.
    let walking = |stride_rad: f64| {
        let mut drawn = shapes::icosphere(5);
        for p in &mut drawn.positions {
            let unit = *p;
            // The front is broader and higher than the back.
            *p = unit * DVec3::new(0.7 + 0.25 * unit.z, 0.8 + 0.3 * unit.z, 1.6);
            let legs = [
                ([0.5, 1.0], 1.0),
                ([-0.5, 1.0], -1.0),
                ([0.5, -1.0], -0.8),
                ([-0.5, -1.0], 0.8),
            ];
            for ([x, z], swing) in legs {
                let root = DVec3::new(x, -0.7, 0.5 * z).normalize();
                let near = (-25.0 * unit.distance_squared(root)).exp();
                let angle = swing * stride_rad;
                *p += near * 2.5 * DVec3::new(0.0, -angle.cos(), angle.sin());
            }
            let neck = (-20.0 * unit.distance_squared(DVec3::new(0.0, 0.6, 0.8))).exp();
            *p += neck * 1.4 * DVec3::new(stride_rad.sin(), stride_rad.cos(), 0.5);
        }
        drawn
    };
    for stride_rad in [0.5, 0.6] {
        let plane = plane_of(&shapes::model(walking(stride_rad))).unwrap();
        assert!(
            plane.normal().x.abs() > 2.0_f64.to_radians().cos(),
            "{stride_rad}: {plane:?}"
        );
    }
}

#[test]
fn what_lies_on_one_side_alone_has_no_counterpart() {
    let model = shapes::model(shapes::moved(
        &shapes::icosphere(2),
        DAffine3::from_translation(DVec3::X * 5.0),
    ));
    let all = counterparts(&model, MirrorPlane::across(0, 0.0));
    assert!((0..model.surface.positions.len() as u32).all(|v| all.of(SurfaceVertex(v)).is_empty()));
}

#[test]
fn points_of_any_size_and_place_are_looked_at() {
    let tower = shapes::bar(2, 2, 5).positions;
    for size in [1e-300, 1e-30, 1.0, 1e30, 1e300] {
        for far in [0.0, 1.0, 1e30, 1e300] {
            let mut positions: Vec<DVec3> = tower.iter().map(|p| *p * size).collect();
            positions.push(DVec3::splat(far));
            for (share, plane) in mirror_planes(&positions) {
                assert!(
                    share > 0.5 && share <= 1.0 && plane.normal().is_normalized(),
                    "{size} {far}"
                );
            }
        }
        let moved: Vec<DVec3> = tower.iter().map(|p| DVec3::splat(size) + *p).collect();
        let planes = mirror_planes(&moved);
        assert!(size > 1.0 || planes.iter().any(|(share, _)| *share == 1.0), "{size}");
    }
}
