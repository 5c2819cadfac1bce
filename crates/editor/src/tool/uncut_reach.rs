//! A reach that leaves the body in one piece.
//!
//! A long reach of a neck wraps the chest: it cuts the forelegs off from the body, so that they would come along, and a
//! long reach of a thigh does the same to the other leg. The fixed surface is built up from afar, as in a watershed: a
//! part that meets the body only at some distance from the handle is cut off by every longer reach.

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, DistanceSearch, Model, SurfaceVertex, face_area};

/// The share of the distance at which a part would be cut off, so that it hangs on more than a thread.
const MARGIN: f64 = 0.8;

/// In no piece yet.
const NONE: u32 = u32::MAX;

/// The largest reach between `least` and `most` of these vertices, in world units, that cuts no part off the body which
/// `least` leaves on it. A part smaller than a square with sides of `least` does not count. It is measured on the model's
/// surface after the displacements of its rest shape, and depends on nothing else.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
pub(super) fn uncut_reach(
    model: &Model,
    rest: &[DVec3],
    members: &[SurfaceVertex],
    [least, most]: [f64; 2],
    cancel: &Cancel,
) -> Result<f64, Cancelled> {
    let (surface, topology) = (&model.surface, &model.topology);
    let position = |v: SurfaceVertex| surface.positions[v.index()] + rest[v.index()];
    let seeds: Vec<(SurfaceVertex, f64)> = members.iter().map(|&vertex| (vertex, 0.0)).collect();
    let mut search = DistanceSearch::default();
    let reached = search.within(&surface.triangles, topology, position, &seeds, most);
    cancel.check()?;
    let mut pieces = Pieces::of_vertices(surface.positions.len());
    for &corners in &surface.triangles {
        let area = face_area(corners.map(position)) / 3.0;
        corners.iter().for_each(|corner| pieces.area[corner.index()] += area);
    }
    let mut is_within = vec![false; surface.positions.len()];
    reached.iter().for_each(|(vertex, _)| is_within[vertex.index()] = true);
    let beyond = (0..surface.positions.len() as u32).map(SurfaceVertex);
    for vertex in beyond.filter(|vertex| !is_within[vertex.index()]) {
        pieces.add(vertex, topology.neighbours(vertex));
    }
    cancel.check()?;
    let mut joins: Vec<(SurfaceVertex, f64)> = Vec::new();
    for &(vertex, distance) in reached.iter().rev().take_while(|(_, distance)| *distance > least) {
        if pieces.add(vertex, topology.neighbours(vertex)) > least * least {
            joins.push((vertex, distance));
        }
    }
    // A hand that the handle itself cuts off may come apart: its fingers come along in any case.
    let body = pieces.largest();
    let joins_body = joins.iter().rev().find(|(vertex, _)| pieces.root(vertex.0) == body);
    Ok(joins_body.map_or(most, |(_, distance)| (MARGIN * distance).max(least)))
}

/// The connected pieces of the vertices that were added, as a forest: a vertex leads to its piece's root.
struct Pieces {
    parent: Vec<u32>,
    /// The area of a root's piece; of a vertex that was not added its own.
    area: Vec<f64>,
}

impl Pieces {
    fn of_vertices(count: usize) -> Self {
        Self {
            parent: vec![NONE; count],
            area: vec![0.0; count],
        }
    }

    /// Adds a vertex, which joins the pieces of its neighbours. Returns the area of the second largest of these pieces:
    /// without the vertex it was cut off from the largest.
    fn add(&mut self, vertex: SurfaceVertex, neighbours: &[SurfaceVertex]) -> f64 {
        self.parent[vertex.index()] = vertex.0;
        let mut second = 0.0_f64;
        let mut joined: Option<u32> = None;
        for neighbour in neighbours.iter().filter(|neighbour| **neighbour != vertex) {
            if self.parent[neighbour.index()] == NONE {
                continue;
            }
            let other = self.root(neighbour.0);
            joined = Some(match joined {
                Some(piece) if piece != other => {
                    second = second.max(self.area[piece as usize].min(self.area[other as usize]));
                    self.join(piece, other)
                }
                _ => other,
            });
        }
        if let Some(piece) = joined {
            self.join(piece, vertex.0);
        }
        second
    }

    /// Joins two roots' pieces; returns the root of both.
    fn join(&mut self, one: u32, other: u32) -> u32 {
        let [first, second] = [one, other].map(|root| self.area[root as usize]);
        let (top, under) = if second > first { (other, one) } else { (one, other) };
        self.parent[under as usize] = top;
        self.area[top as usize] = first + second;
        top
    }

    /// The root of the largest piece; of equal ones, the one with the lowest number.
    fn largest(&self) -> u32 {
        let roots = (0..).zip(&self.parent).filter(|(vertex, parent)| vertex == *parent);
        let areas = roots.map(|(root, _)| (self.area[root as usize], root));
        let largest = areas.reduce(|best, next| if next.0 > best.0 { next } else { best });
        largest.map_or(NONE, |(_, root)| root)
    }

    fn root(&mut self, vertex: u32) -> u32 {
        let mut root = vertex;
        while self.parent[root as usize] != root {
            let above = self.parent[self.parent[root as usize] as usize];
            self.parent[root as usize] = above;
            root = above;
        }
        root
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::{DAffine3, DVec3};
    use pliant_mesh::{Cancel, Model, SurfaceVertex, shapes};

    use super::uncut_reach;

    /// A flat T whose stem, 2 wide and 4 high, stands on the middle of a bar that is 12 wide and 2 high.
    fn t() -> Model {
        let scale = DAffine3::from_scale(DVec3::new(12.0, 6.0, 1.0));
        let place = DAffine3::from_translation(DVec3::new(-6.0, -2.0, 0.0));
        let mut sheet = shapes::moved(&shapes::grid(120, 60), place * scale);
        let positions = sheet.positions.clone();
        sheet.triangles.retain(|corners| {
            let middle = corners.iter().map(|v| positions[v.index()]).sum::<DVec3>() / 3.0;
            middle.y < 0.0 || middle.x.abs() < 1.0
        });
        shapes::model(sheet)
    }

    fn reach(model: &Model, is_member: impl Fn(DVec3) -> bool, range: [f64; 2]) -> f64 {
        let rest = vec![DVec3::ZERO; model.surface.positions.len()];
        let members = (0..rest.len() as u32).map(SurfaceVertex);
        let members: Vec<SurfaceVertex> = members
            .filter(|v| is_member(model.surface.positions[v.index()]))
            .collect();
        uncut_reach(model, &rest, &members, range, &Cancel::new()).unwrap()
    }

    #[test]
    fn a_reach_ends_before_it_cuts_the_body_in_two() {
        let model = t();
        let head = |p: DVec3| p.x.abs() < 1.01 && p.y > 2.99;
        // At 5 it would come through the bar.
        for most in [5.5, 8.0] {
            let found = reach(&model, head, [0.5, most]);
            assert!((3.6..4.1).contains(&found), "{found} of {most}");
        }
        // A reach that cuts nothing stays as it is, and so does one that cuts where the least one has already cut.
        assert_eq!(reach(&model, head, [0.5, 3.0]), 3.0);
        assert_eq!(reach(&model, head, [5.2, 5.6]), 5.6);
        // The end of an arm has nothing beyond that could be cut off.
        assert_eq!(reach(&model, |p| p.x > 5.0, [0.5, 3.0]), 3.0);
    }

    #[test]
    fn what_the_handle_itself_cuts_off_may_come_apart() {
        let model = t();
        // It cuts the stem's upper end off, and the reach on the other side of it cuts nothing more.
        let across = |p: DVec3| p.y > 0.99 && p.y < 2.01;
        assert_eq!(reach(&model, across, [0.2, 1.5]), 1.5);
        // Across the left half of the bar it cuts an end off, and the right half with the stem is the body.
        let left = |p: DVec3| p.x > -3.01 && p.x < -1.99;
        assert_eq!(reach(&model, left, [0.2, 0.8]), 0.8);
        let found = reach(&model, left, [0.2, 4.0]);
        assert!(found < 2.5, "the stem stays on the right half of the bar: {found}");
    }
}
