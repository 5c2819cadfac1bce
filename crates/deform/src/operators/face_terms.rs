//! A triangle's contribution to the Laplacian and to its corners' areas, by discretisation [BS08, section 5.1].

use pliant_mesh::{SurfaceVertex, area_of_lengths, cotangents, mixed_corner_areas};
use rayon::prelude::*;

use crate::Discretisation;
use crate::numerical::rows::CHUNK;
use crate::operators::mollification::{lack, mollified_lengths};
use crate::operators::triangulation::Triangulation;

/// ½ cot 60°: an equilateral triangle's weight on each of its edges.
const HALF_COTANGENT_60: f64 = 0.288_675_134_594_812_9;

/// One triangle's part.
pub(crate) struct FaceTerms {
    /// By corner: the weight on the edge opposite to it, stiffness included.
    pub half_cotangents: [f64; 3],
    /// By corner: its share of the area.
    pub areas: [f64; 3],
    /// True if the triangle was too flat for its own cotangents.
    pub mollified: bool,
}

/// A discretisation on triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Metric {
    discretisation: Discretisation,
    mean_face_area: f64,
    mean_vertex_area: f64,
}

impl Metric {
    /// Cotangents and the vertices' own areas: the default, which needs no global quantity.
    pub fn cotangent_area() -> Self {
        Self {
            discretisation: Discretisation::CotangentArea,
            mean_face_area: 1.0,
            mean_vertex_area: 1.0,
        }
    }

    pub fn of(triangulation: &Triangulation, discretisation: Discretisation) -> Self {
        if discretisation == Discretisation::CotangentArea {
            return Self::cotangent_area();
        }
        let total = total_area(triangulation);
        // A surface without any area still has a shape to solve on.
        let mean = |count: usize| if total > 0.0 { total / count as f64 } else { 1.0 };
        Self {
            discretisation,
            mean_face_area: mean(triangulation.face_count()) * triangulation.share(),
            mean_vertex_area: mean(triangulation.vertex_count()) * triangulation.share(),
        }
    }

    /// The area of every vertex, independent of its triangles.
    pub fn common_area(&self) -> Option<f64> {
        (self.discretisation == Discretisation::Cotangent).then_some(self.mean_vertex_area)
    }

    /// The terms of a triangle by corners and lengths; `stiffness` has one entry per surface vertex.
    pub fn face(&self, stiffness: &[f64], corners: [SurfaceVertex; 3], lengths: [f64; 3]) -> FaceTerms {
        let stiffness = corners.iter().map(|corner| stiffness[corner.index()]).sum::<f64>() / 3.0;
        if self.discretisation == Discretisation::Uniform {
            return FaceTerms {
                half_cotangents: [HALF_COTANGENT_60 * stiffness; 3],
                areas: [self.mean_face_area / 3.0; 3],
                mollified: false,
            };
        }
        let mollified = lack(lengths) > 0.0;
        let lengths = mollified_lengths(lengths);
        FaceTerms {
            half_cotangents: cotangents(lengths).map(|cotangent| 0.5 * stiffness * cotangent),
            areas: mixed_corner_areas(lengths),
            mollified,
        }
    }
}

/// The mean over all triangles, summed in chunks of a fixed size, so that the result does not depend on the number of
/// threads.
fn total_area(triangulation: &Triangulation) -> f64 {
    let count = triangulation.face_count();
    let partial: Vec<f64> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            (chunk * CHUNK..((chunk + 1) * CHUNK).min(count))
                .map(|face| area_of_lengths(triangulation.lengths(face as u32)))
                .sum()
        })
        .collect();
    partial.iter().sum()
}
