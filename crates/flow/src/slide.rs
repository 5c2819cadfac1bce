//! Ways along a border: fluid slips along it and does not leave.

use glam::DVec2;

use crate::domain::{Domain, MOST_EDGES, Place};
use crate::hinges::{WALL, last, next};
use crate::plane::turned;

/// A point on the border.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnBorder {
    /// The edge opposite this corner.
    pub edge: u32,
    /// Barycentric coordinates.
    pub weights: [f64; 3],
    /// From the tangent plane of the vertex at the way's beginning to the triangle's plane.
    pub rotation: DVec2,
}

impl OnBorder {
    /// A place that is on a border's edge.
    pub fn at(place: Place, edge: u32) -> Self {
        Self {
            edge,
            weights: place.weights,
            rotation: place.rotation,
        }
    }
}

impl Domain {
    /// Follows the border as far as a way that is left goes along it. Where the border turns, the way turns with it.
    pub fn slide(&self, mut here: OnBorder, way: DVec2) -> Place {
        let along = self.charts[here.edge as usize / 3].edge(here.edge as usize % 3);
        let is_forward = way.dot(along) > 0.0;
        let mut left = way.dot(along).abs() / along.length();
        for _ in 0..MOST_EDGES {
            let edge = here.edge;
            let length = self.charts[edge as usize / 3].edge(edge as usize % 3).length();
            // The way leaves the edge's end `from`, and `to` is ahead.
            let ends = [next(edge) as usize % 3, last(edge) as usize % 3];
            let [from, to] = if is_forward { ends } else { [ends[1], ends[0]] };
            let to_end = here.weights[from] * length;
            if left <= to_end {
                let share = left / length;
                here.weights[from] -= share;
                here.weights[to] += share;
                break;
            }
            left -= to_end;
            here = self.around(edge - edge % 3 + to as u32, is_forward, here.rotation);
        }
        Place::at(here.edge / 3, here.weights, here.rotation)
    }

    /// Goes around the vertex of `corner`, from one edge of the border to the other.
    fn around(&self, mut corner: u32, is_forward: bool, mut rotation: DVec2) -> OnBorder {
        // Forward the border comes counterclockwise along an edge and leaves at the fan's clockwise end.
        let ahead = |corner: u32| if is_forward { last(corner) } else { next(corner) };
        let mut edge = ahead(corner);
        for _ in 0..MOST_EDGES {
            let other = self.crossings.beside(edge);
            if other == WALL {
                break;
            }
            rotation = turned(self.turn(edge, other), rotation);
            corner = ahead(other);
            edge = ahead(corner);
        }
        let mut weights = [0.0; 3];
        weights[corner as usize % 3] = 1.0;
        OnBorder {
            edge,
            weights,
            rotation,
        }
    }
}
