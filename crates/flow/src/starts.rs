//! The beginnings of ways: the triangles into which displacements at vertices lead.

use glam::DVec2;

use crate::corners::along_ray;
use crate::domain::Domain;
use crate::hinges::WALL;
use crate::lanes::{LANES, Lanes, Vectors, change, put, turn, vector};
use crate::plane::{self, conjugate, turned_back};

/// The beginnings of ways.
pub(crate) struct Starts {
    /// The corners of the triangles that they enter; [`WALL`] at bare vertices.
    pub corners: [u32; LANES],
    /// The ways in the planes of the triangles.
    pub ways: Vectors,
    /// The changes of the coordinates of the ways' own corners, the next and the last ones.
    pub rates: [Lanes; 3],
    /// From the tangent planes of the vertices to the triangles' planes.
    pub rotations: Vectors,
}

impl Starts {
    /// The beginnings of ways from the vertices from `first` on, `count` of them, along displacements in the tangent planes
    /// of these vertices. Further displacements must be numbers.
    #[inline(always)]
    pub fn of(domain: &Domain, first: usize, count: usize, displacements: &Vectors) -> Self {
        let mut starts = Self {
            corners: [WALL; LANES],
            ways: *displacements,
            rates: [[0.0; LANES]; 3],
            rotations: [[1.0; LANES], [0.0; LANES]],
        };
        let Starts {
            corners,
            ways,
            rates,
            rotations,
        } = &mut starts;
        let mut angles = [0.0; LANES];
        for (i, angle) in angles.iter_mut().enumerate() {
            *angle = plane::angle(vector(ways, i));
        }
        // By how much the direction in the triangle is turned more than the middle of its corner.
        let (mut turns, mut twists) = ([0.0; LANES], [0.0; LANES]);
        let mut layouts = [[1.0; LANES], [0.0; LANES], [1.0; LANES]];
        let (mut others, mut other_count) = ([None; LANES], 0);
        for i in 0..count {
            let vertex = first + i;
            let Some(wedge) = domain.fans.wedge(vertex, angles[i]) else {
                continue;
            };
            corners[i] = wedge.corner;
            turns[i] = (angles[i] - wedge.middle) * domain.fans.bend(vertex);
            if wedge.is_last_of_open || vector(ways, i) == DVec2::ZERO {
                let way = domain
                    .fans
                    .way_at_border(vertex, vector(ways, i), angles[i], &domain.charts);
                corners[i] = way.corner;
                others[other_count] = Some((i, way.direction));
                other_count += 1;
            }
        }
        for (i, &corner) in corners.iter().enumerate().take(count) {
            if corner != WALL {
                put(rotations, i, domain.fans.rotation(corner));
                twists[i] = domain.fans.twist(corner);
                let layout = domain.charts[corner as usize / 3].layout();
                (layouts[0][i], layouts[1][i], layouts[2][i]) = (layout[0], layout[1], layout[2]);
            }
        }
        change(ways, |i, way| turned_back(vector(rotations, i), way));
        turn(ways, &turns);
        for (i, way) in others.into_iter().take(other_count).flatten() {
            put(ways, i, way);
        }
        for i in 0..LANES {
            // The chart's rates.
            let of_2 = ways[1][i] / layouts[2][i];
            let of_1 = (ways[0][i] - layouts[1][i] * of_2) / layouts[0][i];
            let of_0 = -of_1 - of_2;
            let k = corners[i] % 3;
            let pick = |a: f64, b: f64, c: f64| {
                if k == 0 {
                    a
                } else if k == 1 {
                    b
                } else {
                    c
                }
            };
            let [after, before] = [pick(of_1, of_2, of_0), pick(of_2, of_0, of_1)];
            (rates[0][i], rates[1][i], rates[2][i]) = (pick(of_0, of_1, of_2), after, before);
        }
        let [after, before] = [rates[1], rates[2]].map(|rates| rates.map(|rate| if rate > 0.0 { rate } else { 0.0 }));
        turn(rotations, &along_ray([&after, &before], &twists));
        change(rotations, |_, rotation| conjugate(rotation));
        starts
    }
}
