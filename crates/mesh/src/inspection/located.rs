//! A mesh's findings with the positions of their examples, so that a panel can jump to each.

use std::collections::HashMap;

use glam::DVec3;

use crate::{DrawnSet, DrawnVertex, FindingKind, Findings, Named, Surface};

/// A finding with its sentence and the positions of its first examples.
#[derive(Clone, PartialEq, Debug)]
pub struct LocatedFinding {
    /// The kind.
    pub kind: FindingKind,
    /// The count.
    pub count: usize,
    /// The sentence for a person.
    pub sentence: String,
    /// The first few.
    pub examples: Vec<Example>,
}

/// One example of a fault.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Example {
    /// Its number, of the kind that [`FindingKind::named`] gives.
    pub number: u32,
    /// Its position at rest, in world space (for a triangle, its centre); `None` if it has no finite position or is not
    /// drawn.
    pub position: Option<DVec3>,
}

impl Findings {
    /// The faults of the mesh into which `drawn` was welded.
    pub(crate) fn located_findings(&self, drawn: &DrawnSet, surface: &Surface) -> Vec<LocatedFinding> {
        let told = || {
            FindingKind::ALL
                .into_iter()
                .filter_map(|kind| Some((kind, self.sentence(kind)?)))
        };
        let named = told()
            .filter(|(kind, _)| kind.named() == Named::FileVertex)
            .flat_map(|(kind, _)| self.of(kind).examples.iter().copied());
        let places = places_of_file_vertices(drawn, surface, named);
        let place = |kind: FindingKind, number: u32| match kind.named() {
            Named::FileVertex => places.get(&number).copied(),
            Named::DrawnTriangle => centre_of_drawn_triangle(drawn, surface, number),
        };
        told()
            .map(|(kind, sentence)| {
                let finding = self.of(kind);
                let example = |&number: &u32| Example {
                    number,
                    position: place(kind, number),
                };
                LocatedFinding {
                    kind,
                    count: finding.count,
                    sentence,
                    examples: finding.examples.iter().map(example).collect(),
                }
            })
            .collect()
    }
}

/// The first finite position at which each file vertex is drawn.
fn places_of_file_vertices(
    drawn: &DrawnSet,
    surface: &Surface,
    wanted: impl Iterator<Item = u32>,
) -> HashMap<u32, DVec3> {
    let mut is_wanted = vec![false; drawn.file_vertex_count()];
    for vertex in wanted {
        if let Some(is_wanted) = is_wanted.get_mut(vertex as usize) {
            *is_wanted = true;
        }
    }
    let mut places = HashMap::new();
    for (drawn_vertex, file_vertex) in (0..).map(DrawnVertex).zip(drawn.file_vertices()) {
        if is_wanted.get(file_vertex.index()) == Some(&true) {
            let position = drawn.position(drawn_vertex, surface);
            if position.is_finite() {
                places.entry(file_vertex.0).or_insert(position);
            }
        }
    }
    places
}

fn centre_of_drawn_triangle(drawn: &DrawnSet, surface: &Surface, triangle: u32) -> Option<DVec3> {
    let corners = drawn.triangle(triangle, surface)?;
    let places = corners.map(|v| drawn.position(v, surface));
    let centre = places.iter().sum::<DVec3>() / 3.0;
    centre.is_finite().then_some(centre)
}
