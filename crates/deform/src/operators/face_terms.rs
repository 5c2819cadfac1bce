//! What one triangle adds to the Laplacian and to its corners' areas, by discretisation (survey, section 5.1).

use pliant_mesh::{Surface, SurfaceVertex, area_of_lengths, cotangents, edge_lengths, mixed_corner_areas};
use rayon::prelude::*;

use crate::Discretisation;
use crate::operators::CHUNK;

/// By how much two edges of a triangle are made to exceed the third, in units of the longest.
const MOLLIFICATION: f64 = 1e-5;

/// ½ cot 60°: an equilateral triangle's weight on each of its edges.
const HALF_COTANGENT_60: f64 = 0.288_675_134_594_812_9;

/// One triangle's part.
pub(crate) struct FaceTerms {
    /// By corner: the weight on the edge opposite to it, stiffness included.
    pub half_cotangents: [f64; 3],
    /// By corner: its share of the area.
    pub areas: [f64; 3],
    /// Whether the triangle was too flat for cotangents of its own.
    pub mollified: bool,
}

/// A discretisation on a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Metric {
    discretisation: Discretisation,
    mean_face_area: f64,
    mean_vertex_area: f64,
}

impl Metric {
    pub fn of(surface: &Surface, discretisation: Discretisation) -> Self {
        let total = match discretisation {
            Discretisation::CotangentArea => 0.0,
            Discretisation::Uniform | Discretisation::Cotangent => total_area(surface),
        };
        // A surface of no area at all still has a shape to solve on.
        let mean = |count: usize| if total > 0.0 { total / count as f64 } else { 1.0 };
        Self {
            discretisation,
            mean_face_area: mean(surface.triangles.len()),
            mean_vertex_area: mean(surface.positions.len()),
        }
    }

    /// The area that each vertex is given, whatever its triangles' are.
    pub fn common_area(&self) -> Option<f64> {
        (self.discretisation == Discretisation::Cotangent).then_some(self.mean_vertex_area)
    }

    /// The terms of the triangle `corners`; `stiffness` has one entry a surface vertex.
    pub fn face(&self, surface: &Surface, stiffness: &[f64], corners: [SurfaceVertex; 3]) -> FaceTerms {
        let stiffness = corners.iter().map(|corner| stiffness[corner.index()]).sum::<f64>() / 3.0;
        if self.discretisation == Discretisation::Uniform {
            return FaceTerms {
                half_cotangents: [HALF_COTANGENT_60 * stiffness; 3],
                areas: [self.mean_face_area / 3.0; 3],
                mollified: false,
            };
        }
        let lengths = edge_lengths(corners.map(|corner| surface.positions[corner.index()]));
        let sum = lengths[0] + lengths[1] + lengths[2];
        let longest = lengths[0].max(lengths[1]).max(lengths[2]);
        let excess = MOLLIFICATION * longest - (sum - 2.0 * longest);
        let mollified = excess > 0.0;
        let lengths = if mollified {
            lengths.map(|length| length + excess)
        } else {
            lengths
        };
        FaceTerms {
            half_cotangents: cotangents(lengths).map(|cotangent| 0.5 * stiffness * cotangent),
            areas: mixed_corner_areas(lengths),
            mollified,
        }
    }
}

/// Summed in chunks of a fixed size, so that the number of threads doesn't show.
fn total_area(surface: &Surface) -> f64 {
    let partial: Vec<f64> = surface
        .triangles
        .par_chunks(CHUNK)
        .map(|faces| {
            faces
                .iter()
                .map(|corners| area_of_lengths(edge_lengths(corners.map(|corner| surface.positions[corner.index()]))))
                .sum()
        })
        .collect();
    partial.iter().sum()
}
