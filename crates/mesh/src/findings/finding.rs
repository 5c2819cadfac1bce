//! A fault of a mesh: its count, with examples.

use rayon::prelude::*;

/// The count of a fault, and a few places.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finding {
    /// The count.
    pub count: usize,
    /// The first few faults or their vertices, at most [`Self::EXAMPLES`].
    pub examples: Vec<u32>,
}

impl Finding {
    /// The number of examples that are kept.
    pub const EXAMPLES: usize = 8;

    const NONE: Self = Self {
        count: 0,
        examples: Vec::new(),
    };

    /// All of `found`, which is in order.
    pub(crate) fn of(found: &[u32]) -> Self {
        Self {
            count: found.len(),
            examples: found[..found.len().min(Self::EXAMPLES)].to_vec(),
        }
    }

    /// One fault at each of `vertices`; the examples are the lowest of them, each once.
    pub(crate) fn at_vertices(vertices: impl Iterator<Item = u32>) -> Self {
        let mut count = 0;
        let mut lowest: Vec<u32> = Vec::with_capacity(Self::EXAMPLES + 1);
        for vertex in vertices {
            count += 1;
            if lowest.len() == Self::EXAMPLES && vertex >= lowest[Self::EXAMPLES - 1] {
                continue;
            }
            if let Err(place) = lowest.binary_search(&vertex) {
                lowest.insert(place, vertex);
                lowest.truncate(Self::EXAMPLES);
            }
        }
        Self {
            count,
            examples: lowest,
        }
    }

    /// Returns true if nothing was found.
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

    /// Adds the faults that were found further on.
    pub(crate) fn extend(&mut self, later: &Self) {
        self.count += later.count;
        let room = Self::EXAMPLES - self.examples.len();
        self.examples.extend(later.examples.iter().take(room));
    }

    /// Adds one more.
    pub(crate) fn push(&mut self, example: u32) {
        self.count += 1;
        if self.examples.len() < Self::EXAMPLES {
            self.examples.push(example);
        }
    }

    /// "3 vertices (4, 5 and 9)": the count, and the first of them named by `at` and their numbers.
    pub(crate) fn counted(&self, one: &str, many: &str, at: &str) -> String {
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

/// Finds the numbers below `count` for which `is_found` is true, in parallel.
pub(crate) fn collect(count: usize, is_found: impl Fn(usize) -> bool + Sync) -> Finding {
    let [finding] = sort_out(count, |i| is_found(i).then_some(0));
    finding
}

/// Finds several kinds in one pass: `kind_of` returns the kind of each number below `count`, if it has one.
pub(crate) fn sort_out<const KINDS: usize>(
    count: usize,
    kind_of: impl Fn(usize) -> Option<usize> + Sync,
) -> [Finding; KINDS] {
    const PIECE: usize = 65_536;
    let none = || [const { Finding::NONE }; KINDS];
    let pieces: Vec<[Finding; KINDS]> = (0..count.div_ceil(PIECE))
        .into_par_iter()
        .map(|piece| {
            let mut findings = none();
            for i in piece * PIECE..((piece + 1) * PIECE).min(count) {
                if let Some(kind) = kind_of(i) {
                    findings[kind].push(i as u32);
                }
            }
            findings
        })
        .collect();
    let mut all = none();
    for piece in &pieces {
        for (all, later) in all.iter_mut().zip(piece) {
            all.extend(later);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_are_counted_and_few_kept() {
        let finding = collect(200_000, |i| i % 3 == 1);
        assert_eq!((finding.count, finding.examples.len()), (66_667, Finding::EXAMPLES));
        assert_eq!(finding.examples[..3], [1, 4, 7]);
        let [even, odd] = sort_out(200_000, |i| (i % 3 > 0).then_some(i % 2));
        assert_eq!((even.count, odd.count), (66_666, 66_667));
        assert_eq!((even.examples[0], odd.examples[0]), (2, 1));
    }
}
