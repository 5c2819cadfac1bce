//! Times the work of loading and of a frame on a surface of about a million triangles, indexed and as a soup.
//!
//! `cargo run --release -p pliant-mesh --example timings [rings]`

#![expect(clippy::print_stdout, reason = "a program that tells its figures")]

use std::time::Instant;

use glam::DVec3;
use pliant_mesh::{
    Bvh, Cancel, DistanceSearch, Distortion, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, Topology, WeldOptions,
    mixed_voronoi_areas, shapes, vertex_normals,
};

fn main() {
    let rings = std::env::args()
        .nth(1)
        .and_then(|rings| rings.parse().ok())
        .unwrap_or(707);
    let sphere = shapes::uv_sphere(rings, rings);
    println!(
        "{} vertices, {} triangles",
        sphere.positions.len(),
        sphere.triangles.len()
    );
    let soup = shapes::soup(&sphere);
    let weld = |drawn: Drawn| Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new());
    time("weld, indexed", || {
        weld(sphere.clone())
            .map(|model| model.surface.triangles.len())
            .unwrap_or_default()
    });
    let mixed = shuffled(&sphere);
    time("weld, shuffled", || {
        weld(mixed.clone())
            .map(|model| model.surface.triangles.len())
            .unwrap_or_default()
    });
    time("weld, soup", || {
        weld(soup.clone())
            .map(|model| model.surface.triangles.len())
            .unwrap_or_default()
    });
    time("(copying the indexed input)", || sphere.clone().positions.len());

    let model = weld(mixed).unwrap_or_default();
    let (surface, topology) = (&model.surface, &model.topology);
    time("topology alone", || Topology::of(surface).edge_count());
    time("mixed areas", || mixed_voronoi_areas(surface).len());
    time("rims", || topology.boundary_loops().len());
    time("file table", || {
        model.surface_of_file().of(pliant_mesh::FileVertex(0)).len()
    });
    let mut normals = Vec::new();
    time("normals", || {
        vertex_normals(&surface.triangles, topology, &surface.positions, &mut normals);
        normals.len()
    });
    let displacements = vec![DVec3::splat(0.01); surface.positions.len()];
    let mut drawn = Vec::new();
    time("drawn positions", || {
        model.drawn_positions(&displacements, &mut drawn);
        drawn.len()
    });
    time("distortion", || {
        Distortion::of(surface, topology, &surface.positions).flipped_faces
    });
    time("hierarchy, building", || {
        Bvh::build(&surface.positions, &surface.triangles)
            .ray(DVec3::ZERO, DVec3::X)
            .map_or(0, |hit| hit.triangle as usize)
    });
    let mut bvh = Bvh::build(&surface.positions, &surface.triangles);
    time("hierarchy, refitting", || {
        bvh.refit(|v| 1.5 * surface.positions[v.index()]);
        0
    });
    time("10,000 rays", || {
        (0..10_000)
            .filter(|&i| {
                let target = surface.positions[(i * 97) % surface.positions.len()];
                bvh.ray(DVec3::new(3.0, 2.0, 1.0), target - DVec3::new(3.0, 2.0, 1.0))
                    .is_some()
            })
            .count()
    });
    time("vertices above a plane", || {
        let mut count = 0;
        bvh.vertices_within(&[DVec3::Z.extend(-0.9)], |_, _| count += 1);
        count
    });
    // A sphere that is pressed together until its poles pass through each other, as can happen to a bent limb.
    let pressed = |v: SurfaceVertex| {
        let p = surface.positions[v.index()];
        let pole = (1.0 - 4.0 * p.truncate().length_squared()).max(0.0);
        DVec3::new(p.x, p.y, p.z - 1.2 * p.z.signum() * pole)
    };
    bvh.refit(pressed);
    time("passing through itself", || {
        let found = bvh.new_self_intersections(surface, topology, 200_000, &Progress::new(), &Cancel::new());
        found.map_or(0, |found| found.pairs.len())
    });
    bvh.refit(|v| 1.5 * surface.positions[v.index()]);
    time("all moved, none passing", || {
        let found = bvh.new_self_intersections(surface, topology, 200_000, &Progress::new(), &Cancel::new());
        found.map_or(0, |found| found.pairs.len())
    });
    let mut search = DistanceSearch::default();
    let limits = [("distances within 0.1", 0.1), ("distances everywhere", f64::INFINITY)];
    for (what, limit) in limits {
        time(what, || {
            let position = |v: SurfaceVertex| surface.positions[v.index()];
            let seeds = [(SurfaceVertex(7), 0.0)];
            search
                .within(&surface.triangles, topology, position, &seeds, limit)
                .len()
        });
    }
}

/// Prints the median of five runs, and returns the last one's result.
fn time(what: &str, mut work: impl FnMut() -> usize) {
    let mut last = 0;
    let mut ms: Vec<f64> = (0..5)
        .map(|_| {
            let start = Instant::now();
            last = work();
            1e3 * start.elapsed().as_secs_f64()
        })
        .collect();
    ms.sort_by(f64::total_cmp);
    println!("{what:28} {:9.3} ms   ({last})", ms[2]);
}

/// The same mesh with its vertices and triangles in random order.
fn shuffled(shape: &Drawn) -> Drawn {
    let order = |count: usize| {
        let mut order: Vec<u32> = (0..count as u32).collect();
        order.sort_by_key(|&i| (u64::from(i) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 20);
        order
    };
    let of_new = order(shape.positions.len());
    let mut of_old = vec![0; of_new.len()];
    for (new, &old) in (0..).zip(&of_new) {
        of_old[old as usize] = new;
    }
    let positions = of_new.iter().map(|&old| shape.positions[old as usize]).collect();
    let triangles = order(shape.triangles.len())
        .into_iter()
        .map(|t| shape.triangles[t as usize].map(|v| DrawnVertex(of_old[v.index()])))
        .collect();
    Drawn::once(positions, triangles)
}
