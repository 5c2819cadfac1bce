//! A welded file comes back unchanged, to the bit, whichever parts of it the surface stores.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use glam::DVec3;
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Model, Progress, WeldOptions, shapes};

fn bits(positions: &[DVec3]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

/// Variants of a shape: unchanged; cut along seams (some triangles have a corner of their own); cut throughout; shaken
/// by less than the tolerance, which joins its corners but not to the bit; with minus zeros; each triangle turned; with
/// triangles and vertices in reverse, and with file vertices that are not the drawn ones.
fn variants(shape: &Drawn) -> Vec<Drawn> {
    let mut seams = shape.clone();
    for t in (0..seams.triangles.len()).step_by(7) {
        let corner = &mut seams.triangles[t][t % 3];
        seams.positions.push(seams.positions[corner.index()]);
        seams.file_vertex.push(seams.file_vertex[corner.index()]);
        *corner = DrawnVertex(seams.positions.len() as u32 - 1);
    }
    let mut shaken = shapes::soup(shape);
    for (v, p) in shaken.positions.iter_mut().enumerate() {
        p.x += 1e-12 * (v % 5) as f64;
    }
    let mut minus = shapes::soup(shape);
    for p in minus.positions.iter_mut().step_by(2) {
        *p = DVec3::from_array(p.to_array().map(|x| if x.abs() < 0.1 { -0.0 } else { x }));
    }
    let mut turned = shape.clone();
    (turned.triangles.iter_mut().enumerate()).for_each(|(t, corners)| corners.rotate_left(t % 3));
    let mut reversed = shape.clone();
    reversed.triangles.reverse();
    reversed.positions.reverse();
    let last = reversed.positions.len() as u32 - 1;
    for corner in reversed.triangles.as_flattened_mut() {
        corner.0 = last - corner.0;
    }
    reversed.file_vertex = (0..=last).map(|v| FileVertex((last - v) / 2)).collect();
    vec![
        shape.clone(),
        seams,
        shapes::soup(shape),
        shaken,
        minus,
        turned,
        reversed,
    ]
}

#[test]
fn what_was_welded_comes_back_to_the_bit() {
    for (class, shape) in shapes::classes() {
        for (variant, drawn) in variants(&shape).into_iter().enumerate() {
            for distance in [None, Some(0.0), Some(1e-7)] {
                let options = WeldOptions { distance };
                let model = Model::weld(drawn.clone(), &options, &Progress::new(), &Cancel::new()).unwrap();
                let here = format!("{class}, variant {variant}, {distance:?}");
                let rest = model.rest();
                assert_eq!(bits(&rest.positions), bits(&drawn.positions), "{here}");
                assert_eq!(rest.triangles, drawn.triangles, "{here}");
                assert_eq!(rest.file_vertex, drawn.file_vertex, "{here}");
                assert_eq!(rest.file_vertex_count, drawn.file_vertex_count, "{here}");
                let one_by_one = |count: usize| (0..count as u32).map(DrawnVertex);
                let positions: Vec<DVec3> = one_by_one(drawn.positions.len())
                    .map(|v| model.rest_position(v))
                    .collect();
                assert_eq!(bits(&positions), bits(&drawn.positions), "{here}");
                let count = drawn.triangles.len() as u32;
                let triangles: Vec<_> = (0..count).map_while(|t| model.drawn_triangle(t)).collect();
                assert_eq!(triangles, drawn.triangles, "{here}");
                assert_eq!(model.drawn_triangle(count), None, "{here}");
                for (t, &number) in model.drawn.triangle_of_surface().iter().enumerate() {
                    assert_eq!(model.drawn_corners(t), drawn.triangles[number as usize], "{here}");
                }
            }
        }
    }
}

#[test]
fn what_nothing_is_solved_of_comes_back_too() {
    let points = Drawn::once(vec![DVec3::NAN, -DVec3::ZERO, DVec3::X], vec![]);
    let collapsed = Drawn::once(vec![DVec3::ONE; 3], vec![[2, 0, 1].map(DrawnVertex)]);
    for drawn in [Drawn::default(), points, collapsed] {
        let rest = shapes::model(drawn.clone()).rest();
        assert_eq!(bits(&rest.positions), bits(&drawn.positions));
        assert_eq!(rest.triangles, drawn.triangles);
        assert_eq!(rest.file_vertex, drawn.file_vertex);
    }
}
