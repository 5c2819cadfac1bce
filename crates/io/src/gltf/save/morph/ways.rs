//! Accessors of targets' displacements.

use crate::gltf::save::accessors::{Bounds, number};
use crate::gltf::save::changes::Semantic;
use crate::gltf::save::patch::{Patch, cannot_hold};
use crate::{Format, SaveError};

/// The bytes of one element.
const ELEMENT: usize = 12;

/// About the bytes of JSON that a sparse accessor takes more than another.
const SPARSE_TEXT: usize = 200;

impl Patch<'_> {
    /// Adds an accessor of a target's deltas, and gives its number.
    pub(in crate::gltf::save) fn push_ways(
        &mut self,
        way: &[[f32; 4]],
        semantic: Semantic,
        format: Format,
    ) -> Result<usize, SaveError> {
        let view = self.push_elements(way.iter(), ",\"target\":34962", format)?;
        Ok(self.push_accessor(format!("{{\"bufferView\":{view},{}}}", shape(way, semantic))))
    }

    /// The same, with only the elements that are not zero if that takes fewer bytes.
    pub(super) fn push_few_ways(
        &mut self,
        way: &[[f32; 4]],
        semantic: Semantic,
        format: Format,
    ) -> Result<usize, SaveError> {
        let moved: Vec<u32> = (0..)
            .zip(way)
            .filter(|(_, way)| **way != [0.0; 4])
            .map(|(k, _)| k)
            .collect();
        let (component, size) = match moved.last() {
            Some(0..=0xff) => (5121, 1),
            Some(0x100..=0xffff) => (5123, 2),
            _ => (5125, 4),
        };
        if moved.is_empty() || moved.len() * (ELEMENT + size) + SPARSE_TEXT >= way.len() * ELEMENT {
            return self.push_ways(way, semantic, format);
        }
        let bytes = moved
            .iter()
            .flat_map(|element| element.to_le_bytes().into_iter().take(size));
        let indices = self.new_view(None, bytes, "");
        let indices = indices.ok_or_else(|| without_buffer(format))?;
        let values = self.push_elements(moved.iter().map(|element| &way[*element as usize]), "", format)?;
        let count = moved.len();
        let sparse = format!(
            "\"sparse\":{{\"count\":{count},\"indices\":{{\"bufferView\":{indices},\"componentType\":{component}}},\
             \"values\":{{\"bufferView\":{values}}}}}"
        );
        Ok(self.push_accessor(format!("{{{},{sparse}}}", shape(way, semantic))))
    }

    fn push_elements<'w>(
        &mut self,
        elements: impl Iterator<Item = &'w [f32; 4]>,
        members: &str,
        format: Format,
    ) -> Result<usize, SaveError> {
        let numbers = elements.flat_map(|element| &element[..3]);
        let view = self.new_view(None, numbers.flat_map(|number| number.to_le_bytes()), members);
        view.ok_or_else(|| without_buffer(format))
    }
}

fn without_buffer(format: Format) -> SaveError {
    cannot_hold("a file without a buffer".to_owned(), format)
}

/// The members of an accessor of displacements that don't depend on the storage.
fn shape(way: &[[f32; 4]], semantic: Semantic) -> String {
    let mut text = format!("\"componentType\":5126,\"count\":{},\"type\":\"VEC3\"", way.len());
    if semantic == Semantic::Position {
        let bounds = Bounds::of(way);
        for (key, bound) in [("max", bounds.max), ("min", bounds.min)] {
            let numbers: Vec<String> = bound[..3].iter().map(|&bound| number(bound)).collect();
            text += &format!(",\"{key}\":[{}]", numbers.join(","));
        }
    }
    text
}
