//! What loading found wrong with a mesh, as numbers with examples and as sentences for a person.

use rayon::prelude::*;

/// How often something was found, and a few places.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finding {
    /// How many there are.
    pub count: usize,
    /// The first few of them or of their vertices, at most [`Findings::EXAMPLES`].
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

    /// One thing at each of `vertices`; the examples are the lowest of them, each once.
    pub(crate) fn at_vertices(vertices: impl Iterator<Item = u32>) -> Self {
        let mut vertices: Vec<u32> = vertices.collect();
        let count = vertices.len();
        vertices.sort_unstable();
        vertices.dedup();
        Self {
            count,
            ..Self::of(&vertices)
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

    /// "3 vertices (4, 5 and 9)": how many, and the first of them named by `at` and their numbers.
    fn counted(&self, one: &str, many: &str, at: &str) -> String {
        let shown: Vec<String> = self.examples.iter().take(3).map(u32::to_string).collect();
        let noun = if self.count == 1 { one } else { many };
        match shown.as_slice() {
            [] => format!("{} {noun}", self.count),
            [only] => format!("{} {noun} ({at}{only})", self.count),
            [firsts @ .., last] if self.count == shown.len() => {
                format!("{} {noun} ({at}{} and {last})", self.count, firsts.join(", "))
            }
            all => format!("{} {noun} ({at}{}, ...)", self.count, all.join(", ")),
        }
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
        let mut sentences = Vec::new();
        let mut say = |finding: &Finding, [one, many]: [&str; 2], at: &str, [is, are]: [&str; 2]| {
            if !finding.is_empty() {
                let rest = if finding.count == 1 { is } else { are };
                sentences.push(format!("{} {rest}.", finding.counted(one, many, at)));
            }
        };
        let vertices = ["vertex", "vertices"];
        let triangles = ["triangle", "triangles"];
        let edges = ["edge", "edges"];
        let at_vertex = "at vertex ";
        let not_finite = [
            "has a position that is not a finite number and was set aside",
            "have positions that are not finite numbers and were set aside",
        ];
        say(&self.non_finite_vertices, vertices, "", not_finite);
        let use_such = [
            "uses such a vertex and was left out",
            "use such vertices and were left out",
        ];
        say(&self.non_finite_triangles, triangles, "", use_such);
        let unused = [
            "is used by no triangle and keeps its place",
            "are used by no triangle and keep their places",
        ];
        say(&self.unreferenced_vertices, vertices, "", unused);
        let collapsed = [
            "has two corners in one place and was left out",
            "have two corners in one place and were left out",
        ];
        say(&self.collapsed_triangles, triangles, "", collapsed);
        say(
            &self.zero_area_triangles,
            triangles,
            "",
            ["has no area", "have no area"],
        );
        let repeated = [
            "repeats an earlier one and was left out",
            "repeat earlier ones and were left out",
        ];
        say(&self.duplicate_triangles, triangles, "", repeated);
        let crowded = ["has more than two triangles", "have more than two triangles"];
        say(&self.non_manifold_edges, edges, at_vertex, crowded);
        let pinched = [
            "joins parts that share nothing else there",
            "join parts that share nothing else there",
        ];
        say(&self.non_manifold_vertices, vertices, "", pinched);
        let disagree = [
            "lies between triangles that disagree about which side is outside",
            "lie between triangles that disagree about which side is outside",
        ];
        say(&self.misoriented_edges, edges, at_vertex, disagree);
        let open = [
            format!("lies on the rim of {}", self.holes()),
            format!("lie on the rim of {}", self.holes()),
        ];
        say(
            &self.boundary_edges,
            edges,
            at_vertex,
            open.each_ref().map(String::as_str),
        );
        if self.components.count > 1 {
            sentences.push(format!(
                "The surface has {} parts that don't touch.",
                self.components.count
            ));
        }
        sentences
    }

    fn holes(&self) -> String {
        match self.boundary_loops.count {
            1 => "a hole".to_owned(),
            count => format!("{count} holes"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(
            findings.sentences(),
            [
                "1 triangle (7) has two corners in one place and was left out.",
                "5 triangles (1, 2, 3, ...) repeat earlier ones and were left out.",
                "3 edges (at vertex 1, 2 and 9) have more than two triangles.",
                "4 edges (at vertex 0, 1, 2, ...) lie on the rim of a hole.",
                "The surface has 2 parts that don't touch.",
            ]
        );
    }

    #[test]
    fn many_are_counted_and_few_kept() {
        let finding = collect(200_000, |i| i % 3 == 1);
        assert_eq!((finding.count, finding.examples.len()), (66_667, Findings::EXAMPLES));
        assert_eq!(finding.examples[..3], [1, 4, 7]);
    }
}
