//! A long vector in blocks that copies share until one of them writes.

use std::sync::Arc;

/// Elements of a block.
pub(crate) const BLOCK: usize = 4096;

/// A copy costs one pointer per block; a later change copies the blocks that it touches.
#[derive(Clone)]
pub(crate) struct Blocks<T>(Vec<Arc<[T]>>);

impl<T: Copy> Blocks<T> {
    pub(crate) fn of(elements: &[T]) -> Self {
        Self(elements.chunks(BLOCK).map(Arc::from).collect())
    }

    #[inline]
    pub(crate) fn get(&self, index: usize) -> T {
        self.0[index / BLOCK][index % BLOCK]
    }

    pub(crate) fn len(&self) -> usize {
        self.0.last().map_or(0, |last| (self.0.len() - 1) * BLOCK + last.len())
    }

    /// The blocks one by one, to be read, or to be written by [`Arc::make_mut`].
    pub(crate) fn each_mut(&mut self) -> &mut [Arc<[T]>] {
        &mut self.0
    }

    /// Writes into one block while all can be read: `write` gets the block, and all blocks as before the change.
    pub(crate) fn rewrite(&mut self, number: usize, write: impl FnOnce(&mut [T], &Self)) {
        let mut block = std::mem::replace(&mut self.0[number], Arc::from([]));
        write(Arc::make_mut(&mut block), self);
        self.0[number] = block;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_keeps_what_it_had_and_shares_what_nobody_wrote() {
        let numbers: Vec<u32> = (0..2 * BLOCK as u32 + 10).collect();
        let first = Blocks::of(&numbers);
        let mut second = first.clone();
        second.rewrite(1, |block, others| {
            block[3] = others.get(2);
        });
        assert_eq!((first.len(), second.len()), (numbers.len(), numbers.len()));
        assert_eq!((first.get(BLOCK + 3), second.get(BLOCK + 3)), (BLOCK as u32 + 3, 2));
        assert!(Arc::ptr_eq(&first.0[0], &second.0[0]) && !Arc::ptr_eq(&first.0[1], &second.0[1]));
        assert_eq!(second.get(2 * BLOCK + 9), 2 * BLOCK as u32 + 9);
        assert_eq!(Blocks::<u32>::of(&[]).len(), 0);
    }
}
