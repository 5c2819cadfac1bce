//! The bytes of buffers, buffer views and images, and the decoded bytes of views and accessors.

use std::ops::Range;
use std::sync::Arc;

use ::gltf::json as schema;
use ::gltf::json::validation::USize64;

use super::Document;
use super::origin::{Buffer, ImageFile};
use crate::Bytes;

impl Document {
    /// The bytes of a buffer.
    pub fn buffer(&self, buffer: usize) -> &[u8] {
        match self.buffers.get(buffer) {
            Some(Buffer::Bin(range)) => &self.file[range.clone()],
            Some(Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } | Buffer::Decoded(bytes)) => bytes,
            Some(Buffer::Absent) | None => &[],
        }
    }

    /// The bytes of a buffer view; `None` if they are not all there.
    pub fn view(&self, view: usize) -> Option<&[u8]> {
        let (buffer, range) = self.place_of_view(view)?;
        self.buffer(buffer).get(range)
    }

    /// The encoded bytes of an image, shared with their owner; `None` if they are missing.
    pub fn image(&self, image: usize) -> Option<Bytes> {
        match self.images.get(image)? {
            ImageFile::View(view) => {
                let (buffer, range) = self.place_of_view(*view)?;
                match self.buffers.get(buffer)? {
                    Buffer::Bin(bin) => Bytes::from(Arc::clone(&self.file)).slice(bin.clone())?.slice(range),
                    Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } | Buffer::Decoded(bytes) => {
                        bytes.slice(range)
                    }
                    Buffer::Absent => None,
                }
            }
            ImageFile::Data(bytes) => Some(bytes.clone()),
            ImageFile::Neighbour { bytes, .. } => bytes.clone(),
            ImageFile::Absent => None,
        }
    }

    /// A view's buffer, and its bytes there.
    pub fn place_of_view(&self, view: usize) -> Option<(usize, Range<usize>)> {
        let view = self.views.get(view)?;
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let length = usize::try_from(view.byte_length.0).ok()?;
        Some((view.buffer.value(), start..start.checked_add(length)?))
    }

    /// Makes a buffer view of the file refer to its decoded bytes.
    pub fn redirect_view(&mut self, view: usize, bytes: Vec<u8>, stride: Option<usize>) {
        let (buffer, length) = (self.buffers.len() as u32, bytes.len() as u64);
        let Some(view) = self.views.get_mut(view) else { return };
        view.buffer = schema::Index::new(buffer);
        view.byte_offset = None;
        view.byte_length = USize64(length);
        view.byte_stride = stride.map(schema::buffer::Stride);
        self.buffers.push(Buffer::Decoded(bytes.into()));
    }

    /// Gives an accessor its own bytes, elements tightly packed, in a buffer view that the file does not have.
    pub fn fill_accessor(&mut self, accessor: usize, bytes: Vec<u8>) {
        let Some(accessor) = self.accessors.get_mut(accessor) else {
            return;
        };
        accessor.buffer_view = Some(schema::Index::new(self.views.len() as u32));
        accessor.byte_offset = None;
        self.views.push(schema::buffer::View {
            buffer: schema::Index::new(self.buffers.len() as u32),
            byte_length: USize64(bytes.len() as u64),
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: Default::default(),
        });
        self.buffers.push(Buffer::Decoded(bytes.into()));
    }

    /// Returns true if an accessor's bytes were decoded from a compressed primitive.
    pub fn is_filled(&self, accessor: usize) -> bool {
        let view = self.accessors.get(accessor).and_then(|accessor| accessor.buffer_view);
        view.is_some_and(|view| view.value() >= self.views_at.len())
    }
}
