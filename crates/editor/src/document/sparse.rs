//! A few elements of a long vector, which a step of the history keeps.

use glam::DVec3;

/// A few elements of a vector, by ascending index.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sparse<T> {
    pub(crate) indices: Vec<u32>,
    pub(crate) values: Vec<T>,
}

impl<T: Copy> Sparse<T> {
    /// Exchanges the elements with those of `whole`.
    pub(super) fn swap(&mut self, whole: &mut [T]) {
        for (&index, value) in self.indices.iter().zip(&mut self.values) {
            std::mem::swap(&mut whole[index as usize], value);
        }
    }

    /// Its memory.
    pub(super) fn bytes(&self) -> usize {
        self.indices.len() * size_of::<u32>() + self.values.len() * size_of::<T>()
    }

    /// Returns true if it has no element.
    pub(super) fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Appends an element.
    pub(super) fn push(&mut self, index: usize, value: T) {
        self.indices.push(index as u32);
        self.values.push(value);
    }
}

impl Sparse<DVec3> {
    /// The elements of `other` whose bits differ from those of `present`.
    pub(super) fn difference(present: &[DVec3], other: &[DVec3]) -> Self {
        let mut difference = Self::default();
        for (index, (here, there)) in present.iter().zip(other).enumerate() {
            if !bits_equal(*here, *there) {
                difference.push(index, *there);
            }
        }
        difference
    }

    /// `present` with the elements inserted.
    pub(super) fn applied(&self, present: &[DVec3]) -> Vec<DVec3> {
        let mut whole = present.to_vec();
        for (&index, &value) in self.indices.iter().zip(&self.values) {
            whole[index as usize] = value;
        }
        whole
    }
}

/// Returns true if two vectors are the same bits: −0 is not 0 here, because undo restores the exact value.
pub(crate) fn bits_equal(a: DVec3, b: DVec3) -> bool {
    a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)
}
