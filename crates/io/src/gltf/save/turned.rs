//! Indices of triangles that are turned inside out: over their own bytes if these can hold them, otherwise as a new
//! list of triangles.

use std::collections::BTreeSet;

use ::gltf::json::accessor::ComponentType;

use crate::gltf::document::Buffer;
use crate::gltf::geometry::primitive::{Mode, Primitive};
use crate::gltf::save::copy_on_write::MeshCopy;
use crate::gltf::save::overlap::Places;
use crate::gltf::save::patch::{Patch, cannot_hold};
use crate::gltf::save::turned_triangles::Turned;
use crate::{Format, SaveError};

impl Patch<'_> {
    /// Gives primitives their turned triangles.
    pub(crate) fn turn(
        &mut self,
        meshes: &[Vec<Primitive>],
        copies: &[MeshCopy],
        turned: &Turned,
        places: &Places,
        format: Format,
    ) -> Result<(), SaveError> {
        let mut written: BTreeSet<usize> = BTreeSet::new();
        // A mesh that is shown without being drawn is not turned.
        let is_shared = |mesh: usize| copies[..meshes.len()].get(mesh).is_some_and(|own| !own.is_drawn());
        for (&(mesh, number), triangles) in turned {
            let primitive = &meshes[mesh][number];
            if let Some(indices) = primitive.indices {
                let is_alike = |(key, other): ((usize, usize), &Primitive)| {
                    other.indices != Some(indices)
                        || (other.mode == Some(Mode::Triangles)
                            && turned.get(&key) == Some(triangles)
                            && !is_shared(key.0))
                };
                let all = meshes.iter().enumerate();
                let mut all = all.flat_map(|(mesh, primitives)| {
                    let numbered = primitives.iter().enumerate();
                    numbered.map(move |(number, primitive)| ((mesh, number), primitive))
                });
                let is_written = written.contains(&indices);
                if is_written || (all.all(is_alike) && self.indices_in_place(indices, triangles, places).is_some()) {
                    written.insert(indices);
                    continue;
                }
            }
            let accessor = self.new_indices(triangles, format)?;
            let of_mesh = |&copy: &usize| copies[copy].mesh == mesh && copies[copy].is_drawn();
            for copy in (0..copies.len()).filter(of_mesh) {
                let json = &self.document.json;
                let edits = self.edits_of_copy(copies, copy);
                edits.set_member(json, primitive.at, "indices", &accessor.to_string());
                if primitive.mode != Some(Mode::Triangles) {
                    edits.set_member(json, primitive.at, "mode", "4");
                }
            }
        }
        Ok(())
    }

    /// Writes indices over the accessor's own bytes. `None`, with nothing written, if they can't hold them.
    fn indices_in_place(&mut self, accessor: usize, triangles: &[[u32; 3]], places: &Places) -> Option<()> {
        let document = self.document;
        let layout = document.layout(accessor).ok()?;
        let dense = layout.dense.filter(|_| layout.sparse.is_none())?;
        let is_its_own = places.twins(accessor).1.len() == 1 && !places.is_overlapped(accessor);
        let is_decoded = matches!(document.buffers[dense.buffer], Buffer::Decoded(_));
        let is_whole = dense.count / 3 == triangles.len() && dense.stride == dense.size;
        if !is_its_own || is_decoded || !is_whole || document.is_filled(accessor) {
            return None;
        }
        let bytes = self.own(dense.buffer)?;
        for (element, index) in triangles.as_flattened().iter().enumerate() {
            let own = &mut bytes[dense.element(element)];
            own.copy_from_slice(&index.to_le_bytes()[..dense.size]);
        }
        Some(())
    }

    /// Adds an accessor of indices, and gives its number.
    fn new_indices(&mut self, triangles: &[[u32; 3]], format: Format) -> Result<usize, SaveError> {
        let indices = triangles.as_flattened();
        // The highest index of a type is reserved.
        let is_short = indices.iter().all(|&index| index < u32::from(u16::MAX));
        let (component, size) = match is_short {
            true => (ComponentType::U16, 2),
            false => (ComponentType::U32, 4),
        };
        let bytes = indices
            .iter()
            .flat_map(|index| index.to_le_bytes().into_iter().take(size));
        let view = self.new_view(None, bytes, ",\"target\":34963");
        let view =
            view.ok_or_else(|| cannot_hold("a mesh that is turned inside out without a buffer".to_owned(), format))?;
        Ok(self.push_accessor(format!(
            "{{\"bufferView\":{view},\"componentType\":{},\"count\":{},\"type\":\"SCALAR\"}}",
            component.as_gl_enum(),
            indices.len()
        )))
    }
}
