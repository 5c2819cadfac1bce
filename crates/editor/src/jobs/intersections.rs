//! Where the present shape passes through itself and the file's did not, place by place.

use glam::DVec3;
use pliant_mesh::{SelfIntersection, SurfaceVertex};

/// Where the present shape passes through itself and the file's did not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intersections {
    /// The places, those with the most triangles first.
    pub places: Vec<IntersectionPlace>,
    /// Whether these are all that there are.
    pub are_all: bool,
}

/// A place where the surface passes through itself.
#[derive(Clone, Debug, PartialEq)]
pub struct IntersectionPlace {
    /// The lines in which triangles pass through each other, in world space.
    pub segments: Vec<[DVec3; 2]>,
}

impl Intersections {
    /// The pairs as places: pairs are at one where their triangles share corners.
    pub(super) fn of(pairs: &[SelfIntersection], are_all: bool) -> Self {
        let mut places: Vec<IntersectionPlace> = Vec::new();
        for numbers in groups(pairs) {
            let segments = numbers.iter().map(|&pair| pairs[pair].segment).collect();
            places.push(IntersectionPlace { segments });
        }
        places.sort_by_key(|place| std::cmp::Reverse(place.segments.len()));
        Self { places, are_all }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// What is wrong, and what helps, in words; `None` if there is none.
    pub fn sentence(&self) -> Option<String> {
        let remedy = "lower the strength, or move the handle back";
        match (self.places.len(), self.are_all) {
            (0, _) => None,
            (1, true) => Some(format!("The shape passes through itself: {remedy}.")),
            (count, true) => Some(format!("The shape passes through itself in {count} places: {remedy}.")),
            (count, false) => Some(format!(
                "The shape passes through itself in {count} places and more: {remedy}."
            )),
        }
    }
}

/// The numbers of pairs that hang together by corners, in the order of the first of each.
fn groups(pairs: &[SelfIntersection]) -> Vec<Vec<usize>> {
    let corners = |pair: &SelfIntersection| pair.triangles.into_iter().flatten();
    let mut all: Vec<SurfaceVertex> = pairs.iter().flat_map(corners).collect();
    all.sort_unstable();
    all.dedup();
    let place = |corner: SurfaceVertex| all.partition_point(|&other| other < corner);
    let mut parent: Vec<usize> = (0..all.len()).collect();
    fn root(parent: &mut [usize], mut at: usize) -> usize {
        while parent[at] != at {
            parent[at] = parent[parent[at]];
            at = parent[at];
        }
        at
    }
    for pair in pairs {
        let mut corners = corners(pair).map(place);
        if let Some(first) = corners.next() {
            for other in corners {
                let (a, b) = (root(&mut parent, first), root(&mut parent, other));
                parent[a.max(b)] = a.min(b);
            }
        }
    }
    let mut group_of_root = std::collections::BTreeMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (number, pair) in pairs.iter().enumerate() {
        let own = root(&mut parent, place(pair.triangles[0][0]));
        let group = *group_of_root.entry(own).or_insert_with(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[group].push(number);
    }
    groups
}
