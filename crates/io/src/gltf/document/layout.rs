//! The shape and place of an accessor's elements.

use std::ops::Range;

use ::gltf::json::accessor::ComponentType;

/// Elements at equal distances in a buffer, all within its bytes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Strided {
    pub buffer: usize,
    /// First byte of the first element.
    pub start: usize,
    /// Bytes from one element to the next.
    pub stride: usize,
    /// Bytes of one element.
    pub size: usize,
    pub count: usize,
}

/// An accessor's shape and place.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub component: ComponentType,
    /// The count of numbers in an element.
    pub lanes: usize,
    pub normalized: bool,
    pub count: usize,
    /// `None`: zeros.
    pub dense: Option<Strided>,
    pub sparse: Option<Sparse>,
}

/// Elements in other places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sparse {
    pub index_type: ComponentType,
    pub indices: Strided,
    pub values: Strided,
}

impl Strided {
    /// The bytes of an element within its buffer.
    pub fn element(&self, element: usize) -> Range<usize> {
        let start = self.start + element * self.stride;
        start..start + self.size
    }

    /// The place after the last byte of the last element.
    pub fn end(&self) -> usize {
        self.element(self.count.saturating_sub(1)).end
    }

    /// Returns true if an element of one shares a byte with an element of the other.
    pub fn overlaps(&self, other: &Self) -> bool {
        let apart = self.buffer != other.buffer
            || self.count == 0
            || other.count == 0
            || self.end() <= other.start
            || other.end() <= self.start;
        if apart {
            return false;
        }
        if self.stride != other.stride {
            return true;
        }
        // Interleaved: in each period the two take [0, size) and [shift, shift + other.size).
        let shift = (other.start as i128 - self.start as i128).rem_euclid(self.stride as i128) as usize;
        shift < self.size || shift + other.size > self.stride
    }
}
