//! The borders of a surface: closed lines of edges that have one triangle.

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};
use rayon::prelude::*;

use crate::crossing::first_crossing;
use crate::error::{BorderFault, StitchError};

/// A closed line along which a surface ends. It passes each of its vertices once.
#[derive(Clone, PartialEq, Debug)]
pub struct Border {
    /// Its vertices, with the hole on the left, seen from outside: a triangle that fills it counterclockwise takes its
    /// edges in this direction. It begins at its lowest vertex.
    pub vertices: Vec<SurfaceVertex>,
    /// The sum of its edges' lengths, in world units.
    pub length: f64,
}

/// All borders of a surface.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Borders {
    /// The borders that can be filled and joined, by falling length, equal ones by their first vertex.
    pub sound: Vec<Border>,
    /// A vertex of each of the others, and its fault.
    pub faulty: Vec<(SurfaceVertex, BorderFault)>,
    /// The vertices of the faulty borders with their places in `faulty`, ascending.
    faulty_vertices: Vec<(SurfaceVertex, u32)>,
}

impl Borders {
    /// Finds the borders of a model.
    pub fn of(model: &Model) -> Self {
        let (positions, edges) = (&model.surface.positions, model.topology.boundary_edge_list());
        let loops = model.topology.boundary_loops();
        let judge = |vertices: &Vec<SurfaceVertex>| {
            if vertices.len() == 3 && is_triangle(model, vertices) {
                return Err(BorderFault::LoneTriangle);
            }
            Border::of(vertices, positions, edges)
        };
        let judged: Vec<Result<Border, BorderFault>> = loops.par_iter().map(judge).collect();
        let mut borders = Self::default();
        for (vertices, judged) in loops.iter().zip(judged) {
            match judged {
                Ok(border) => borders.sound.push(border),
                Err(fault) => {
                    let number = borders.faulty.len() as u32;
                    borders.faulty.push((vertices[0], fault));
                    let own = vertices.iter().map(|&vertex| (vertex, number));
                    borders.faulty_vertices.extend(own);
                }
            }
        }
        borders.faulty_vertices.sort_unstable();
        let by_length = |a: &Border, b: &Border| b.length.total_cmp(&a.length).then(a.vertices.cmp(&b.vertices));
        borders.sound.sort_by(by_length);
        borders
    }

    /// The numbers of the sound borders that pass one of these surface vertices, which belong to one file vertex.
    ///
    /// # Errors
    /// [`StitchError::FaultyBorder`] if only faulty borders do, [`StitchError::NotOnBorder`] if none does.
    pub fn at(&self, file_vertex: u32, surface: &[SurfaceVertex], model: &Model) -> Result<Vec<usize>, StitchError> {
        let passes = |border: &Border| border.vertices.iter().any(|vertex| surface.contains(vertex));
        let found: Vec<usize> = (0..self.sound.len())
            .filter(|&number| passes(&self.sound[number]))
            .collect();
        if !found.is_empty() {
            return Ok(found);
        }
        let mut of_faulty = self.faulty_vertices.iter();
        match of_faulty.find(|(vertex, _)| surface.contains(vertex)) {
            Some(&(_, number)) => Err(self.refusal(number as usize, model)),
            None => Err(StitchError::NotOnBorder { vertex: file_vertex }),
        }
    }

    /// The refusal of a faulty border.
    pub fn refusal(&self, faulty: usize, model: &Model) -> StitchError {
        let (vertex, fault) = self.faulty[faulty];
        StitchError::FaultyBorder {
            vertex: model.first_file_vertex(vertex).0,
            fault,
        }
    }
}

/// The vertices of one or more borders in one list, border after border.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Loops {
    pub vertices: Vec<SurfaceVertex>,
    /// The start of each border, and the count of all vertices.
    starts: Vec<usize>,
}

impl Loops {
    pub fn of(borders: &[Border]) -> Self {
        let mut loops = Self {
            vertices: Vec::new(),
            starts: vec![0],
        };
        for border in borders {
            loops.vertices.extend(&border.vertices);
            loops.starts.push(loops.vertices.len());
        }
        loops
    }

    /// The count of all vertices.
    pub fn count(&self) -> usize {
        self.vertices.len()
    }

    /// The places of each border.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.starts.windows(2).map(|pair| pair[0]..pair[1])
    }

    /// The place after a place on its border.
    pub fn next(&self, place: usize) -> usize {
        let own = self.border_of(place);
        if place + 1 < own.end { place + 1 } else { own.start }
    }

    /// The place before a place on its border.
    pub fn before(&self, place: usize) -> usize {
        let own = self.border_of(place);
        if place > own.start { place - 1 } else { own.end - 1 }
    }

    fn border_of(&self, place: usize) -> Range<usize> {
        let next = self.starts.partition_point(|&start| start <= place);
        self.starts[next - 1]..self.starts[next]
    }
}

/// True if the surface has a triangle with these three corners.
fn is_triangle(model: &Model, vertices: &[SurfaceVertex]) -> bool {
    let triangles = &model.surface.triangles;
    let mut around = model.topology.faces(vertices[0], triangles);
    around.any(|face| triangles[face as usize].iter().all(|corner| vertices.contains(corner)))
}

impl Border {
    /// The border along these vertices, whose edges must be among `edges` (in order of their first vertex).
    fn of(vertices: &[SurfaceVertex], positions: &[DVec3], edges: &[[SurfaceVertex; 2]]) -> Result<Self, BorderFault> {
        let has = |[from, to]: [SurfaceVertex; 2]| {
            let first = edges.partition_point(|edge| edge[0] < from);
            edges[first..]
                .iter()
                .take_while(|edge| edge[0] == from)
                .any(|edge| edge[1] == to)
        };
        let next = |place: usize| vertices[(place + 1) % vertices.len()];
        for (place, &from) in vertices.iter().enumerate() {
            if !has([from, next(place)]) {
                let is_turned = has([next(place), from]);
                return Err(if is_turned {
                    BorderFault::Misoriented
                } else {
                    BorderFault::NonManifold
                });
            }
        }
        if vertices.len() < 3 {
            return Err(BorderFault::NonManifold);
        }
        let lowest = (0..vertices.len()).min_by_key(|&place| vertices[place]).unwrap_or(0);
        let mut turned = vertices.to_vec();
        turned.rotate_left(lowest);
        let points: Vec<DVec3> = turned.iter().map(|v| positions[v.index()]).collect();
        if first_crossing(&points).is_some() {
            return Err(BorderFault::CrossesItself);
        }
        Ok(Self {
            vertices: turned,
            length: edge_lengths(&points).iter().sum(),
        })
    }
}

/// The lengths of a closed line's edges, from each point to the next.
pub(crate) fn edge_lengths(points: &[DVec3]) -> Vec<f64> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(from, to)| from.distance(*to)).collect()
}
