//! Lines on the surface around every region of vertices with the same label.
//!
//! In a triangle whose corners differ, the line runs from edge to edge, as in marching triangles. With the middles of
//! edges it would zigzag from triangle to triangle, so its points slide along their edges towards the mean of their
//! neighbours: the line gets straighter and still separates the same vertices.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use crate::{Surface, SurfaceVertex};

/// A piece of a line, within one triangle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ContourLine {
    /// The surface's triangle.
    pub triangle: u32,
    /// The points where it crosses two of the triangle's edges.
    pub ends: [Crossing; 2],
    /// The label of the region that it surrounds.
    pub label: u16,
}

/// A point of a triangle's edge.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Crossing {
    /// The edge's corners, 0 to 2, the lower surface vertex first.
    pub corners: [u8; 2],
    /// The position from the first to the second, from 0 to 1.
    pub share: f32,
}

/// The number of times that points slide towards their neighbours' mean.
const ROUNDS: usize = 12;
/// The smallest distance of a point from an edge's ends, as a share of its length.
const CLEARANCE: f64 = 0.08;

/// The lines around the regions of equal `labels` (one per vertex), by triangle. If regions meet, the line belongs to
/// the higher label, so that none is drawn twice.
pub fn contours(surface: &Surface, labels: &[u16]) -> Vec<ContourLine> {
    let mut lines: Vec<ContourLine> = surface
        .triangles
        .par_iter()
        .enumerate()
        .with_min_len(8192)
        .flat_map_iter(|(triangle, corners)| {
            let labels = corners.map(|corner| labels[corner.index()]);
            (0..3_u8).filter_map(move |corner| line(triangle as u32, corners, labels, corner))
        })
        .collect();
    straighten(&mut lines, surface);
    lines
}

/// The line that cuts `corner` off from both others, if there is one and it is this corner's turn to draw it.
fn line(triangle: u32, corners: &[SurfaceVertex; 3], labels: [u16; 3], corner: u8) -> Option<ContourLine> {
    let others = [(corner + 1) % 3, (corner + 2) % 3];
    let own = labels[usize::from(corner)];
    let [next, last] = others.map(|other| labels[usize::from(other)]);
    if own == next || own == last {
        return None;
    }
    // One corner is cut off from two of the same label: one line, of the higher label. With three labels, the two
    // higher ones have a line each.
    let label = if next == last {
        own.max(next)
    } else if own > next.min(last) {
        own
    } else {
        return None;
    };
    let crossing = |other: u8| {
        let is_first = corners[usize::from(corner)] < corners[usize::from(other)];
        Crossing {
            corners: if is_first { [corner, other] } else { [other, corner] },
            share: 0.5,
        }
    };
    Some(ContourLine {
        triangle,
        ends: others.map(crossing),
        label,
    })
}

fn straighten(lines: &mut [ContourLine], surface: &Surface) {
    // A point for each edge that a label's line crosses.
    let mut point_of: HashMap<(u16, [SurfaceVertex; 2]), usize> = HashMap::new();
    let mut edges: Vec<[DVec3; 2]> = Vec::new();
    let mut ends_of_line: Vec<[usize; 2]> = Vec::with_capacity(lines.len());
    for line in lines.iter() {
        let corners = surface.triangles[line.triangle as usize];
        ends_of_line.push(line.ends.map(|end| {
            let edge = end.corners.map(|corner| corners[usize::from(corner)]);
            *point_of.entry((line.label, edge)).or_insert_with(|| {
                edges.push(edge.map(|vertex| surface.positions[vertex.index()]));
                edges.len() - 1
            })
        }));
    }
    let mut shares = vec![0.5_f64; edges.len()];
    for _ in 0..ROUNDS {
        let mut means = vec![(DVec3::ZERO, 0.0_f64); edges.len()];
        let at = |point: usize| edges[point][0].lerp(edges[point][1], shares[point]);
        for &[from, to] in &ends_of_line {
            for (of, beside) in [(from, to), (to, from)] {
                means[of].0 += at(beside);
                means[of].1 += 1.0;
            }
        }
        for ((share, [start, end]), (sum, count)) in shares.iter_mut().zip(&edges).zip(means) {
            let along = *end - *start;
            let wanted = (sum / count - *start).dot(along) / along.length_squared();
            if wanted.is_finite() {
                *share = wanted.clamp(CLEARANCE, 1.0 - CLEARANCE);
            }
        }
    }
    for (line, points) in lines.iter_mut().zip(ends_of_line) {
        for (end, point) in line.ends.iter_mut().zip(points) {
            // f32 begins here: a share of an edge only determines where a line is drawn.
            end.share = shares[point] as f32;
        }
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::{Cancel, Model, Progress, WeldOptions, shapes};

    fn sphere() -> Model {
        let drawn = shapes::icosphere(4);
        Model::weld(drawn, &WeldOptions::default(), &Progress::default(), &Cancel::default()).unwrap()
    }

    fn labelled(model: &Model, label: impl Fn(DVec3) -> u16) -> Vec<ContourLine> {
        let labels: Vec<u16> = model.surface.positions.iter().map(|&p| label(p)).collect();
        contours(&model.surface, &labels)
    }

    /// The ends of a line, and the edges that they are on.
    fn ends(model: &Model, line: &ContourLine) -> [(DVec3, [SurfaceVertex; 2]); 2] {
        let corners = model.surface.triangles[line.triangle as usize];
        line.ends.map(|end| {
            let edge = end.corners.map(|corner| corners[usize::from(corner)]);
            let [from, to] = edge.map(|vertex| model.surface.positions[vertex.index()]);
            (from.lerp(to, f64::from(end.share)), edge)
        })
    }

    #[test]
    fn a_cap_has_one_closed_line_that_is_hardly_longer_than_its_circle() {
        let model = sphere();
        for height in [-0.7, 0.0, 0.31, 0.9] {
            let lines = labelled(&model, |p| u16::from(p.z > height));
            let mut met: HashMap<[SurfaceVertex; 2], u32> = HashMap::new();
            let mut length = 0.0;
            for line in &lines {
                assert_eq!(line.label, 1);
                let [from, to] = ends(&model, line);
                length += from.0.distance(to.0);
                for (at, edge) in [from, to] {
                    assert!((at.z - height).abs() < 0.08, "{} for {height}", at.z);
                    *met.entry(edge).or_default() += 1;
                }
            }
            assert!(met.values().all(|&times| times == 2), "it has no end");
            let circle = std::f64::consts::TAU * (1.0 - height * height).sqrt();
            assert!(
                length > 0.93 * circle && length < 1.06 * circle,
                "{length} for {circle}"
            );
        }
    }

    #[test]
    fn every_edge_between_two_labels_is_crossed_and_no_other() {
        let model = sphere();
        let label = |p: DVec3| u16::from(p.x > 0.2) + 2 * u16::from(p.y > -0.1) + 4 * u16::from(p.z > 0.5);
        let crossed: std::collections::HashSet<[SurfaceVertex; 2]> = labelled(&model, label)
            .iter()
            .flat_map(|line| ends(&model, line).map(|(_, edge)| edge))
            .collect();
        for triangle in &model.surface.triangles {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let edge = [triangle[a].min(triangle[b]), triangle[a].max(triangle[b])];
                let [p, q] = edge.map(|vertex| label(model.surface.positions[vertex.index()]));
                assert_eq!(crossed.contains(&edge), p != q);
            }
        }
        assert!(labelled(&model, |_| 7).is_empty());
    }
}
