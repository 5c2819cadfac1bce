//! Where the present shape passes through itself and the file's did not, place by place.

use glam::DVec3;
use pliant_mesh::SelfIntersections;

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
    /// The pairs that were found, as places.
    pub(super) fn of(found: &SelfIntersections) -> Self {
        let segment = |pair: usize| found.pairs[pair].segment;
        let place = |pairs: Vec<usize>| IntersectionPlace {
            segments: pairs.into_iter().map(segment).collect(),
        };
        let mut places: Vec<IntersectionPlace> = found.places().into_iter().map(place).collect();
        places.sort_by_key(|place| std::cmp::Reverse(place.segments.len()));
        Self {
            places,
            are_all: found.are_all,
        }
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
