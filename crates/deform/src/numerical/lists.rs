//! Lists of different lengths in one array, as in the compressed rows of a sparse matrix.

/// A list for each of the numbers from 0.
#[derive(Clone, Debug)]
pub(crate) struct Lists<T = u32> {
    starts: Vec<u32>,
    entries: Vec<T>,
}

impl<T: Copy + Default> Lists<T> {
    /// The `count` lists of pairs of a list's number and an entry; each list keeps the order of its pairs.
    pub fn of(count: usize, pairs: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut starts = vec![0; count + 1];
        for (list, _) in pairs.clone() {
            starts[list as usize + 1] += 1;
        }
        for list in 0..count {
            starts[list + 1] += starts[list];
        }
        let mut next = starts.clone();
        let mut entries = vec![T::default(); starts[count] as usize];
        for (list, entry) in pairs {
            entries[next[list as usize] as usize] = entry;
            next[list as usize] += 1;
        }
        Self { starts, entries }
    }

    /// The number of lists.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The list with a number.
    #[inline]
    pub fn at(&self, list: usize) -> &[T] {
        &self.entries[self.starts[list] as usize..self.starts[list + 1] as usize]
    }
}
