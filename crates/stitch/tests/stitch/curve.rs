//! Cutting along curves on the surface.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec2, DVec3};
use pliant_mesh::{Bvh, Drawn, DrawnVertex, Model, shapes};
use pliant_stitch::{Age, Keep, NewShape, Sight, StitchError, SurfaceCurve, VertexSource};

use crate::made::{genus, noise, with_coloured};

/// Cuts a shape whose vertices have their coordinates as colours.
fn cut(model: &Model, curve: &SurfaceCurve, keep: Keep) -> Result<NewShape, StitchError> {
    with_coloured(model, |part| NewShape::cut_along_curve(part, curve, keep, &[]))
}

fn drawn(shapes: &[&NewShape]) -> Drawn {
    let parts: Vec<Drawn> = shapes
        .iter()
        .map(|shape| Drawn {
            positions: shape.positions.clone(),
            triangles: shape.triangles.clone(),
            file_vertex: shape.file_vertices.clone(),
            file_vertex_count: shape.file_vertex_count,
            ..Drawn::default()
        })
        .collect();
    shapes::together(&parts)
}

fn area(model: &Model) -> f64 {
    let areas = (0..model.surface.triangles.len()).map(|face| {
        let [a, b, c] = model.surface.corners(face);
        0.5 * (b - a).cross(c - a).length()
    });
    areas.sum()
}

/// A wavy ring in the picture of an eye far along `sight`, around the picture of a point; laid onto the surface.
/// `None` if the surface is not under all of it.
fn ring(model: &Model, middle: DVec3, sight: DVec3, radius: f64, seed: u64) -> Option<SurfaceCurve> {
    let bvh = Bvh::build(&model.surface.positions, &model.surface.triangles);
    let (u, v) = sight.any_orthonormal_pair();
    let far = 4.0 * model.bounds()?.diagonal();
    let points = (0..24).map(|step| {
        let angle = TAU * f64::from(step) / 24.0;
        let out = radius * (1.0 + 0.3 * noise(seed, step as u64));
        let from = middle + out * (u * angle.cos() + v * angle.sin()) - far * sight;
        bvh.ray(from, sight).map(|hit| from + hit.distance * sight)
    });
    Some(SurfaceCurve {
        points: points.collect::<Option<_>>()?,
        is_closed: true,
        sight: Sight::Along(sight),
    })
}

/// The distance of a point from the picture of a curve.
fn beside(curve: &SurfaceCurve, point: DVec3) -> f64 {
    let Sight::Along(sight) = curve.sight else {
        unreachable!()
    };
    let (u, v) = sight.any_orthonormal_pair();
    let picture = |p: DVec3| DVec2::new(p.dot(u), p.dot(v));
    let next = curve.points.iter().cycle().skip(1);
    let distances = curve.points.iter().zip(next).map(|(from, to)| {
        let (a, b, p) = (picture(*from), picture(*to), picture(point));
        let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, share))
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// New vertices lie on the curve and have the numbers of their places, the sides together are the whole surface, and no
/// area is lost.
#[test]
fn the_sides_of_a_curve_are_the_surface_and_their_borders_lie_on_it() {
    let mut cuts = 0;
    for (name, shape) in shapes::classes() {
        let model = shapes::model(shape);
        let Some(bounds) = model.bounds() else { continue };
        let diagonal = bounds.diagonal();
        let whole = area(&model);
        for seed in 0..6 {
            let face = seed as usize * 7 % model.surface.triangles.len();
            let [a, b, c] = model.surface.corners(face);
            let middle = (a + b + c) / 3.0;
            let askew = 0.4 * DVec3::from_array([0, 1, 2].map(|axis| noise(axis, seed)));
            let sight = (askew - (b - a).cross(c - a).normalize()).normalize();
            let Some(curve) = ring(&model, middle, sight, 0.06 * diagonal, seed) else {
                continue;
            };
            let (Ok(left), Ok(right)) = (cut(&model, &curve, Keep::Positive), cut(&model, &curve, Keep::Negative))
            else {
                continue;
            };
            cuts += 1;
            let both = cut(&model, &curve, Keep::Both).unwrap();
            let touch = 1e-6 * diagonal;
            for (source, position) in both.vertices.iter().zip(&both.positions) {
                if let VertexSource::New { row, .. } = source {
                    assert!(
                        beside(&curve, *position) <= touch,
                        "{name}: {}",
                        beside(&curve, *position)
                    );
                    let values = &both.values[3 * *row as usize..][..3];
                    assert!(
                        DVec3::from_slice(values).distance(*position) <= 1e-9 * diagonal,
                        "{name}"
                    );
                }
            }
            let of_part = |shape: &NewShape| shape.triangle_sources.len();
            // Parts that the curve does not touch are on both sides.
            let touched = both
                .triangle_sources
                .iter()
                .find(|source| source.age == Age::New)
                .unwrap();
            if model.topology.components().len() == 1 {
                assert_eq!(of_part(&left) + of_part(&right), of_part(&both), "{name}: {touched:?}");
                let again = shapes::model(drawn(&[&left, &right]));
                let split = shapes::model(drawn(&[&both]));
                for (after, what) in [(&again, "sides"), (&split, "both")] {
                    assert!((area(after) - whole).abs() <= 1e-9 * whole, "{name}: {what}");
                    let faults = |model: &Model| {
                        let topology = &model.topology;
                        let counts = [topology.non_manifold_edges(), topology.misoriented_edges()];
                        (counts, topology.boundary_loops().len(), genus(model))
                    };
                    assert_eq!(faults(after), faults(&model), "{name}: {what}");
                }
            }
        }
    }
    assert!(cuts >= 20, "{cuts}");
}

/// No new point of a border is so near to a vertex that slivers are left beside it, and the border is never farther from
/// the curve than that; without a vertex near it, it lies on the curve as before.
#[test]
fn a_curve_that_nearly_meets_vertices_leaves_no_slivers() {
    let ball = shapes::model(shapes::icosphere(4));
    let longest = ball.topology.edges().map(|[a, b]| {
        let [a, b] = [a, b].map(|end| ball.surface.positions[end.index()]);
        a.distance(b)
    });
    let longest = longest.fold(0.0, f64::max);
    let (mut snapped, mut new, mut near) = (0, 0, 0);
    for seed in 0..20 {
        let sight = DVec3::from_array([0, 1, 2].map(|axis| noise(axis, seed))).normalize();
        let curve = ring(&ball, -0.9 * sight, sight, 0.5, seed).unwrap();
        let shape = cut(&ball, &curve, Keep::Positive).unwrap();
        let model = shapes::model(drawn(&[&shape]));
        assert_eq!(model.topology.boundary_loops().len(), 1);
        let is_new = |position: DVec3| {
            let place = shape.positions.iter().position(|own| *own == position).unwrap();
            matches!(shape.vertices[place], VertexSource::New { .. })
        };
        for vertex in model.topology.boundary_loops().concat() {
            let position = model.surface.positions[vertex.index()];
            let off = beside(&curve, position);
            if is_new(position) {
                new += 1;
                assert!(off <= 1e-6, "{off}");
                let beside = ball.surface.positions.iter().map(|own| own.distance(position));
                let nearest = beside.fold(f64::INFINITY, f64::min);
                // A point of the curve itself stays where it is, and with it the crossings around it.
                near += usize::from(nearest < 0.03 * longest);
            } else {
                snapped += 1;
                assert!(off <= 0.05 * longest, "{off} of {longest}");
            }
        }
    }
    assert!(
        snapped > 50 && new > snapped && 10 * near < snapped,
        "{snapped} {new} {near}"
    );
}

/// On a flat sheet all pieces face up, so that none lies on another; a curve from border to border divides it.
#[test]
fn a_wave_from_border_to_border_divides_a_sheet_without_an_overlap() {
    let sheet = shapes::model(shapes::grid(9, 7));
    let bounds = sheet.bounds().unwrap();
    let size = bounds.max - bounds.min;
    let point = |step: usize| {
        let x = step as f64 / 40.0;
        bounds.min + size * DVec3::new(x, 0.5 + 0.3 * (9.0 * x).sin(), 0.0)
    };
    let curve = SurfaceCurve {
        points: (0..=40).map(point).collect(),
        is_closed: false,
        sight: Sight::Normals,
    };
    let whole = area(&sheet);
    let mut sum = 0.0;
    for keep in [Keep::Positive, Keep::Negative] {
        let side = cut(&sheet, &curve, keep).unwrap();
        let flat = |corners: &[DrawnVertex; 3]| {
            let [a, b, c] = corners.map(|corner| side.positions[corner.index()]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!(side.triangles.iter().all(|corners| flat(corners) > 0.0));
        let own: f64 = side.triangles.iter().map(flat).sum();
        // The left of a way along x is the upper side; a sine above and below.
        assert!((own - 0.5 * whole).abs() < 0.1 * whole, "{own} of {whole}");
        assert_eq!(shapes::model(drawn(&[&side])).topology.boundary_loops().len(), 1);
        sum += own;
    }
    assert!((sum - whole).abs() <= 1e-9 * whole, "{sum} of {whole}");
}

/// A ring within one triangle cuts a hole into it, and leaves the disc on the other side.
#[test]
fn a_ring_within_one_triangle_is_cut_out_of_it() {
    let bar = shapes::model(shapes::bar(1, 1, 1));
    let face = bar.surface.corners(0);
    let middle = face.iter().sum::<DVec3>() / 3.0;
    let normal = (face[1] - face[0]).cross(face[2] - face[0]).normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let curve = |turn: f64| SurfaceCurve {
        points: (0..7)
            .map(|step| TAU * turn * f64::from(step) / 7.0)
            .map(|angle| middle + 0.05 * (u * angle.cos() + v * angle.sin()))
            .collect(),
        is_closed: true,
        sight: Sight::Normals,
    };
    for turn in [1.0, -1.0] {
        let sides = [Keep::Positive, Keep::Negative].map(|keep| cut(&bar, &curve(turn), keep).unwrap());
        let areas = sides.each_ref().map(|side| area(&shapes::model(drawn(&[side]))));
        let disc = 3.5 * 0.05_f64.powi(2) * (TAU / 7.0).sin();
        let inner = usize::from(areas[0] > areas[1]);
        assert!((areas[inner] - disc).abs() < 1e-9, "{areas:?} {disc}");
        assert!((areas[0] + areas[1] - area(&bar)).abs() < 1e-9);
        let again = shapes::model(drawn(&[&sides[0], &sides[1]]));
        assert!(again.topology.is_closed());
    }
}

#[test]
fn curves_that_divide_nothing_are_refused_in_words() {
    let sheet = shapes::model(shapes::grid(6, 6));
    let bounds = sheet.bounds().unwrap();
    let curve = |places: &[[f64; 2]], is_closed| SurfaceCurve {
        points: places
            .iter()
            .map(|&[x, y]| bounds.min + (bounds.max - bounds.min) * DVec3::new(x, y, 0.0))
            .collect(),
        is_closed,
        sight: Sight::Normals,
    };
    let refused = |curve: &SurfaceCurve| cut(&sheet, curve, Keep::Positive).unwrap_err();
    let inside = curve(&[[0.0, 0.4], [0.6, 0.45]], false);
    assert_eq!(refused(&inside), StitchError::CurveEndsInside { point: 1 });
    let eight = curve(&[[0.2, 0.2], [0.83, 0.71], [0.81, 0.22], [0.21, 0.73]], true);
    assert_eq!(refused(&eight), StitchError::CurveCrossesItself);
    let two = shapes::model(shapes::together(&[
        shapes::grid(6, 6),
        shapes::moved(
            &shapes::grid(6, 6),
            DAffine3::from_translation(1.1 * (bounds.max.x - bounds.min.x) * DVec3::X),
        ),
    ]));
    let across = cut(
        &two,
        &curve(&[[0.0, 0.4], [0.6, 0.45], [2.1, 0.4]], false),
        Keep::Positive,
    );
    assert_eq!(across.unwrap_err(), StitchError::CurveChangesPart { from: 1 });
    let short = curve(&[[0.2, 0.2], [0.8, 0.7]], true);
    assert_eq!(refused(&short), StitchError::CurveTooShort { found: 2, least: 3 });
    // Around the tube of a torus: one side goes on to the other.
    let torus = shapes::model(shapes::torus(24, 12));
    let around = |step: i32| {
        let angle = TAU * (f64::from(step) + 0.3) / 9.0;
        DVec3::new(1.0 + 0.4 * angle.cos(), 0.013, 0.4 * angle.sin())
    };
    let meridian = SurfaceCurve {
        points: (0..9).map(around).collect(),
        is_closed: true,
        sight: Sight::Normals,
    };
    let refused = cut(&torus, &meridian, Keep::Negative).unwrap_err();
    assert_eq!(refused, StitchError::CurveDividesNothing);
    let both = shapes::model(drawn(&[&cut(&torus, &meridian, Keep::Both).unwrap()]));
    assert!(both.topology.is_closed() && genus(&both) == 1);
}
