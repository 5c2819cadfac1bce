use glam::DVec3;
use pliant_mesh::shapes;

use super::*;
use crate::document::HandleId;

/// A ball, and its matching to one without its lowest vertices, of which several rings are missing.
fn filled() -> (Model, Matching) {
    let ball = shapes::model(shapes::icosphere(3));
    let positions = (0..).zip(&ball.surface.positions);
    let matching = Matching {
        of_new: positions.map(|(vertex, at)| (at.y > -0.6).then_some(vertex)).collect(),
        of_new_part: vec![Some(0)],
        of_new_object: vec![Some(0)],
    };
    (ball, matching)
}

/// The new vertices with their old neighbours.
fn new(model: &Model, matching: &Matching) -> Vec<(usize, Vec<usize>)> {
    let old = |vertex: usize| {
        let around = model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
        around
            .map(|other| other.index())
            .filter(|other| matching.of_new[*other].is_some())
            .collect()
    };
    let all = (0..matching.of_new.len()).filter(|vertex| matching.of_new[*vertex].is_none());
    all.map(|vertex| (vertex, old(vertex))).collect()
}

#[test]
fn a_patch_gets_the_paint_of_its_rim_and_inside_none_if_the_rim_has_several() {
    let (model, matching) = filled();
    let (new, continuation) = (new(&model, &matching), Continuation::of(&matching, &model));
    let deep = new.iter().filter(|(_, rim)| rim.is_empty()).count();
    assert!(deep > 20 && deep < new.len(), "{deep}");
    for of_rim in [Paint::Bare, Paint::Free, Paint::Fixed, Paint::Handle(HandleId(3))] {
        let mut paint = vec![of_rim; matching.of_new.len()];
        new.iter().for_each(|(vertex, _)| paint[*vertex] = Paint::Bare);
        continuation.paint(&mut paint);
        assert!(paint.iter().all(|own| *own == of_rim));
    }
    let positions = &model.surface.positions;
    let sides = |at: DVec3| {
        if at.x > 0.0 {
            Paint::Fixed
        } else {
            Paint::Handle(HandleId(0))
        }
    };
    let mut paint: Vec<Paint> = positions.iter().map(|at| sides(*at)).collect();
    new.iter().for_each(|(vertex, _)| paint[*vertex] = Paint::Bare);
    continuation.paint(&mut paint);
    for (vertex, rim) in &new {
        let way = |old: &usize| positions[*old].distance(positions[*vertex]);
        let nearest = rim.iter().map(way).fold(f64::INFINITY, f64::min);
        let mut near = rim.iter().filter(|old| way(old) <= nearest + 1e-12);
        match rim.is_empty() {
            true => assert_eq!(paint[*vertex], Paint::Bare, "inside"),
            false => assert!(near.any(|old| paint[*old] == paint[*vertex]), "beside the rim"),
        }
    }
}

#[test]
fn numbers_and_dye_stay_within_those_of_the_rim_and_equal_ones_stay_to_the_bit() {
    let (model, matching) = filled();
    let (new, continuation) = (new(&model, &matching), Continuation::of(&matching, &model));
    for value in [0.3, 7.7, f64::INFINITY] {
        let mut field = vec![value; matching.of_new.len()];
        new.iter().for_each(|(vertex, _)| field[*vertex] = 1.0);
        continuation.numbers(&mut field);
        assert!(field.iter().all(|own| *own == value), "{value}");
    }
    let heights: Vec<f64> = model.surface.positions.iter().map(|at| 2.0 + at.x).collect();
    let mut field = heights.clone();
    continuation.numbers(&mut field);
    let mut dye: Vec<Dye> = heights.iter().map(|height| [0.0, 0.2, *height as f32, 1.0]).collect();
    continuation.dye(&mut dye);
    let on_rim = new.iter().flat_map(|(_, rim)| rim).map(|old| heights[*old]);
    let (low, high) = on_rim.fold((f64::INFINITY, 0.0_f64), |(low, high), own| {
        (low.min(own), high.max(own))
    });
    let (mut left, mut right) = (f64::INFINITY, 0.0_f64);
    for (vertex, _) in &new {
        let own = field[*vertex];
        assert!((low - 1e-12..=high + 1e-12).contains(&own), "{own}");
        assert!((dye[*vertex][2] - own as f32).abs() < 1e-5);
        assert_eq!([dye[*vertex][0], dye[*vertex][1], dye[*vertex][3]], [0.0, 0.2, 1.0]);
        (left, right) = (left.min(own), right.max(own));
    }
    assert!(right - left > 0.5 * (high - low), "it goes from one side to the other");
    for (vertex, old) in matching.of_new.iter().enumerate() {
        assert!(old.is_none() || field[vertex] == heights[vertex], "old ones stay");
    }
}
