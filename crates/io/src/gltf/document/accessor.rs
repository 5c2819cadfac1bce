//! Accessors as strided bytes: the place of each element, checked against the buffers before anything is read.

use ::gltf::json::accessor::{ComponentType, Type};
use ::gltf::json::validation::Checked;
use rayon::prelude::*;

use crate::gltf::document::Document;
pub(crate) use crate::gltf::document::layout::{Layout, Sparse, Strided};

/// The number of elements that a task reads.
const CHUNK: usize = 1 << 14;

impl Document {
    /// An accessor's layout, checked once, or a sentence about its fault.
    pub fn layout(&self, accessor: usize) -> Result<Layout, String> {
        match self.layouts.get(accessor) {
            Some(layout) => layout.get_or_init(|| Layout::of(self, accessor)).clone(),
            None => Layout::of(self, accessor),
        }
    }
}

impl Layout {
    /// Checks an accessor against its buffer views and buffers; the error names the fault. [`Document::layout`] caches
    /// the result.
    pub fn of(document: &Document, index: usize) -> Result<Self, String> {
        Self::check(document, index).map_err(|reason| format!("accessor {index} {reason}"))
    }

    fn check(document: &Document, index: usize) -> Result<Self, String> {
        let accessor = document.accessors.get(index).ok_or("does not exist")?;
        let (Checked::Valid(component), Checked::Valid(kind)) = (accessor.component_type, accessor.type_) else {
            return Err("has an unknown type".to_owned());
        };
        let component = component.0;
        let lanes = lanes(kind);
        let count = usize::try_from(accessor.count.0).map_err(|_| "has too many elements")?;
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let size = lanes * component.size();
        let dense = accessor
            .buffer_view
            .map(|view| strided(document, view.value(), offset, size, count, Packing::ByView))
            .transpose()?;
        let sparse = match &accessor.sparse {
            None => None,
            Some(sparse) => {
                let some = usize::try_from(sparse.count.0).map_err(|_| "has too many sparse elements")?;
                let Checked::Valid(index_type) = sparse.indices.component_type else {
                    return Err("has sparse indices of an unknown type".to_owned());
                };
                let index_size = index_type.0.size();
                let (indices, values) = (&sparse.indices, &sparse.values);
                let view = |view: usize, offset, size| strided(document, view, offset, size, some, Packing::Tight);
                Some(Sparse {
                    index_type: index_type.0,
                    indices: view(indices.buffer_view.value(), indices.byte_offset.0, index_size)?,
                    values: view(values.buffer_view.value(), values.byte_offset.0, size)?,
                })
            }
        };
        if let Some(sparse) = sparse.filter(|sparse| sparse.indices.count > count) {
            let some = sparse.indices.count;
            return Err(format!("has {some} sparse elements, more than its {count} elements"));
        }
        // Zeros take no bytes in the file, so their number is limited by the file's size.
        if dense.is_none() && count > document.loaded_bytes {
            return Err(format!(
                "has {count} elements without bytes, more than the file has bytes"
            ));
        }
        let layout = Self {
            component,
            lanes,
            normalized: accessor.normalized,
            count,
            dense,
            sparse,
        };
        if layout
            .sparse_elements(document)
            .iter()
            .any(|&element| element as usize >= count)
        {
            return Err(format!("has a sparse index beyond its {count} elements"));
        }
        Ok(layout)
    }

    /// The elements in the sparse values, in their order.
    pub fn sparse_elements(&self, document: &Document) -> Vec<u32> {
        self.sparse.as_ref().map_or_else(Vec::new, |sparse| {
            let bytes = document.buffer(sparse.indices.buffer);
            (0..sparse.indices.count)
                .map(|k| index(&bytes[sparse.indices.element(k)], sparse.index_type))
                .collect()
        })
    }

    /// All elements as f32, the first `N` numbers of each (missing ones 0); integers are normalised if the accessor
    /// says so.
    pub fn floats<const N: usize>(&self, document: &Document) -> Vec<[f32; N]> {
        let read = |strided: &Strided, element: usize| -> [f32; N] {
            let bytes = &document.buffer(strided.buffer)[strided.element(element)];
            let size = self.component.size();
            std::array::from_fn(|lane| {
                if lane < self.lanes {
                    float(&bytes[lane * size..], self.component, self.normalized)
                } else {
                    0.0
                }
            })
        };
        let mut out: Vec<[f32; N]> = match &self.dense {
            None => vec![[0.0; N]; self.count],
            Some(dense) => (0..self.count)
                .into_par_iter()
                .with_min_len(CHUNK)
                .map(|element| read(dense, element))
                .collect(),
        };
        if let Some(sparse) = &self.sparse {
            for (k, element) in self.sparse_elements(document).into_iter().enumerate() {
                out[element as usize] = read(&sparse.values, k);
            }
        }
        out
    }

    /// All elements as indices; the error names the fault.
    pub fn indices(&self, document: &Document) -> Result<Vec<u32>, String> {
        let is_index = matches!(
            self.component,
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32
        );
        if !is_index || self.lanes != 1 {
            return Err("are not unsigned integers".to_owned());
        }
        let mut out: Vec<u32> = match &self.dense {
            None => vec![0; self.count],
            Some(dense) => {
                let bytes = document.buffer(dense.buffer);
                let read = |element| index(&bytes[dense.element(element)], self.component);
                (0..self.count).into_par_iter().with_min_len(CHUNK).map(read).collect()
            }
        };
        if let Some(sparse) = &self.sparse {
            let bytes = document.buffer(sparse.values.buffer);
            for (k, element) in self.sparse_elements(document).into_iter().enumerate() {
                out[element as usize] = index(&bytes[sparse.values.element(k)], self.component);
            }
        }
        Ok(out)
    }
}

/// The count of numbers in an element of an accessor; `None` for an unknown type.
pub(crate) fn lanes_of(accessor: &::gltf::json::Accessor) -> Option<usize> {
    match accessor.type_ {
        Checked::Valid(kind) => Some(lanes(kind)),
        Checked::Invalid => None,
    }
}

fn lanes(kind: Type) -> usize {
    match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

/// The spacing of elements in their buffer view.
#[derive(Clone, Copy, PartialEq)]
enum Packing {
    /// By the view's stride, or tight without one.
    ByView,
    /// Without gaps, for any view.
    Tight,
}

fn strided(
    document: &Document,
    view: usize,
    offset: u64,
    size: usize,
    count: usize,
    packing: Packing,
) -> Result<Strided, String> {
    let found = document
        .views
        .get(view)
        .ok_or_else(|| format!("names buffer view {view}, which does not exist"))?;
    let buffer = found.buffer.value();
    if buffer >= document.buffers.len() {
        return Err(format!("is in buffer {buffer}, which does not exist"));
    }
    let stride = match found.byte_stride {
        Some(stride) if packing == Packing::ByView && stride.0 != 0 => stride.0,
        _ => size,
    };
    let there = document.buffer(buffer).len();
    let place = || {
        let view_start = usize::try_from(found.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let view_end = view_start.checked_add(usize::try_from(found.byte_length.0).ok()?)?;
        let start = view_start.checked_add(usize::try_from(offset).ok()?)?;
        let length = match count.checked_sub(1) {
            None => 0,
            Some(last) => last.checked_mul(stride)?.checked_add(size)?,
        };
        let end = start.checked_add(length)?;
        (end <= view_end && end <= there).then_some(start)
    };
    match place() {
        Some(start) => Ok(Strided {
            buffer,
            start,
            stride,
            size,
            count,
        }),
        None => Err(format!(
            "needs {count} elements, more than buffer view {view} has in the {there} bytes of buffer {buffer}"
        )),
    }
}

#[inline]
fn index(bytes: &[u8], component: ComponentType) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, &[a, ..]) => u32::from(a),
        (ComponentType::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
        (_, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

#[inline]
fn float(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, most) = match (component, bytes) {
        (ComponentType::F32, &[a, b, c, d, ..]) => return f32::from_le_bytes([a, b, c, d]),
        (ComponentType::U32, &[a, b, c, d, ..]) => (u32::from_le_bytes([a, b, c, d]) as f32, u32::MAX as f32),
        (ComponentType::I8, &[a, ..]) => (f32::from(a.cast_signed()), 127.0),
        (ComponentType::U8, &[a, ..]) => (f32::from(a), 255.0),
        (ComponentType::I16, &[a, b, ..]) => (f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (ComponentType::U16, &[a, b, ..]) => (f32::from(u16::from_le_bytes([a, b])), 65535.0),
        _ => return 0.0,
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interleaved_elements_do_not_overlap_and_shifted_ones_do() {
        let a = Strided {
            buffer: 0,
            start: 0,
            stride: 24,
            size: 12,
            count: 8,
        };
        let at = |start, stride| Strided { start, stride, ..a };
        assert!(!a.overlaps(&at(12, 24)));
        assert!(!at(12, 24).overlaps(&a));
        assert!(a.overlaps(&a));
        assert!(a.overlaps(&at(24, 24)) && a.overlaps(&at(8, 24)) && a.overlaps(&at(20, 24)));
        assert!(
            a.overlaps(&at(12, 12)),
            "unequal strides within one range are taken to overlap"
        );
        assert!(!a.overlaps(&at(180, 24)));
        assert!(!a.overlaps(&Strided { buffer: 1, ..a }));
        assert!(!a.overlaps(&Strided { count: 0, ..a }));
    }
}
