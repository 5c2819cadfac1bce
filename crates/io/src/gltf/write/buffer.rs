//! A glTF under construction: its one buffer, and the views and accessors into it.

use serde_json::{Value, json};

/// A glTF under construction.
#[derive(Default)]
pub(super) struct Built {
    pub(super) root: Value,
    pub(super) bin: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
    pub(super) warnings: Vec<String>,
    /// As [`Saved::triangles`].
    pub(super) triangles: Option<Vec<u32>>,
}

impl Built {
    /// Puts numbers into the buffer, as a view for vertices or indices.
    pub(super) fn view<T, const N: usize>(
        &mut self,
        numbers: impl Iterator<Item = T>,
        bytes: impl Fn(T) -> [u8; N],
        target: u32,
    ) -> usize {
        let view = self.bytes(numbers.flat_map(bytes));
        self.views[view]["target"] = target.into();
        view
    }

    /// Puts bytes into the buffer, as a view.
    pub(super) fn bytes(&mut self, bytes: impl Iterator<Item = u8>) -> usize {
        let start = self.bin.len();
        self.bin.extend(bytes);
        let length = self.bin.len() - start;
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views
            .push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        self.views.len() - 1
    }

    pub(super) fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
