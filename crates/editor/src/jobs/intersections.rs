//! The faults of a shape: the places where it passes through itself and the file's did not, and damaged triangles and
//! edges.

use glam::DVec3;
use pliant_deform::{Method, Remedy};
use pliant_mesh::{Damage, SelfIntersections, point_in_words};

/// The places where the present shape passes through itself and the file's did not, and its other faults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intersections {
    /// The places, those with the most triangles first.
    pub places: Vec<IntersectionPlace>,
    /// Whether these are all places.
    pub are_all: bool,
    /// Damaged triangles and edges.
    pub damage: Damage,
}

/// A place where the surface passes through itself.
#[derive(Clone, Debug, PartialEq)]
pub struct IntersectionPlace {
    /// The lines in which triangles pass through each other, in world space.
    pub segments: Vec<[DVec3; 2]>,
}

impl Intersections {
    /// The found pairs, grouped by place, and the other faults.
    pub fn of(found: &SelfIntersections, damage: Damage) -> Self {
        let segment = |pair: usize| found.pairs[pair].segment;
        let place = |pairs: Vec<usize>| IntersectionPlace {
            segments: pairs.into_iter().map(segment).collect(),
        };
        let mut places: Vec<IntersectionPlace> = found.places().into_iter().map(place).collect();
        places.sort_by_key(|place| std::cmp::Reverse(place.segments.len()));
        Self {
            places,
            are_all: found.are_all,
            damage,
        }
    }

    /// Whether the shape does not pass through itself.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// All faults of a shape by this method, in words.
    pub fn sentences(&self, method: &Method) -> Vec<String> {
        let remedy = Remedy::OfDamageBy(method.name()).to_string();
        self.sentence()
            .into_iter()
            .chain(self.damage.sentences(&remedy))
            .collect()
    }

    /// The places where the shape passes through itself, and the remedies, in words; `None` if there are none.
    pub fn sentence(&self) -> Option<String> {
        let remedy = "lower the strength, or move the handle back";
        let [first, _] = *self.places.first()?.segments.first()?;
        let at = format!("at {}", point_in_words(first));
        Some(match (self.places.len(), self.are_all) {
            (1, true) => format!("The shape passes through itself {at}: {remedy}."),
            (count, true) => format!("The shape passes through itself in {count} places, first {at}: {remedy}."),
            (count, false) => {
                format!("The shape passes through itself in {count} places and more, first {at}: {remedy}.")
            }
        })
    }
}
