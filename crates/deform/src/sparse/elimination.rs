//! An order of elimination, in blocks.

/// Vertices in the order of elimination, and where each block of them ends that is eliminated at once.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct Elimination {
    pub order: Vec<u32>,
    pub ends: Vec<u32>,
}

impl Elimination {
    /// What `other` orders comes behind.
    pub fn append(&mut self, other: Self) {
        let first = self.order.len() as u32;
        self.ends.extend(other.ends.iter().map(|end| first + end));
        self.order.extend(other.order);
    }
}
