//! Filling holes.

use glam::DVec3;
use pliant_deform::Budget;
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, shapes};
use pliant_stitch::{Filled, FilledHole, Holes, StitchError, fill};

use crate::made::{genus, model, noise, without};

fn filled(model: &Model, holes: Holes) -> Filled {
    fill(model, holes, Budget::default(), &Progress::new(), &Cancel::new()).unwrap()
}

/// The surface with its patches, as positions and triangles.
pub fn with_patches(model: &Model, filled: &Filled) -> Drawn {
    let mut positions = model.surface.positions.clone();
    let mut triangles: Vec<[u32; 3]> = model.surface.triangles.iter().map(|t| t.map(|v| v.0)).collect();
    for hole in &filled.holes {
        let first = positions.len() as u32;
        positions.extend(&hole.points);
        let rim: Vec<u32> = hole
            .borders
            .iter()
            .flat_map(|border| &border.vertices)
            .map(|v| v.0)
            .collect();
        let number = |corner: u32| match rim.get(corner as usize) {
            Some(&vertex) => vertex,
            None => first + corner - rim.len() as u32,
        };
        triangles.extend(hole.triangles.iter().map(|corners| corners.map(number)));
    }
    Drawn::once(positions, triangles.into_iter().map(|t| t.map(DrawnVertex)).collect())
}

/// The largest angle in degrees across an edge of a filled hole's rim.
fn crease(model: &Model, filled: &Filled, hole: &FilledHole) -> f64 {
    let whole = shapes::model(with_patches(model, filled));
    let corner = |v: pliant_mesh::SurfaceVertex| whole.surface.positions[v.index()];
    let normal = |face: u32| {
        let [a, b, c] = whole.surface.triangles[face as usize].map(corner);
        (b - a).cross(c - a).normalize()
    };
    let rim = hole.borders[0].vertices.iter();
    let rim: Vec<DVec3> = rim.map(|v| model.surface.positions[v.index()]).collect();
    let is_rim = |v: pliant_mesh::SurfaceVertex| rim.contains(&corner(v));
    let mut worst: f64 = 0.0;
    for [a, b] in whole.topology.edges().filter(|edge| edge.iter().all(|v| is_rim(*v))) {
        let faces: Vec<u32> = whole
            .topology
            .faces(a, &whole.surface.triangles)
            .filter(|&f| whole.surface.triangles[f as usize].contains(&b))
            .collect();
        if let [one, two] = faces[..] {
            worst = worst.max(normal(one).angle_between(normal(two)).to_degrees());
        }
    }
    worst
}

/// The largest angle in degrees across any edge of a surface.
fn sharpest(model: &Model) -> f64 {
    let (surface, topology) = (&model.surface, &model.topology);
    let normal = |face: u32| {
        let [a, b, c] = surface.corners(face as usize);
        (b - a).cross(c - a).normalize()
    };
    let mut worst: f64 = 0.0;
    for [a, b] in topology.edges() {
        let around = topology.faces(a, &surface.triangles);
        let faces: Vec<u32> = around
            .filter(|&face| surface.triangles[face as usize].contains(&b))
            .collect();
        if let [one, two] = faces[..] {
            worst = worst.max(normal(one).angle_between(normal(two)).to_degrees());
        }
    }
    worst
}

fn check_closed(model: &Model, filled: &Filled, open: usize, handles: i64) {
    let whole = shapes::model(with_patches(model, filled));
    let topology = &whole.topology;
    assert_eq!(topology.boundary_loops().len(), open);
    assert_eq!((topology.non_manifold_edges(), topology.misoriented_edges()), (0, 0));
    assert!(topology.non_manifold_vertices() <= model.topology.non_manifold_vertices());
    assert_eq!(genus(&whole), handles);
}

#[test]
fn a_cap_of_a_sphere_comes_back() {
    for (level, cos) in [(3, 0.9), (4, 0.9), (4, 0.8), (5, 0.7)] {
        let sphere = without(&shapes::icosphere(level), |p| {
            p.normalize().dot(DVec3::new(0.3, 0.4, 0.85).normalize()) > cos
        });
        let model = model(sphere);
        let filled = filled(&model, Holes::Every);
        check_closed(&model, &filled, 0, 0);
        let diameter = 2.0 * (1.0_f64 - cos * cos).sqrt();
        let off = filled.holes[0]
            .points
            .iter()
            .map(|p| (p.length() - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(crease(&model, &filled, &filled.holes[0]) < sharpest(&model) + 3.0);
        assert!(off < 0.02 * diameter, "{off} of {diameter}");
    }
}

#[test]
fn a_cylinder_and_a_saddle_come_back() {
    let across = 1.0;
    let open = without(&shapes::tube(96, 80, 5.0), |p| {
        p.distance(DVec3::new(1.0, 0.0, 2.5)) < across / 2.0
    });
    let open = model(open);
    let patch = filled(&open, Holes::Largest(3));
    let inner = patch
        .holes
        .iter()
        .find(|hole| {
            hole.borders[0]
                .vertices
                .iter()
                .all(|v| open.surface.positions[v.index()].x > 0.5)
        })
        .unwrap();
    let off = inner
        .points
        .iter()
        .map(|p| (p.truncate().length() - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(off < 0.01 * across);
    assert!(crease(&open, &patch, inner) < sharpest(&open) + 3.0);

    let mut saddle = shapes::grid(60, 60);
    let height = |p: DVec3| 0.5 * (p.x * p.x - p.y * p.y);
    for p in &mut saddle.positions {
        *p = *p * 2.0 - DVec3::new(1.0, 1.0, 0.0);
        p.z = height(*p);
    }
    let open = model(without(&saddle, |p| p.length() < across / 2.0));
    let patch = filled(&open, Holes::Largest(2));
    let inner = &patch.holes[1];
    let off = inner
        .points
        .iter()
        .map(|p| (p.z - height(*p)).abs())
        .fold(0.0, f64::max);
    assert!(off < 0.01 * across);
    assert!(crease(&open, &patch, inner) < sharpest(&open) + 3.0);
}

#[test]
fn a_noisy_sphere_with_many_holes_becomes_closed() {
    let mut sphere = shapes::icosphere(5);
    for (k, p) in sphere.positions.iter_mut().enumerate() {
        *p *= 1.0 + 0.004 * noise(7, k as u64);
    }
    let centres: Vec<DVec3> = (0..40)
        .map(|k| DVec3::new(noise(1, k), noise(2, k), noise(3, k)).normalize())
        .collect();
    let holey = model(without(&sphere, |p| {
        centres.iter().any(|c| p.normalize().distance(*c) < 0.08)
    }));
    let patches = filled(&holey, Holes::Every);
    let open = patches.unfilled.iter().map(|unfilled| unfilled.count).sum();
    check_closed(&holey, &patches, open, 0);
    assert!(patches.holes.iter().all(|hole| hole.is_faired));
}

#[test]
fn rims_of_hundreds_of_edges_and_slits_are_filled() {
    let bowl = model(without(&shapes::uv_sphere(120, 400), |p| p.z > 0.3));
    let patch = filled(&bowl, Holes::Every);
    assert!(patch.holes[0].borders[0].vertices.len() > 390);
    check_closed(&bowl, &patch, 0, 0);
    let slit = model(without(&shapes::uv_sphere(90, 300), |p| p.z.abs() < 0.03 && p.x > -0.6));
    let patch = filled(&slit, Holes::Every);
    check_closed(&slit, &patch, 0, 0);
    let off = patch.holes[0]
        .points
        .iter()
        .map(|p| (p.length() - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(off < 0.01, "{off}");
}

/// The shape of a large patch is found with few points; it is the same as that of a small one.
#[test]
fn a_cap_comes_back_for_any_number_of_edges_of_its_rim() {
    let patch_of = |count: usize| {
        let open = model(without(&shapes::uv_sphere(count / 3, count), |p| p.z > 0.85));
        let filled = filled(&open, Holes::Every);
        check_closed(&open, &filled, 0, 0);
        filled.holes.into_iter().next().unwrap()
    };
    let diameter = 2.0 * (1.0_f64 - 0.85 * 0.85).sqrt();
    for (count, least) in [(60, 0), (240, 0), (700, 8_000)] {
        let hole = patch_of(count);
        let off = hole.points.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 0.02 * diameter, "{count}: {off}");
        assert!(hole.points.len() > least, "{count}: {}", hole.points.len());
    }
}

/// Needle edges in a rim don't ask for a patch of millions of points.
#[test]
fn a_rim_with_needle_edges_gets_a_patch_of_its_own_order() {
    let angles: Vec<f64> = (0..24)
        .flat_map(|k| {
            let angle = f64::from(k) * std::f64::consts::TAU / 24.0;
            if k % 8 == 0 {
                vec![angle, angle + 1e-4]
            } else {
                vec![angle]
            }
        })
        .collect();
    let count = angles.len() as u32;
    let ring = |z: f64| angles.iter().map(move |angle| DVec3::new(angle.cos(), angle.sin(), z));
    let positions: Vec<DVec3> = (0..4).flat_map(|row| ring(1e-3 * f64::from(row))).collect();
    let square = |k: u32| {
        let (row, here) = (k / count * count, k % count);
        let next = (here + 1) % count;
        let [a, b, c, d] = [row + here, row + next, row + count + next, row + count + here];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..3 * count).flat_map(square).map(|t| t.map(DrawnVertex)).collect();
    let tube = model(Drawn::once(positions, triangles));
    let patches = filled(&tube, Holes::Every);
    assert_eq!(patches.holes.len(), 2);
    for hole in &patches.holes {
        let rim = hole.borders[0].vertices.len();
        assert!(hole.triangles.len() < 2 * rim * rim, "{}", hole.triangles.len());
    }
}

#[test]
fn each_class_of_surfaces_is_filled_or_refused_and_bits_do_not_depend_on_threads() {
    for (name, shape) in shapes::classes() {
        let open = model(without(&shape, |p| p.x > 0.0 && p.y > 0.1));
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| fill(&open, Holes::Every, Budget::default(), &Progress::new(), &Cancel::new()))
        };
        let one = with(1);
        assert!(one == with(2) && one == with(3), "{name}");
        if let Ok(patches) = one {
            let whole = shapes::model(with_patches(&open, &patches));
            let before = open.topology.non_manifold_edges();
            assert!(whole.topology.non_manifold_edges() <= before, "{name}");
            assert!(whole.surface.positions.iter().all(|p| p.is_finite()), "{name}");
        }
    }
}

#[test]
fn a_vertex_names_its_hole_and_a_stranger_is_refused() {
    let tube = model(shapes::tube(20, 4, 2.0));
    let one = filled(&tube, Holes::At(3));
    assert_eq!(one.holes.len(), 1);
    check_closed(&tube, &one, 1, 0);
    let refused = |holes| fill(&tube, holes, Budget::default(), &Progress::new(), &Cancel::new()).unwrap_err();
    assert_eq!(refused(Holes::At(45)), StitchError::NotOnBorder { vertex: 45 });
    assert!(matches!(
        refused(Holes::At(10_000)),
        StitchError::NoVertex { vertex: 10_000, .. }
    ));
}
