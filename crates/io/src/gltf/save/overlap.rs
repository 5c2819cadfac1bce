//! Accessors that overlap in bytes, so that writing over one would change another.
//!
//! A file has many accessors, and any two may overlap: comparing all pairs is quadratic. Here they are sorted by their
//! starts, and only a limited number of those that may extend into an accessor are compared. Beyond that number an
//! accessor counts as overlapped: an edit then gives it its own bytes, which is always correct.

use std::cell::OnceCell;
use std::collections::HashMap;

use crate::gltf::document::Document;
use crate::gltf::document::accessor::Strided;

/// The most neighbours in the bytes that are compared with one another.
const MOST_COMPARED: usize = 256;

/// The places of all accessors.
pub(crate) struct Places {
    /// The group of each accessor: accessors of one group are at the very same places.
    group_of: Vec<usize>,
    groups: Vec<Group>,
    /// Every place with its group, by buffer and then by start.
    sorted: Vec<(Strided, usize)>,
    /// For each place, the farthest end of the places of the same buffer up to it.
    reach: Vec<usize>,
}

struct Group {
    places: Vec<Strided>,
    accessors: Vec<usize>,
    is_overlapped: OnceCell<bool>,
}

impl Places {
    /// The places of a document's accessors; those that can't be read have none.
    pub fn of(document: &Document) -> Self {
        let mut known: HashMap<Vec<Strided>, usize> = HashMap::new();
        let mut groups: Vec<Group> = Vec::new();
        let mut group_of = Vec::new();
        for accessor in 0..document.accessors.len() {
            let places = places(document, accessor);
            let group = *known.entry(places.clone()).or_insert(groups.len());
            if group == groups.len() {
                groups.push(Group {
                    places,
                    accessors: Vec::new(),
                    is_overlapped: OnceCell::new(),
                });
            }
            groups[group].accessors.push(accessor);
            group_of.push(group);
        }
        let all = groups.iter().enumerate();
        let mut sorted: Vec<(Strided, usize)> = all
            .flat_map(|(number, group)| group.places.iter().map(move |&place| (place, number)))
            .filter(|(place, _)| place.count > 0)
            .collect();
        sorted.sort_by_key(|(place, group)| (place.buffer, place.start, *group));
        let mut reach: Vec<usize> = Vec::with_capacity(sorted.len());
        for (number, (place, _)) in sorted.iter().enumerate() {
            let before = number
                .checked_sub(1)
                .filter(|&before| sorted[before].0.buffer == place.buffer);
            reach.push(before.map_or(0, |before| reach[before]).max(place.end()));
        }
        Self {
            group_of,
            groups,
            sorted,
            reach,
        }
    }

    /// The places of an accessor's elements; values and indices of sparse ones come after the dense ones.
    pub fn of_accessor(&self, accessor: usize) -> &[Strided] {
        &self.groups[self.group_of[accessor]].places
    }

    /// The accessors at exactly the same place, this one included, and the number of their group.
    pub fn twins(&self, accessor: usize) -> (usize, &[usize]) {
        let group = self.group_of[accessor];
        (group, &self.groups[group].accessors)
    }

    /// Returns true if an accessor shares a byte with one at another place.
    pub fn is_overlapped(&self, accessor: usize) -> bool {
        let number = self.group_of[accessor];
        let group = &self.groups[number];
        *group
            .is_overlapped
            .get_or_init(|| group.places.iter().any(|place| self.meets_another(number, place)))
    }

    fn meets_another(&self, group: usize, place: &Strided) -> bool {
        if place.count == 0 {
            return false;
        }
        let end = self
            .sorted
            .partition_point(|(other, _)| (other.buffer, other.start) < (place.buffer, place.end()));
        let mut compared = 0;
        for number in (0..end).rev() {
            let (other, of) = &self.sorted[number];
            if other.buffer != place.buffer || self.reach[number] <= place.start {
                return false;
            }
            if *of != group && place.overlaps(other) {
                return true;
            }
            compared += 1;
            if compared > MOST_COMPARED {
                return true;
            }
        }
        false
    }
}

fn places(document: &Document, accessor: usize) -> Vec<Strided> {
    let Ok(layout) = document.layout(accessor) else {
        return Vec::new();
    };
    let sparse = layout.sparse.iter().flat_map(|sparse| [sparse.values, sparse.indices]);
    layout.dense.into_iter().chain(sparse).collect()
}
