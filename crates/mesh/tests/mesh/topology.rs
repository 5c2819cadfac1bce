//! Rows, fans, components and rims agree with the list of triangles.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DVec3};
use pliant_mesh::{FanKind, FileVertex, Model, SurfaceVertex, shapes, vertex_normals};

/// The number of triangles on each edge, lower vertex first.
fn edges_of_triangles(model: &Model) -> BTreeMap<[SurfaceVertex; 2], usize> {
    let mut edges = BTreeMap::new();
    for &[a, b, c] in &model.surface.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    edges
}

#[test]
fn rows_hold_the_edges_and_triangles() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let topology = &model.topology;
        let edges = edges_of_triangles(&model);
        assert!(topology.edges().eq(edges.keys().copied()), "{class}");
        assert_eq!(topology.edge_count(), edges.len(), "{class}");
        assert_eq!(
            topology.boundary_edges(),
            edges.values().filter(|&&n| n == 1).count(),
            "{class}"
        );
        assert_eq!(
            topology.non_manifold_edges(),
            edges.values().filter(|&&n| n > 2).count(),
            "{class}"
        );
        assert_eq!(topology.is_closed(), edges.values().all(|&n| n > 1), "{class}");
        for v in (0..topology.vertex_count() as u32).map(SurfaceVertex) {
            let is_rim = |&&u: &&SurfaceVertex| edges[&[u.min(v), u.max(v)]] == 1;
            let has_rim = topology.neighbours(v).iter().any(|u| is_rim(&u));
            assert_eq!(topology.is_boundary_vertex(v), has_rim, "{class}");
            let around: Vec<u32> = (0..model.surface.triangles.len() as u32)
                .filter(|&t| model.surface.triangles[t as usize].contains(&v))
                .collect();
            let faces: Vec<u32> = topology.faces(v, &model.surface.triangles).collect();
            assert_eq!(faces, around, "{class}");
        }
        assert_eq!(topology.neighbour_offsets().len(), topology.vertex_count() + 1);
        assert_eq!(topology.neighbour_list().len(), 2 * edges.len());
    }
}

#[test]
fn a_fan_is_the_triangles_of_its_vertex() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let mut regular = 0;
        for v in (0..model.topology.vertex_count() as u32).map(SurfaceVertex) {
            let (kind, fan) = model.topology.fan(v);
            let fan: Vec<SurfaceVertex> = fan.collect();
            let mut sorted = fan.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, model.topology.neighbours(v), "{class}");
            let steps = match kind {
                FanKind::Closed => fan.len(),
                FanKind::Open => fan.len() - 1,
                FanKind::Irregular => continue,
            };
            regular += 1;
            let from_fan: BTreeSet<[SurfaceVertex; 3]> = (0..steps)
                .map(|i| turned([v, fan[i], fan[(i + 1) % fan.len()]]))
                .collect();
            let around = model.topology.faces(v, &model.surface.triangles);
            let from_faces = around.map(|t| turned(model.surface.triangles[t as usize])).collect();
            assert_eq!(from_fan, from_faces, "{class}");
        }
        if class.starts_with("closed") || class.starts_with("open") {
            assert_eq!(regular, model.topology.vertex_count(), "{class}");
        }
    }
}

/// The triangle with its lowest corner first, its direction kept.
fn turned([a, b, c]: [SurfaceVertex; 3]) -> [SurfaceVertex; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[test]
fn shapes_have_the_genus_and_rims_of_their_kind() {
    let euler = |model: &Model| {
        model.surface.positions.len() as i64 - model.topology.edge_count() as i64 + model.surface.triangles.len() as i64
    };
    for (drawn, characteristic, rims) in [
        (shapes::icosphere(2), 2, 0),
        (shapes::uv_sphere(5, 9), 2, 0),
        (shapes::bar(3, 2, 4), 2, 0),
        (shapes::torus(12, 7), 0, 0),
        (shapes::grid(4, 6), 1, 1),
        (shapes::tube(8, 3, 2.0), 0, 2),
    ] {
        let model = shapes::model(drawn);
        assert_eq!(euler(&model), characteristic);
        assert_eq!(model.topology.boundary_loops().len(), rims);
        assert_eq!(model.topology.non_manifold_vertices(), 0);
        assert_eq!(model.topology.misoriented_edges(), 0);
    }
}

#[test]
fn rims_use_every_boundary_edge_once_with_the_hole_on_the_left() {
    // Two cells that touch in a corner make a rim that passes one vertex twice.
    let corner = DAffine3::from_translation(DVec3::new(1.0, 1.0, 0.0));
    let touching = shapes::together(&[shapes::grid(1, 1), shapes::moved(&shapes::grid(1, 1), corner)]);
    for drawn in [shapes::grid(5, 3), shapes::tube(7, 2, 1.0), touching] {
        let model = shapes::model(drawn);
        let of_triangles: BTreeSet<[SurfaceVertex; 2]> = model
            .surface
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        let rims = model.topology.boundary_loops();
        let mut on_rims = BTreeSet::new();
        for rim in &rims {
            let distinct: BTreeSet<_> = rim.iter().collect();
            assert_eq!(distinct.len(), rim.len(), "a loop passes no vertex twice");
            for i in 0..rim.len() {
                let (from, to) = (rim[i], rim[(i + 1) % rim.len()]);
                assert!(of_triangles.contains(&[to, from]) && !of_triangles.contains(&[from, to]));
                assert!(on_rims.insert([from, to]));
            }
        }
        assert_eq!(on_rims.len(), model.topology.boundary_edges());
    }
}

#[test]
fn non_manifold_places_are_counted() {
    let fan = shapes::model(shapes::non_manifold_fan(5));
    assert_eq!(fan.topology.non_manifold_edges(), 1);
    assert_eq!(fan.findings.non_manifold_edges.examples, vec![0]);
    let bowtie = shapes::model(shapes::bowtie());
    assert!(bowtie.topology.is_closed());
    assert_eq!(bowtie.topology.non_manifold_vertices(), 1);
    assert_eq!(bowtie.findings.non_manifold_vertices.examples, vec![0]);
    assert_eq!(bowtie.topology.components().len(), 1);
    let mut turned = shapes::icosphere(1);
    turned.triangles[7].swap(0, 1);
    assert_eq!(shapes::model(turned).topology.misoriented_edges(), 3);
}

#[test]
fn components_stand_by_size_then_by_their_first_file_vertex() {
    let apart = |x: f64| shapes::moved(&shapes::bar(1, 1, 1), DAffine3::from_translation(DVec3::X * x));
    // The second bar in the file is first in space; the sphere is the largest and last.
    let sphere = shapes::moved(&shapes::icosphere(2), DAffine3::from_translation(DVec3::X * 50.0));
    let model = shapes::model(shapes::together(&[apart(20.0), apart(0.0), apart(10.0), sphere]));
    let components = model.topology.components();
    let sizes: Vec<usize> = components.iter().map(|component| component.vertex_count).collect();
    let firsts: Vec<FileVertex> = components.iter().map(|component| component.first_file_vertex).collect();
    assert_eq!(sizes, [162, 8, 8, 8]);
    assert_eq!(firsts, [24, 0, 8, 16].map(FileVertex));
    assert_eq!(
        components.iter().map(|c| c.face_count).sum::<usize>(),
        model.surface.triangles.len()
    );
    for (k, component) in components.iter().enumerate() {
        let mut vertices = model.topology.vertices_of(k as u32);
        assert_eq!(vertices.len(), component.vertex_count);
        assert!(vertices.clone().is_sorted());
        assert!(vertices.all(|v| model.topology.component(v) as usize == k));
    }
}

#[test]
fn a_corner_with_very_many_triangles_is_no_trouble() {
    let model = shapes::model(shapes::uv_sphere(2, 20_000));
    let triangles = &model.surface.triangles;
    let mut corners: Vec<[u32; 2]> = Vec::new();
    for v in (0..model.topology.vertex_count() as u32).map(SurfaceVertex) {
        let around = model.topology.faces(v, triangles);
        corners.extend(around.map(|t| [v.0, t]));
    }
    let own = |(t, corners): (usize, &[SurfaceVertex; 3])| corners.map(|v| [v.0, t as u32]);
    let mut expected: Vec<[u32; 2]> = triangles.iter().enumerate().flat_map(own).collect();
    expected.sort_unstable();
    assert!(corners == expected, "its neighbours' triangles are found among them");
    assert!(model.topology.is_closed());
    assert_eq!(model.topology.non_manifold_vertices(), 0);
    // Two such corners; all other vertices have fans, and normals don't depend on it.
    let all = || (0..model.topology.vertex_count() as u32).map(SurfaceVertex);
    let irregular = all().filter(|&v| model.topology.fan(v).0 == FanKind::Irregular);
    assert_eq!(irregular.count(), 2);
    assert!(!all().any(|v| model.topology.is_boundary_vertex(v)));
    let mut normals = Vec::new();
    let surface = &model.surface;
    vertex_normals(&surface.triangles, &model.topology, &surface.positions, &mut normals);
    for (normal, position) in normals.iter().zip(&surface.positions) {
        assert!(normal.dot(*position) > 0.9, "{normal} at {position}");
    }
}
