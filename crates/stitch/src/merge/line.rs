//! A border as a closed line with its arc length, and the map between two lines.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use crate::borders::edge_lengths;

/// A closed line through vertices of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// Its vertices, in order.
    pub vertices: Vec<SurfaceVertex>,
    /// Their positions.
    pub points: Vec<DVec3>,
    /// The way along the line to each vertex, in world units; the last entry is the line's length.
    pub ways: Vec<f64>,
    /// The mean of its vertices.
    pub middle: DVec3,
}

impl Line {
    pub fn of(vertices: Vec<SurfaceVertex>, points: Vec<DVec3>) -> Self {
        let mut ways = vec![0.0];
        let mut way = 0.0;
        for length in edge_lengths(&points) {
            way += length;
            ways.push(way);
        }
        let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        Self {
            vertices,
            points,
            ways,
            middle,
        }
    }

    /// The number of its vertices.
    pub fn count(&self) -> usize {
        self.vertices.len()
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.ways[self.count()]
    }

    /// The length of the shorter edge at a vertex.
    pub fn shorter_edge(&self, k: usize) -> f64 {
        let before = (k + self.count() - 1) % self.count();
        let length = |edge: usize| self.ways[edge + 1] - self.ways[edge];
        length(k).min(length(before))
    }

    /// The edge at a way along the line, and the share of the edge before it.
    pub fn place(&self, way: f64) -> (usize, f64) {
        let way = way.rem_euclid(self.length());
        let edge = self.ways.partition_point(|own| *own <= way).clamp(1, self.count()) - 1;
        let length = self.ways[edge + 1] - self.ways[edge];
        let share = if length > 0.0 {
            (way - self.ways[edge]) / length
        } else {
            0.0
        };
        (edge, share.clamp(0.0, 1.0))
    }

    /// The point at a way along the line.
    pub fn point(&self, way: f64) -> DVec3 {
        let (edge, share) = self.place(way);
        self.points[edge].lerp(self.points[(edge + 1) % self.count()], share)
    }
}

/// Pairs of ways along two lines that belong together; the map is linear between them.
#[derive(Clone, Debug)]
pub(crate) struct Correspondence {
    /// Ways along the first line and along the second, in cyclic order along both.
    anchors: Vec<[f64; 2]>,
    /// The lines' lengths.
    lengths: [f64; 2],
}

impl Correspondence {
    /// Makes the map with these anchors, by rising way along the first line.
    pub fn of(anchors: Vec<[f64; 2]>, lengths: [f64; 2]) -> Self {
        Self { anchors, lengths }
    }

    /// The way along the other line, for a way along the line `from` (0 or 1).
    pub fn other(&self, from: usize, way: f64) -> f64 {
        let to = 1 - from;
        let count = self.anchors.len();
        let ahead = |start: f64, end: f64, line: usize| (end - start).rem_euclid(self.lengths[line]);
        // The last anchor at or before the way is the one with the least distance to the way.
        let own = (0..count)
            .min_by(|&a, &b| {
                let way_from = |k: usize| ahead(self.anchors[k][from], way, from);
                way_from(a).total_cmp(&way_from(b))
            })
            .unwrap_or(0);
        let next = (own + 1) % count;
        let span = |line: usize| match count {
            1 => self.lengths[line],
            _ => ahead(self.anchors[own][line], self.anchors[next][line], line),
        };
        let share = if span(from) > 0.0 {
            ahead(self.anchors[own][from], way, from) / span(from)
        } else {
            0.0
        };
        (self.anchors[own][to] + share.min(1.0) * span(to)).rem_euclid(self.lengths[to])
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_mesh::SurfaceVertex;

    use super::{Correspondence, Line};

    #[test]
    fn a_way_along_a_square_has_its_place_and_its_partner() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let line = Line::of((0..4).map(SurfaceVertex).collect(), square.to_vec());
        assert_eq!(line.length(), 8.0);
        assert_eq!(line.place(7.0), (3, 0.5));
        assert_eq!(line.point(-1.0), DVec3::new(0.0, 1.0, 0.0));
        let map = Correspondence::of(vec![[1.0, 0.0], [5.0, 3.0]], [8.0, 4.0]);
        assert_eq!(
            [1.0, 3.0, 5.0, 7.0, 0.0].map(|way| map.other(0, way)),
            [0.0, 1.5, 3.0, 3.5, 3.75]
        );
        for way in [0.1, 0.9, 1.7, 2.2, 3.9] {
            assert!((map.other(0, map.other(1, way)) - way).abs() < 1e-12);
        }
    }
}
