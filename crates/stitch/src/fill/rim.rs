//! A closed line to fill.

use glam::DVec3;

/// A closed line to fill.
pub(crate) struct Rim<'a> {
    /// Its points, in order.
    pub points: &'a [DVec3],
    /// For each edge (it has the number of its first point) the third corner of the surface's triangle beyond it.
    pub beyond: &'a [DVec3],
    /// The pairs of its points that the patch must not join.
    pub joined: &'a Joined,
}

/// The pairs of a rim's points, not next to each other, that an edge outside the patch joins, or may join.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joined {
    /// The pairs that an edge of the surface joins, ascending, lower point first.
    pub edges: Vec<[u32; 2]>,
    /// The rim's points on other borders, each with the number of such a border, ascending. The patch of another border
    /// may join any two of its points. So that a border which ten thousand others touch needs no list of their pairs,
    /// they are compared when they are asked for.
    pub on_others: Vec<(u32, u32)>,
}

impl Joined {
    /// True if the patch must not join two points of the rim.
    pub fn contains(&self, a: u32, b: u32) -> bool {
        self.edges.binary_search(&[a.min(b), a.max(b)]).is_ok() || self.share_a_border(a, b)
    }

    fn share_a_border(&self, a: u32, b: u32) -> bool {
        let of = |point: u32| {
            let first = self.on_others.partition_point(|(own, _)| *own < point);
            let own = self.on_others[first..].iter();
            own.take_while(move |(own, _)| *own == point).map(|(_, border)| *border)
        };
        of(a).any(|border| of(b).any(|other| other == border))
    }
}
