//! Findings as sentences for a person.

use super::{FindingKind, Findings};

/// Precedes the first example of a finding that counts neither vertices nor triangles.
const AT_VERTEX: &str = "at vertex ";

impl Findings {
    /// A sentence about a kind; `None` if its count is that of a clean, closed, connected mesh, and for edges of rims,
    /// which the sentence about holes covers.
    pub fn sentence(&self, kind: FindingKind) -> Option<String> {
        let finding = self.of(kind);
        match kind {
            FindingKind::BoundaryEdges => None,
            FindingKind::BoundaryLoops => {
                let rim = self.boundary_edges.count;
                let holes = finding.counted("hole", "holes", AT_VERTEX);
                let (has, edges) = (
                    if finding.count == 1 { "has" } else { "have" },
                    if rim == 1 { "edge" } else { "edges" },
                );
                (!finding.is_empty()).then(|| format!("{holes} {has} {rim} {edges} on the rim."))
            }
            FindingKind::Components => {
                let parts = finding.count;
                (parts > 1).then(|| format!("The surface has {parts} parts that don't touch."))
            }
            _ => {
                let Wording {
                    nouns: [one, many],
                    at,
                    predicates,
                } = Wording::of(kind)?;
                let predicate = predicates[usize::from(finding.count != 1)];
                (!finding.is_empty()).then(|| format!("{} {predicate}.", finding.counted(one, many, at)))
            }
        }
    }

    /// One sentence for each difference from a clean, closed, connected mesh; none for such a mesh.
    pub fn sentences(&self) -> Vec<String> {
        FindingKind::ALL
            .into_iter()
            .filter_map(|kind| self.sentence(kind))
            .collect()
    }
}

/// The words of a sentence that needs only the finding's count and examples; each pair is singular and plural.
struct Wording {
    nouns: [&'static str; 2],
    /// Precedes the first example.
    at: &'static str,
    predicates: [&'static str; 2],
}

impl Wording {
    /// The wording of a kind; `None` for the kinds whose sentence needs more than that.
    fn of(kind: FindingKind) -> Option<Self> {
        let of_vertices = |predicates| Self::new(["vertex", "vertices"], "", predicates);
        let of_triangles = |predicates| Self::new(["triangle", "triangles"], "", predicates);
        let of_edges = |predicates| Self::new(["edge", "edges"], AT_VERTEX, predicates);
        Some(match kind {
            FindingKind::NonFiniteVertices => of_vertices([
                "has a position that is not finite and is ignored",
                "have positions that are not finite and are ignored",
            ]),
            FindingKind::NonFiniteTriangles => of_triangles([
                "uses such a vertex and was left out",
                "use such vertices and were left out",
            ]),
            FindingKind::UnreferencedVertices => Self::new(
                ["point", "points"],
                "",
                ["is used by no triangle", "are used by no triangle"],
            ),
            FindingKind::CollapsedTriangles => of_triangles([
                "has two corners in one place and was left out",
                "have two corners in one place and were left out",
            ]),
            FindingKind::ZeroAreaTriangles => of_triangles(["has no area", "have no area"]),
            FindingKind::DuplicateTriangles => of_triangles([
                "repeats an earlier one and was left out",
                "repeat earlier ones and were left out",
            ]),
            FindingKind::NonManifoldEdges => of_edges(["has more than two triangles", "have more than two triangles"]),
            FindingKind::NonManifoldVertices => of_vertices([
                "joins parts that share nothing else there",
                "join parts that share nothing else there",
            ]),
            FindingKind::MisorientedEdges => of_edges([
                "lies between triangles that face opposite sides",
                "lie between triangles that face opposite sides",
            ]),
            FindingKind::InsideOutComponents => Self::new(
                ["closed part", "closed parts"],
                AT_VERTEX,
                [
                    "is inside out: its triangles face inwards",
                    "are inside out: their triangles face inwards",
                ],
            ),
            FindingKind::NearlyJoinedVertices => Self::new(
                ["vertex on a border", "vertices on borders"],
                AT_VERTEX,
                [
                    "is close to another border but not welded to it, and tears from it when bent: weld with a \
                     distance",
                    "are close to other borders but not welded to them, and tear from them when bent: weld with a \
                     distance",
                ],
            ),
            FindingKind::LooseBits => Self::new(
                ["loose bit", "loose bits"],
                AT_VERTEX,
                [
                    "has less than a hundredth of the largest part's vertices",
                    "have less than a hundredth of the largest part's vertices each",
                ],
            ),
            FindingKind::BoundaryEdges | FindingKind::BoundaryLoops | FindingKind::Components => return None,
        })
    }

    fn new(nouns: [&'static str; 2], at: &'static str, predicates: [&'static str; 2]) -> Self {
        Self { nouns, at, predicates }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Finding, Findings};

    #[test]
    fn sentences_count_name_and_agree() {
        let mut findings = Findings::default();
        assert!(findings.sentences().is_empty());
        findings.collapsed_triangles = Finding::of(&[7]);
        findings.non_manifold_edges = Finding::of(&[1, 2, 9]);
        findings.duplicate_triangles = Finding::of(&[1, 2, 3, 4, 5]);
        findings.boundary_edges = Finding::of(&[0, 1, 2, 3]);
        findings.boundary_loops = Finding::of(&[0]);
        findings.components = Finding::of(&[0, 5]);
        findings.loose_bits = Finding::of(&[5]);
        assert_eq!(
            findings.sentences(),
            [
                "1 triangle (7) has two corners in one place and was left out.",
                "5 triangles (1, 2, 3, ...) repeat earlier ones and were left out.",
                "3 edges (at vertex 1, 2 and 9) have more than two triangles.",
                "1 hole (at vertex 0) has 4 edges on the rim.",
                "The surface has 2 parts that don't touch.",
                "1 loose bit (at vertex 5) has less than a hundredth of the largest part's vertices.",
            ]
        );
    }
}
