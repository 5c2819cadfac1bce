//! The memory and computation that binding may use.

use std::collections::TryReserveError;

/// The limits of binding besides the mesh: in bytes, for the matrix, its factor, the data that the factorisation passes
/// on, and the data kept for every handle; in operations, for each factorisation.
///
/// Both are estimated before anything of that size is allocated or computed, and the problem is refused if they exceed
/// the budget ([`crate::BindError::Budget`]). The same problem and budget are refused on every machine alike.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Budget {
    /// In bytes.
    pub bytes: u64,
    /// Multiplications and additions of one factorisation, all attempts with a larger diagonal together: the sum of the
    /// squared column counts of its factor \[Dav06\]. The operations for a surface of as many unknowns are always
    /// allowed, so that this refuses only triangles that connect vertices at random.
    pub operations: u64,
}

/// The exceeded part of a [`Budget`], and its limit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Limit {
    /// Memory, in bytes.
    Bytes(u64),
    /// Multiplications and additions.
    Operations(u64),
}

/// A factorisation on a surface takes c n^1.5 operations for n unknowns [Dav06]: separators have about √n vertices. For
/// scans c is 110 to 230 at order 2 and at most 3,500 (order 3 on flipped triangles, which the ordering fits badly); a
/// mesh of 28,900 vertices that coincide at random takes 2·10⁵.
const OF_A_SURFACE: f64 = 1e4;

impl Default for Budget {
    /// 16 GiB: a million free vertices at order 2 take 3. And 2·10¹¹ operations: two seconds of two cores, at a measured
    /// 6·10¹⁰ a second and core.
    fn default() -> Self {
        Self {
            bytes: 16 << 30,
            operations: 200_000_000_000,
        }
    }
}

impl Budget {
    /// The default budget, with `most` bytes instead of its own if somebody has set them.
    pub fn of_most(most: Option<u64>) -> Self {
        let own = Self::default();
        Self {
            bytes: most.unwrap_or(own.bytes),
            ..own
        }
    }

    /// The budget that remains when `bytes` are used.
    pub(crate) fn without(self, bytes: u64) -> Result<Self, Limit> {
        let left = self.bytes.checked_sub(bytes);
        left.map_or(Err(Limit::Bytes(self.bytes)), |bytes| Ok(Self { bytes, ..self }))
    }

    /// The operations allowed for factorisations of this many unknowns.
    pub(crate) fn operations_for(self, unknowns: usize) -> f64 {
        (self.operations as f64).max(OF_A_SURFACE * (unknowns as f64).powf(1.5))
    }

    /// The remaining budget for one of `parts` copies.
    pub(crate) fn shared_by(self, parts: f64) -> Self {
        Self {
            bytes: (self.bytes as f64 / parts) as u64,
            ..self
        }
    }
}

/// An empty vector with capacity for this many entries, if the machine has the memory.
pub(crate) fn reserved<T>(entries: usize) -> Result<Vec<T>, TryReserveError> {
    let mut list = Vec::new();
    list.try_reserve_exact(entries)?;
    Ok(list)
}

/// This many copies of a value, if the machine has the memory.
pub(crate) fn filled<T: Clone>(value: T, entries: usize) -> Result<Vec<T>, TryReserveError> {
    let mut list = reserved(entries)?;
    list.resize(entries, value);
    Ok(list)
}

/// The bytes of this many entries of this size.
pub(crate) fn bytes_of(entries: usize, each: usize) -> u64 {
    (entries as u64).saturating_mul(each as u64)
}

/// Bytes of a vertex while it is ordered, for each power of the Laplacian: as allocated, measured by `tests/memory.rs`.
pub(crate) const ORDERING_ROW: usize = 230;

/// The approximate bytes of a binding with a thin plate's own factor (power 2) on a surface. The factors of scans of
/// 46,000 to a million unknowns have 8.2 to 10.9 n log₂ n numbers, and the data passed on while they are computed add
/// about a third.
pub(crate) fn plate_bytes(unknowns: usize) -> u64 {
    let numbers = 8.4 * unknowns as f64 * (unknowns.max(2) as f64).log2();
    (1.33 * 8.0 * numbers) as u64
}
