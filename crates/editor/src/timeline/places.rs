//! The places of handles in a frame of a sequence.

use std::collections::BTreeMap;

use glam::DVec3;

use super::span::HandlePlace;
use crate::document::{HandleId, Paint};

/// The place of each handle that has vertices, where the surface is `way` from its places in the file.
pub(crate) fn places_of_handles(paint: &[Paint], file: &[DVec3], way: &[DVec3]) -> BTreeMap<HandleId, HandlePlace> {
    let mut vertices: BTreeMap<HandleId, (Vec<DVec3>, Vec<DVec3>)> = BTreeMap::new();
    for ((paint, file), way) in paint.iter().zip(file).zip(way) {
        if let Paint::Handle(id) = paint {
            let (first, now) = vertices.entry(*id).or_default();
            first.push(*file);
            now.push(*file + *way);
        }
    }
    let places = vertices.into_iter();
    places
        .map(|(id, (first, now))| (id, HandlePlace::of(&first, &now)))
        .collect()
}
