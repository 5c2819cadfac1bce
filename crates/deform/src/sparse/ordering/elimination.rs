//! An order of elimination, with its supernodes.

/// Vertices in the order of elimination, and the end of each supernode, whose vertices are eliminated together.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct Elimination {
    pub order: Vec<u32>,
    pub ends: Vec<u32>,
}

impl Elimination {
    /// The same order with the vertices for which `is_last` holds moved to a separate supernode at the end.
    pub fn with_last(self, is_last: impl Fn(u32) -> bool) -> Self {
        let (mut first, mut last) = (Self::default(), Vec::new());
        let mut start = 0;
        for end in self.ends {
            let before = first.order.len();
            for &vertex in &self.order[start..end as usize] {
                if is_last(vertex) {
                    last.push(vertex);
                } else {
                    first.order.push(vertex);
                }
            }
            if first.order.len() > before {
                first.ends.push(first.order.len() as u32);
            }
            start = end as usize;
        }
        if !last.is_empty() {
            first.append(Self {
                ends: vec![last.len() as u32],
                order: last,
            });
        }
        first
    }

    /// Appends the order of `other`.
    pub fn append(&mut self, other: Self) {
        let first = self.order.len() as u32;
        self.ends.extend(other.ends.iter().map(|end| first + end));
        self.order.extend(other.order);
    }
}
