//! Welding joins vertices in one place, leaves out faulty geometry, and reports it.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use glam::{DAffine3, DVec3};
use pliant_mesh::{
    Cancel, Cancelled, Drawn, DrawnVertex, FileVertex, Model, Progress, Rounding, SurfaceVertex, WeldOptions, shapes,
};

fn weld(drawn: Drawn, distance: Option<f64>) -> Model {
    Model::weld(drawn, &WeldOptions { distance }, &Progress::new(), &Cancel::new()).unwrap()
}

/// A number between -1 and 1 that depends only on `seed`.
fn noise(seed: usize) -> f64 {
    let bits = (seed as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let bits = (bits ^ bits >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn noise3(seed: usize) -> DVec3 {
    DVec3::new(noise(3 * seed), noise(3 * seed + 1), noise(3 * seed + 2))
}

#[test]
fn the_surface_keeps_its_promises_on_every_class() {
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let surface = &model.surface;
        let mut is_used = vec![false; surface.positions.len()];
        let mut seen = std::collections::BTreeSet::new();
        for &triangle in &surface.triangles {
            let mut sorted = triangle;
            sorted.sort_unstable();
            assert!(
                sorted[0] < sorted[1] && sorted[1] < sorted[2],
                "{class}: corners differ"
            );
            assert!(seen.insert(sorted), "{class}: no triangle twice");
            for v in triangle {
                is_used[v.index()] = true;
            }
        }
        let first_bare = model.topology.bare_points().start;
        assert!(
            is_used.iter().enumerate().all(|(v, &used)| used == (v < first_bare)),
            "{class}: bare points come last, and every other vertex is used"
        );
        assert!(surface.positions.iter().all(|p| p.is_finite()), "{class}");
        let drawn_triangles = model.drawn_triangles();
        for (t, &drawn_triangle) in model.drawn.triangle_of_surface().iter().enumerate() {
            let corners = drawn_triangles[drawn_triangle as usize];
            assert_eq!(corners, model.drawn_corners(t), "{class}");
            assert_eq!(
                corners.map(|v| model.drawn.surface_vertex(v)),
                surface.triangles[t].map(Some),
                "{class}: corner for corner"
            );
        }
    }
}

#[test]
fn a_soup_welds_into_the_shape_it_was_cut_from() {
    for (class, drawn) in shapes::classes() {
        if matches!(class, "broken" | "soup") {
            continue;
        }
        let whole = shapes::model(drawn.clone());
        let soup = shapes::model(shapes::soup(&drawn));
        assert_eq!(soup.surface.positions, whole.surface.positions, "{class}");
        assert_eq!(soup.surface.triangles, whole.surface.triangles, "{class}");
        assert_eq!(soup.topology.edge_count(), whole.topology.edge_count(), "{class}");
    }
}

#[test]
fn corners_within_the_tolerance_join_wherever_they_lie() {
    let sphere = shapes::uv_sphere(40, 40);
    for tolerance in [1e-9, 1e-7, 1e-5, 1e-4] {
        for offset in [DVec3::ZERO, DVec3::new(0.1234, -0.777, 0.501)] {
            let mut soup = shapes::soup(&shapes::moved(&sphere, DAffine3::from_translation(offset)));
            let diagonal = 2.0 * 3.0_f64.sqrt();
            for (i, p) in soup.positions.iter_mut().enumerate() {
                // Two corners of one vertex are then closer than the tolerance.
                *p += noise3(i) * (0.2 * tolerance * diagonal);
            }
            let model = weld(soup.clone(), Some(tolerance * diagonal));
            assert_eq!(model.surface.positions.len(), sphere.positions.len(), "{tolerance}");
            assert!(model.topology.is_closed(), "{tolerance}");
            let apart = weld(soup, Some(0.0));
            assert!(apart.surface.positions.len() > 2 * sphere.positions.len());
        }
    }
}

#[test]
fn joining_agrees_with_comparing_all_pairs() {
    // Clusters and single vertices at every scale, also on the walls of cells.
    let mut positions = vec![DVec3::ZERO, DVec3::ONE];
    for i in 0..300 {
        let at = (noise3(i) * 8.0).round() / 16.0 + DVec3::splat(0.5);
        positions.push((at + noise3(i + 1000) * 10f64.powi(-5 - (i as i32 % 4))).clamp(DVec3::ZERO, DVec3::ONE));
    }
    let triangles = (0..positions.len() as u32)
        .map(|v| [v, (v * 7 + 1) % 302, (v * 11 + 3) % 302].map(DrawnVertex))
        .collect();
    let drawn = Drawn::once(positions.clone(), triangles);
    let tolerance = 1e-6;
    let model = weld(drawn, Some(tolerance));
    // The greedy rule, in plain code.
    let mut representative: Vec<usize> = Vec::new();
    for i in 0..positions.len() {
        let distance = |j: &usize| positions[*j].distance(positions[i]);
        let near = (0..i).filter(|j| representative[*j] == *j && distance(j) <= tolerance);
        let near = near.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        representative.push(near.unwrap_or(i));
    }
    assert!((0..positions.len()).any(|i| representative[i] != i));
    for i in 0..positions.len() {
        for j in 0..i {
            let [a, b] = [i, j].map(|v| model.drawn.surface_vertex(DrawnVertex(v as u32)));
            let (Some(a), Some(b)) = (a, b) else { continue };
            assert_eq!(a == b, representative[i] == representative[j], "{i} {j}");
        }
    }
}

/// A soup whose corners are as far apart as single precision puts them, beside parts that must not change its welding.
fn shaken_soup(shape: &Drawn, by: f64) -> Drawn {
    let mut soup = shapes::soup(shape);
    for (i, p) in soup.positions.iter_mut().enumerate() {
        *p += noise3(i) * by;
    }
    soup
}

/// A triangle this large and this far away.
fn speck(size: f64, at: DVec3) -> Drawn {
    let corners = vec![at, at + DVec3::X * size, at + DVec3::Y * size];
    Drawn::once(corners, vec![[0, 1, 2].map(DrawnVertex)])
}

#[test]
fn specks_and_the_place_of_a_scene_change_nothing_of_how_it_is_welded() {
    let sphere = shapes::uv_sphere(40, 40);
    let soup = shaken_soup(&sphere, 5e-8);
    let specks = [
        speck(1.0, DVec3::splat(1e3)),
        speck(1e-3, DVec3::splat(-1e12)),
        speck(1e7, DVec3::X * 1e9),
        // Two corners in one place far away, as exporters leave them.
        Drawn::once(
            vec![DVec3::splat(1e7), DVec3::splat(1e7), sphere.positions[3]],
            vec![[0, 1, 2].map(DrawnVertex)],
        ),
    ];
    let whole = weld(soup.clone(), None);
    assert_eq!(whole.surface.positions.len(), sphere.positions.len());
    let surface_vertices = |model: &Model| -> Vec<Option<DVec3>> {
        let of_soup = (0..soup.positions.len() as u32).map(DrawnVertex);
        let first = |v: SurfaceVertex| model.surface.positions[v.index()];
        of_soup.map(|v| model.drawn.surface_vertex(v).map(first)).collect()
    };
    let expected = surface_vertices(&whole);
    for speck in &specks {
        let beside = weld(shapes::together(&[soup.clone(), speck.clone()]), None);
        assert!(surface_vertices(&beside) == expected);
    }
    let all = shapes::together(&[std::slice::from_ref(&soup), &specks[..]].concat());
    assert!(surface_vertices(&weld(all, None)) == expected);
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    for scale in [1e-9, 0.37, 1e12] {
        let motion =
            DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, DVec3::new(2.0, -1.0, 5.0) * scale);
        let model = weld(shapes::moved(&soup, motion), None);
        assert_eq!(model.surface.positions.len(), sphere.positions.len(), "{scale}");
        assert!(model.topology.is_closed());
    }
}

#[test]
fn parts_a_million_times_finer_than_their_scene_stay_as_they_are() {
    // The fine part's vertices are closer together than those of the coarse part are joined.
    let coarse = shaken_soup(&shapes::icosphere(1), 1e-6);
    let fine = shapes::moved(
        &shapes::icosphere(3),
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(1e-7),
            glam::DQuat::IDENTITY,
            shapes::icosphere(1).positions[0],
        ),
    );
    let model = weld(shapes::together(&[coarse, fine.clone()]), None);
    let vertices = shapes::icosphere(1).positions.len() + fine.positions.len();
    assert_eq!(model.surface.positions.len(), vertices);
    assert_eq!(model.topology.components().len(), 2);
    // A strip whose triangles are twenty thousand times as wide as it is long between two vertices.
    let strip = shapes::grid(20_000, 1);
    assert_eq!(weld(strip.clone(), None).surface.positions.len(), strip.positions.len());
    assert_eq!(
        weld(shapes::soup(&strip), None).surface.positions.len(),
        strip.positions.len()
    );
    // A thin closed plate, cut into single triangles: its sides don't become one.
    let plate = shapes::moved(&shapes::bar(2, 2, 1), DAffine3::from_scale(DVec3::new(1.0, 1.0, 2e-5)));
    let model = weld(shapes::soup(&plate), None);
    assert_eq!(model.surface.positions.len(), plate.positions.len());
    assert!(model.topology.is_closed());
}

/// A shape of about unit size in slices along z, each rounded to a grid of its own.
fn rounded_apart(shape: &Drawn, slices: usize, step: impl Fn(usize) -> f64) -> Drawn {
    let slice_of = |t: &[DrawnVertex; 3]| {
        let z: f64 = t.iter().map(|v| shape.positions[v.index()].z).sum();
        ((z + 3.1) / 6.2 * slices as f64) as usize
    };
    let of_slice = |slice: usize| {
        let triangles = shape.triangles.iter().copied().filter(|t| slice_of(t) == slice);
        let mut part = shapes::soup(&Drawn {
            triangles: triangles.collect(),
            ..shape.clone()
        });
        let step = step(slice);
        let origin = DVec3::new(0.123, -0.456, 0.0789) * (slice + 1) as f64;
        for p in &mut part.positions {
            *p = ((*p - origin) / step).round() * step + origin;
        }
        part.roundings = vec![Rounding {
            vertices: 0..part.positions.len() as u32,
            distance: 0.5 * step * 3.0_f64.sqrt(),
        }];
        part
    };
    shapes::together(&(0..slices).map(of_slice).collect::<Vec<_>>())
}

#[test]
fn slices_that_were_rounded_apart_are_one_surface_again() {
    for shape in [shapes::icosphere(3), shapes::torus(40, 20), shapes::uv_sphere(30, 50)] {
        for coarsest in [1e-5, 1e-3, 0.01] {
            let drawn = rounded_apart(&shape, 5, |slice| coarsest / (slice + 1) as f64);
            let model = weld(drawn.clone(), None);
            assert_eq!(model.surface.positions.len(), shape.positions.len(), "{coarsest}");
            assert_eq!(model.surface.triangles.len(), shape.triangles.len(), "{coarsest}");
            assert!(model.topology.is_closed());
            let untold = Drawn {
                roundings: Vec::new(),
                ..drawn
            };
            assert!(!weld(untold.clone(), Some(0.0)).topology.is_closed());
            // Twice the coarsest one is more than some edges.
            if coarsest < 0.01 {
                let given = weld(untold, Some(1.8 * coarsest));
                assert_eq!(given.surface.positions.len(), shape.positions.len(), "{coarsest}");
            }
        }
    }
}

#[test]
fn what_was_rounded_together_stays_apart_and_so_do_layers() {
    // Neighbours one step apart in one run.
    let step = 1.0 / 40.0;
    let sheet = shapes::grid(40, 40);
    let rounded = |z: f64, start: u32| {
        let mut layer = shapes::moved(&sheet, DAffine3::from_translation(DVec3::Z * z));
        layer.roundings = vec![Rounding {
            vertices: start..start + sheet.positions.len() as u32,
            distance: step,
        }];
        layer
    };
    let alone = weld(rounded(0.0, 0), None);
    assert_eq!(alone.surface.positions.len(), sheet.positions.len());
    // Two closed shapes, one within the other at less than a step, share no border.
    let mut balls: Vec<Drawn> = [1.0, 1.0 + 1e-3]
        .map(|radius| shapes::moved(&shapes::icosphere(3), DAffine3::from_scale(DVec3::splat(radius))))
        .to_vec();
    for ball in &mut balls {
        ball.roundings = vec![Rounding {
            vertices: 0..ball.positions.len() as u32,
            distance: 2e-3,
        }];
    }
    let model = weld(shapes::together(&balls), None);
    assert_eq!(model.topology.components().len(), 2);
}

#[test]
fn a_distance_beyond_the_scene_flattens_no_well_shaped_triangles() {
    for shape in [shapes::icosphere(3), shapes::grid(9, 7), shapes::bar(5, 3, 2)] {
        for drawn in [shape.clone(), shapes::soup(&shape)] {
            let model = weld(drawn, Some(1e9));
            assert_eq!(model.surface.positions.len(), shape.positions.len());
            assert_eq!(model.surface.triangles.len(), shape.triangles.len());
        }
    }
}

#[test]
fn minus_zero_is_zero_and_keeps_its_bits_in_the_drawn_set() {
    let mut drawn = shapes::soup(&shapes::grid(2, 2));
    for (i, p) in drawn.positions.iter_mut().enumerate() {
        p.z = if i % 2 == 0 { -0.0 } else { 0.0 };
    }
    for distance in [Some(0.0), None] {
        let model = weld(drawn.clone(), distance);
        assert_eq!(model.surface.positions.len(), 9);
        let mut out = Vec::new();
        model.drawn_positions(&vec![DVec3::ZERO; 9], &mut out);
        for (moved, rest) in out.iter().zip(&drawn.positions) {
            assert_eq!(moved.to_array().map(f64::to_bits), rest.to_array().map(f64::to_bits));
        }
    }
}

#[test]
fn everything_broken_is_left_out_or_kept_and_counted() {
    let shape = shapes::icosphere(1);
    let broken = shapes::broken(&shape);
    let (vertices, triangles) = (shape.positions.len() as u32, shape.triangles.len() as u32);
    let model = shapes::model(broken);
    let findings = &model.findings;
    let one = |example: u32| (1, vec![example]);
    let told = |finding: &pliant_mesh::Finding| (finding.count, finding.examples.clone());
    assert_eq!(told(&findings.non_finite_vertices), one(vertices));
    assert_eq!(told(&findings.non_finite_triangles), one(triangles));
    assert_eq!(told(&findings.unreferenced_vertices), one(vertices + 1));
    assert_eq!(told(&findings.collapsed_triangles), one(triangles + 1));
    assert_eq!(told(&findings.duplicate_triangles), one(triangles + 2));
    assert_eq!(told(&findings.zero_area_triangles), one(triangles + 3));
    assert_eq!(findings.non_manifold_edges.count, 1);
    assert_eq!(model.surface.triangles.len(), shape.triangles.len() + 1);
    assert_eq!(model.topology.bare_points().start, shape.positions.len() + 1);
    assert_eq!(model.drawn.surface_vertex(DrawnVertex(vertices)), None);
    let alone = model.drawn.surface_vertex(DrawnVertex(vertices + 1));
    assert_eq!(alone.map(SurfaceVertex::index), Some(shape.positions.len() + 1));
    assert_eq!(model.surface.positions.len(), shape.positions.len() + 2);
    assert_eq!(findings.sentences().len(), 8, "{:#?}", findings.sentences());
    assert_eq!(shapes::model(shape).findings.sentences(), Vec::<String>::new());
}

#[test]
fn files_without_a_usable_triangle_give_their_finite_points() {
    let nan = Drawn::once(vec![DVec3::NAN; 3], vec![[0, 1, 2].map(DrawnVertex)]);
    let point = Drawn::once(vec![DVec3::ONE; 3], vec![[0, 1, 2].map(DrawnVertex)]);
    let huge = Drawn::once(
        vec![DVec3::ONE, DVec3::splat(1e300), DVec3::X],
        vec![[0, 1, 2].map(DrawnVertex)],
    );
    let lone = Drawn::once(vec![DVec3::ONE], vec![]);
    for (drawn, points) in [(Drawn::default(), 0), (nan, 0), (point, 1), (huge, 2), (lone, 1)] {
        let model = shapes::model(drawn);
        assert!(model.surface.triangles.is_empty());
        assert_eq!(model.topology.bare_points(), 0..points);
        assert_eq!(model.topology.components().len(), points);
        assert_eq!(model.bounds().is_some(), points > 0);
        assert_eq!(model.findings.components.count, 0, "parts are made of triangles");
        let mut out = Vec::new();
        model.drawn_positions(&vec![DVec3::ZERO; points], &mut out);
        assert_eq!(out.len(), model.drawn.vertex_count());
    }
}

#[test]
fn twins_move_alike_and_others_stay() {
    let model = shapes::model(shapes::broken(&shapes::uv_sphere(6, 6)));
    let displacements: Vec<DVec3> = (0..model.surface.positions.len()).map(noise3).collect();
    let mut out = Vec::new();
    model.drawn_positions(&displacements, &mut out);
    let rest = model.rest_positions();
    for (i, surface_vertex) in model.drawn.surface_vertices().enumerate() {
        let rest = rest[i];
        match surface_vertex {
            Some(v) => assert_eq!(out[i], rest + displacements[v.index()]),
            None => assert_eq!(out[i].to_array().map(f64::to_bits), rest.to_array().map(f64::to_bits)),
        }
    }
}

#[test]
fn a_file_vertex_shown_twice_has_two_surface_vertices() {
    let bar = shapes::bar(1, 1, 1);
    let count = bar.positions.len();
    let mut twice = shapes::together(&[
        bar.clone(),
        shapes::moved(&bar, DAffine3::from_translation(DVec3::X * 5.0)),
    ]);
    twice.file_vertex = (0..2 * count as u32).map(|v| FileVertex(v % count as u32)).collect();
    twice.file_vertex_count = count;
    let model = shapes::model(twice);
    let table = model.surface_of_file();
    for v in 0..count {
        let both = table.of(FileVertex(v as u32));
        assert_eq!(both.len(), 2);
        let apart = model.surface.positions[both[1].index()] - model.surface.positions[both[0].index()];
        assert_eq!(apart.abs(), DVec3::X * 5.0);
    }
    assert_eq!(table.of(FileVertex(count as u32)), &[] as &[SurfaceVertex]);
    assert_eq!(model.topology.components().len(), 2);
    assert_eq!(model.topology.components()[1].first_file_vertex, FileVertex(0));
}

#[test]
fn neighbours_on_the_surface_are_neighbours_in_memory() {
    let model = shapes::model(shapes::uv_sphere(60, 60));
    let count = model.surface.positions.len() as u32;
    let near = model.topology.edges().filter(|[a, b]| b.0 - a.0 < count / 8).count();
    assert!(near * 10 > model.topology.edge_count() * 8);
}

#[test]
fn a_cancelled_weld_gives_nothing_and_progress_ends_at_one() {
    let cancel = Cancel::new();
    cancel.cancel();
    let drawn = shapes::grid(3, 3);
    let cancelled = Model::weld(drawn.clone(), &WeldOptions::default(), &Progress::new(), &cancel);
    assert_eq!(cancelled.err(), Some(Cancelled));
    let progress = Progress::new();
    Model::weld(drawn, &WeldOptions::default(), &progress, &Cancel::new()).unwrap();
    assert_eq!(progress.get(), 1.0);
}
