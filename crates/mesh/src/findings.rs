//! What loading found wrong with a mesh, as numbers with examples and as sentences for a person.

use rayon::prelude::*;

/// How often something was found, and a few places.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finding {
    /// How many there are.
    pub count: usize,
    /// The first few of them, at most [`Findings::EXAMPLES`].
    pub examples: Vec<u32>,
}

/// What loading found wrong with a mesh. Vertices are named by their file vertex, triangles by their drawn triangle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// File vertices whose position is not finite (or beyond 1e60): set aside.
    pub non_finite_vertices: Finding,
    /// Triangles left out because they use such a vertex.
    pub non_finite_triangles: Finding,
    /// File vertices that no triangle uses: set aside, they keep their place.
    pub unreferenced_vertices: Finding,
    /// Triangles left out because two of their corners were welded into one.
    pub collapsed_triangles: Finding,
    /// Triangles kept although they have no area to speak of.
    pub zero_area_triangles: Finding,
    /// Triangles left out because an earlier one has the same three vertices.
    pub duplicate_triangles: Finding,
    /// Edges with more than two triangles; the examples are vertices on them.
    pub non_manifold_edges: Finding,
    /// Vertices whose triangles form more than one fan.
    pub non_manifold_vertices: Finding,
    /// Edges whose two triangles disagree about which side is outside; the examples are vertices on them.
    pub misoriented_edges: Finding,
    /// Edges with one triangle only; the examples are vertices on them.
    pub boundary_edges: Finding,
    /// Holes; the examples are vertices on their rims.
    pub boundary_loops: Finding,
    /// Connected parts, largest first; the examples are their first vertices.
    pub components: Finding,
}

impl Finding {
    /// All of `found`, which is in order.
    pub(crate) fn of(found: &[u32]) -> Self {
        Self {
            count: found.len(),
            examples: found[..found.len().min(Findings::EXAMPLES)].to_vec(),
        }
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The same finding with other names for the examples.
    pub(crate) fn renamed(mut self, name: impl Fn(u32) -> u32) -> Self {
        for example in &mut self.examples {
            *example = name(*example);
        }
        self
    }

    /// Adds what was found further on.
    pub(crate) fn extend(&mut self, later: &Self) {
        self.count += later.count;
        let room = Findings::EXAMPLES - self.examples.len();
        self.examples.extend(later.examples.iter().take(room));
    }

    /// Adds one more.
    pub(crate) fn push(&mut self, example: u32) {
        self.count += 1;
        if self.examples.len() < Findings::EXAMPLES {
            self.examples.push(example);
        }
    }

    /// "3 vertices (4, 5 and 9)", with the noun in the right number.
    fn phrase(&self, one: &str, many: &str) -> String {
        let shown: Vec<String> = self.examples.iter().take(3).map(u32::to_string).collect();
        let examples = match shown.as_slice() {
            [] => return format!("{} {}", self.count, if self.count == 1 { one } else { many }),
            [only] => only.clone(),
            [firsts @ .., last] if self.count == shown.len() => format!("{} and {last}", firsts.join(", ")),
            all => format!("{}, ...", all.join(", ")),
        };
        format!(
            "{} {} ({examples})",
            self.count,
            if self.count == 1 { one } else { many }
        )
    }
}

/// Finds the numbers below `count` of which `is_found` holds, in parallel.
pub(crate) fn collect(count: usize, is_found: impl Fn(usize) -> bool + Sync) -> Finding {
    const PIECE: usize = 65_536;
    let pieces: Vec<Finding> = (0..count.div_ceil(PIECE))
        .into_par_iter()
        .map(|piece| {
            let mut finding = Finding::default();
            for i in piece * PIECE..((piece + 1) * PIECE).min(count) {
                if is_found(i) {
                    finding.push(i as u32);
                }
            }
            finding
        })
        .collect();
    let mut all = Finding::default();
    for piece in &pieces {
        all.extend(piece);
    }
    all
}

impl Findings {
    /// How many examples a finding keeps.
    pub const EXAMPLES: usize = 8;

    /// One sentence for each thing that is not as in a clean, closed, connected mesh; none for such a mesh.
    pub fn sentences(&self) -> Vec<String> {
        let about = [
            (
                &self.non_finite_vertices,
                "vertex has a position that is not a finite number and was set aside",
                "vertices have positions that are not finite numbers and were set aside",
            ),
            (
                &self.non_finite_triangles,
                "triangle uses such a vertex and was left out",
                "triangles use such vertices and were left out",
            ),
            (
                &self.unreferenced_vertices,
                "vertex is used by no triangle and keeps its place",
                "vertices are used by no triangle and keep their places",
            ),
            (
                &self.collapsed_triangles,
                "triangle has two corners in one place and was left out",
                "triangles have two corners in one place and were left out",
            ),
            (
                &self.zero_area_triangles,
                "triangle has no area",
                "triangles have no area",
            ),
            (
                &self.duplicate_triangles,
                "triangle repeats an earlier one and was left out",
                "triangles repeat earlier ones and were left out",
            ),
            (
                &self.non_manifold_edges,
                "edge has more than two triangles",
                "edges have more than two triangles",
            ),
            (
                &self.non_manifold_vertices,
                "vertex joins parts of the surface that share nothing else",
                "vertices join parts of the surface that share nothing else",
            ),
            (
                &self.misoriented_edges,
                "edge lies between triangles that disagree about which side is outside",
                "edges lie between triangles that disagree about which side is outside",
            ),
        ];
        let mut sentences: Vec<String> = about
            .into_iter()
            .filter(|(finding, _, _)| !finding.is_empty())
            .map(|(finding, one, many)| sentence(finding, one, many))
            .collect();
        if !self.boundary_edges.is_empty() {
            let holes = Finding {
                examples: Vec::new(),
                ..self.boundary_loops.clone()
            };
            sentences.push(format!(
                "The surface is open: {} with {} along {} rim{}.",
                holes.phrase("hole", "holes"),
                Finding {
                    examples: Vec::new(),
                    ..self.boundary_edges.clone()
                }
                .phrase("edge", "edges"),
                if holes.count == 1 { "its" } else { "their" },
                if holes.count == 1 { "" } else { "s" },
            ));
        }
        if self.components.count > 1 {
            sentences.push(format!(
                "The surface has {} parts that don't touch.",
                self.components.count
            ));
        }
        sentences
    }
}

/// Puts the examples after the noun, which is the phrase's first word.
fn sentence(finding: &Finding, one: &str, many: &str) -> String {
    let phrase = if finding.count == 1 { one } else { many };
    let (noun, rest) = phrase.split_once(' ').unwrap_or((phrase, ""));
    format!("{} {rest}.", finding.phrase(noun, noun))
}
