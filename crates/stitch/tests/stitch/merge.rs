//! Joining two surfaces.

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Budget, Method};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, shapes};
use pliant_stitch::{Attributes, Borders, Joins, MergeError, Merged, Pair, Part, PlacementOfB, StitchError, merge};

use crate::made::{genus, model, noise, used, without};

fn joined(a: &Model, b: &Model, pairs: &[Pair], method: &str, placement: PlacementOfB) -> Result<Merged, MergeError> {
    let drawn = [a.rest(), b.rest()];
    let part = |side: usize| Part {
        model: [a, b][side],
        drawn: &drawn[side],
        group: &|_| 0,
        attributes: Attributes::NONE,
        normals: None,
    };
    let joins = Joins {
        pairs,
        placement,
        reach: 0.2,
        method: &Method::from_name(method).unwrap(),
    };
    merge(
        [&part(0), &part(1)],
        &joins,
        Budget::default(),
        &Progress::new(),
        &Cancel::new(),
    )
}

/// The joined surface by its numbers in a file without attributes, so that nothing is welded.
fn unwelded(merged: &Merged) -> Model {
    let shape = &merged.shape;
    let mut positions = vec![DVec3::NAN; shape.file_vertex_count];
    for (file, position) in shape.file_vertices.iter().zip(&shape.positions) {
        let there = &mut positions[file.index()];
        assert!(there.is_nan() || *there == *position, "one number, one place");
        *there = *position;
    }
    let corner = |corner: DrawnVertex| DrawnVertex(shape.file_vertices[corner.index()].0);
    let triangles = shape.triangles.iter().map(|corners| corners.map(corner)).collect();
    model(Drawn::once(positions, triangles))
}

fn check_sound(whole: &Model, borders: usize) {
    let topology = &whole.topology;
    assert_eq!(topology.boundary_loops().len(), borders);
    let faults = (
        topology.non_manifold_edges(),
        topology.non_manifold_vertices(),
        topology.misoriented_edges(),
    );
    assert_eq!(faults, (0, 0, 0));
}

/// The two parts of a closed shape on both sides of a plane, each with the vertices that it uses.
fn halves(shape: &Drawn, normal: DVec3, offset: f64) -> [Drawn; 2] {
    let is_above = |p: DVec3| p.dot(normal) > offset;
    [without(shape, is_above), without(shape, |p| !is_above(p))]
}

/// Ten closed shapes.
fn closed_shapes() -> Vec<(&'static str, Drawn)> {
    let bumpy = |mut shape: Drawn, size: f64, seed: u64| {
        for (k, p) in shape.positions.iter_mut().enumerate() {
            *p *= 1.0 + size * noise(seed, k as u64);
        }
        shape
    };
    let stretched = |shape: Drawn, by: DVec3| shapes::moved(&shape, DAffine3::from_scale(by));
    let lumpy = |mut shape: Drawn| {
        for p in &mut shape.positions {
            *p *= 1.0 + 0.3 * (3.0 * p.x + 1.0).sin() * (2.0 * p.y).cos() + 0.1 * (5.0 * p.z).sin();
        }
        shape
    };
    vec![
        ("icosphere", shapes::icosphere(3)),
        ("sphere", shapes::uv_sphere(21, 34)),
        ("ellipsoid", stretched(shapes::icosphere(3), DVec3::new(1.0, 2.3, 0.6))),
        ("torus", shapes::torus(48, 20)),
        ("noisy sphere", bumpy(shapes::icosphere(3), 0.01, 3)),
        ("noisy torus", bumpy(shapes::torus(40, 18), 0.008, 4)),
        ("lumps", lumpy(shapes::icosphere(4))),
        ("noisy lumps", bumpy(lumpy(shapes::icosphere(3)), 0.01, 5)),
        ("bar", shapes::bar(12, 5, 4)),
        (
            "far away",
            shapes::moved(
                &shapes::icosphere(3),
                DAffine3::from_translation(DVec3::new(4e3, -2e3, 7e2)),
            ),
        ),
    ]
}

#[test]
fn halves_of_a_surface_merge_to_it_again() {
    for (name, shape) in closed_shapes() {
        let whole = model(shape.clone());
        let bounds = whole.bounds().unwrap();
        for cut in 0..5_u64 {
            let normal = DVec3::new(noise(11, cut), noise(12, cut), noise(13, cut)).normalize();
            let offset = bounds.centre().dot(normal) + 0.13 * noise(14, cut) * bounds.diagonal();
            let [a, b] = halves(&shape, normal, offset);
            let turn = DQuat::from_scaled_axis(DVec3::new(noise(15, cut), noise(16, cut), noise(17, cut)) * 2.0);
            let shift = DVec3::new(noise(18, cut), noise(19, cut), 1.0) * bounds.diagonal();
            let away = DAffine3::from_rotation_translation(turn, shift + bounds.centre() - turn * bounds.centre());
            let (a, b) = (model(a), model(shapes::moved(&b, away)));
            let pairs = pairs(&a, &b, away);
            let merged = joined(&a, &b, &pairs, "poisson", PlacementOfB::Fitted).unwrap();
            let again = unwelded(&merged);
            check_sound(&again, 0);
            assert_eq!(genus(&again), genus(&whole), "{name} {cut}");
            assert_eq!(
                again.surface.positions.len(),
                whole.surface.positions.len(),
                "{name} {cut}"
            );
            assert_eq!(again.surface.triangles.len(), whole.surface.triangles.len());
            let off = whole
                .surface
                .positions
                .iter()
                .map(|p| nearest(&again.surface.positions, *p))
                .fold(0.0, f64::max);
            assert!(off < 1e-6 * bounds.diagonal(), "{name} {cut}: {off}");
        }
    }
}

fn nearest(points: &[DVec3], point: DVec3) -> f64 {
    points
        .iter()
        .map(|other| other.distance(point))
        .fold(f64::INFINITY, f64::min)
}

/// Three pairs on each border of A.
fn pairs(a: &Model, b: &Model, away: DAffine3) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for border in &Borders::of(a).sound {
        let count = border.vertices.len();
        for k in [0, count / 3, 2 * count / 3] {
            let vertex = border.vertices[k];
            let there = away.transform_point3(a.surface.positions[vertex.index()]);
            let of_b = &b.surface.positions;
            let found = (0..of_b.len()).min_by(|&x, &y| of_b[x].distance(there).total_cmp(&of_b[y].distance(there)));
            let named = [
                a.first_file_vertex(vertex).0,
                b.first_file_vertex(SurfaceVertex(found.unwrap() as u32)).0,
            ];
            pairs.push(Pair {
                named,
                file: named.map(Some),
            });
        }
    }
    pairs
}

#[test]
fn halves_of_irregular_surfaces_merge_without_pairs() {
    let irregular = ["noisy sphere", "noisy torus", "lumps", "noisy lumps"];
    for (name, shape) in closed_shapes().into_iter().filter(|(name, _)| irregular.contains(name)) {
        let whole = model(shape.clone());
        let bounds = whole.bounds().unwrap();
        for cut in 0..5_u64 {
            let normal = DVec3::new(noise(21, cut), noise(22, cut), noise(23, cut)).normalize();
            let [a, b] = halves(&shape, normal, bounds.centre().dot(normal) + 0.05 * noise(24, cut));
            let turn = DQuat::from_scaled_axis(DVec3::new(noise(25, cut), noise(26, cut), noise(27, cut)) * 2.0);
            let away = DAffine3::from_rotation_translation(turn, DVec3::new(3.0, noise(28, cut), 1.0));
            let (a, b) = (model(a), model(shapes::moved(&b, away)));
            let merged = joined(&a, &b, &[], "poisson", PlacementOfB::Fitted).unwrap();
            let again = unwelded(&merged);
            let open = again.topology.boundary_loops().len();
            assert_eq!(open, 0, "{name} {cut}: {:?}", merged.seams);
            let off = whole
                .surface
                .positions
                .iter()
                .map(|p| nearest(&again.surface.positions, *p))
                .fold(0.0, f64::max);
            assert!(off < 1e-6 * bounds.diagonal(), "{name} {cut}: {off}");
        }
    }
}

/// A dome, open below, with its border at `z = 0`.
fn dome(level: u32, radius: f64, squash: f64) -> Drawn {
    let upper = without(&shapes::icosphere(level), |p| p.z < 0.0);
    shapes::moved(
        &upper,
        DAffine3::from_scale(DVec3::new(radius, radius * squash, radius)),
    )
}

#[test]
fn borders_of_other_shapes_and_counts_join_without_a_crack_by_every_method() {
    let below =
        DAffine3::from_translation(DVec3::new(0.15, -0.1, -0.4)) * DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let a = model(dome(4, 1.0, 1.0));
    let mut lower = shapes::moved(&dome(3, 0.8, 1.3), below);
    lower.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let b = model(used(&lower));
    let methods = pliant_deform::METHODS.iter().map(|declaration| declaration.name);
    for method in methods.filter(|method| !["identity", "cage"].contains(method)) {
        for placement in [PlacementOfB::Fitted, PlacementOfB::Kept] {
            let merged = joined(&a, &b, &[], method, placement);
            let merged = merged.unwrap_or_else(|error| panic!("{method}: {error}"));
            let whole = unwelded(&merged);
            check_sound(&whole, 0);
            assert_eq!((genus(&whole), whole.topology.components().len()), (0, 1), "{method}");
            for (v, position) in a.rest_positions().iter().enumerate() {
                assert_eq!(merged.shape.file_vertices[v].0 as usize, v, "A's vertices come first");
                assert!(merged.shape.positions[v].distance(*position) < 0.6, "{method} {v}");
            }
        }
    }
}

/// A has a narrow border far away that is as long as B's, and a wide one where B is.
#[test]
fn a_part_that_stays_is_joined_to_the_border_that_it_is_at() {
    let narrow = shapes::moved(&dome(3, 0.4, 1.0), DAffine3::from_translation(DVec3::X * 1.6));
    let a = model(shapes::together(&[used(&dome(3, 1.0, 1.0)), used(&narrow)]));
    let below = DAffine3::from_translation(DVec3::NEG_Z * 0.1) * DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let mut lower = shapes::moved(&dome(3, 0.42, 1.0), below);
    lower.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let merged = joined(&a, &model(used(&lower)), &[], "poisson", PlacementOfB::Kept).unwrap();
    let whole = unwelded(&merged);
    check_sound(&whole, 1);
    let left = &whole.topology.boundary_loops()[0];
    let middle = left
        .iter()
        .map(|vertex| whole.surface.positions[vertex.index()])
        .sum::<DVec3>()
        / left.len() as f64;
    assert!(middle.distance(DVec3::X * 1.6) < 0.1, "the far one is left: {middle}");
}

#[test]
fn pairs_that_contradict_each_other_are_refused_in_words() {
    let tube = || model(shapes::tube(24, 6, 3.0));
    let (a, b) = (tube(), tube());
    let at = |x: usize, top: bool| (if top { 6 * 24 } else { 0 } + x) as u32;
    let pair = |x, y| Pair {
        named: [x, y],
        file: [Some(x), Some(y)],
    };
    let refused = |pairs: &[Pair]| {
        joined(&a, &b, pairs, "poisson", PlacementOfB::Fitted)
            .unwrap_err()
            .source
    };
    let same = [
        pair(at(0, true), at(0, false)),
        pair(at(8, true), at(8, false)),
        pair(at(16, true), at(16, false)),
    ];
    let merged = joined(&a, &b, &same, "poisson", PlacementOfB::Fitted).unwrap();
    check_sound(&unwelded(&merged), 2);
    let mut crossed = same;
    (crossed[1].file[1], crossed[2].file[1]) = (same[2].file[1], same[1].file[1]);
    assert!(matches!(refused(&crossed), StitchError::PairsOutOfOrder { .. }));
    assert!(matches!(
        refused(&[pair(30, at(0, false))]),
        StitchError::NotOnBorder { vertex: 30 }
    ));
    let other = [same[0], pair(at(8, true), at(8, true))];
    assert!(matches!(refused(&other), StitchError::CrossedBorders { pair: 1, .. }));
    assert!(matches!(
        refused(&[same[0], same[0]]),
        StitchError::TwicePaired { part: "A", .. }
    ));
    let closed = model(shapes::icosphere(2));
    let error = joined(&closed, &b, &[], "poisson", PlacementOfB::Fitted).unwrap_err();
    assert_eq!((error.part, error.source), (0, StitchError::NoBorder));
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let (a, b) = (
        model(dome(4, 1.0, 1.0)),
        model(shapes::moved(&dome(4, 0.9, 1.2), DAffine3::from_rotation_x(3.0))),
    );
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| joined(&a, &b, &[], "poisson", PlacementOfB::Fitted).unwrap().shape)
    };
    let one = with(1);
    assert!(one == with(2) && one == with(3));
}

#[test]
fn teeth_of_both_borders_at_one_place_make_no_doubled_edge() {
    for (name, shape) in closed_shapes() {
        let whole = model(shape.clone());
        let bounds = whole.bounds().unwrap();
        let [a, b] = halves(
            &shape,
            DVec3::new(0.3, 0.2, 0.9).normalize(),
            bounds.centre().dot(DVec3::new(0.3, 0.2, 0.9).normalize()),
        );
        let wider = DAffine3::from_translation(bounds.centre())
            * DAffine3::from_scale(DVec3::new(1.04, 0.97, 1.0))
            * DAffine3::from_translation(-bounds.centre());
        let (a, b) = (model(a), model(shapes::moved(&b, wider)));
        let pairs = pairs(&a, &b, wider);
        let merged = joined(&a, &b, &pairs, "poisson", PlacementOfB::Fitted).unwrap();
        let again = unwelded(&merged);
        check_sound(&again, 0);
        assert_eq!(genus(&again), genus(&whole), "{name}");
    }
}
