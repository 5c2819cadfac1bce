//! How much memory binding may take.

use std::collections::TryReserveError;

/// What binding may take beside the mesh, in bytes: the matrix, its factor, what the factorisation passes on, and what
/// is kept for every handle.
///
/// Each of these is estimated before it is allocated, and the problem refused in words where they exceed the budget
/// ([`crate::BindError::Budget`]). The same problem and budget are refused on every machine alike.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Budget {
    /// In bytes.
    pub bytes: u64,
}

impl Default for Budget {
    /// 16 GiB: a million free vertices at order 2 take 3.
    fn default() -> Self {
        Self { bytes: 16 << 30 }
    }
}

impl Budget {
    /// What is left when `bytes` are taken.
    pub(crate) fn without(self, bytes: u64) -> Result<Self, Exceeded> {
        let left = self.bytes.checked_sub(bytes);
        left.map_or(Err(Exceeded), |bytes| Ok(Self { bytes }))
    }

    /// The part of it that is left for one of `parts` copies.
    pub(crate) fn shared_by(self, parts: f64) -> Self {
        Self {
            bytes: (self.bytes as f64 / parts) as u64,
        }
    }
}

/// More would be taken than there is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Exceeded;

/// Room for so many entries, where the machine has it.
pub(crate) fn reserved<T>(entries: usize) -> Result<Vec<T>, TryReserveError> {
    let mut room = Vec::new();
    room.try_reserve_exact(entries)?;
    Ok(room)
}

/// So many copies of a value, where the machine has room for them.
pub(crate) fn filled<T: Clone>(value: T, entries: usize) -> Result<Vec<T>, TryReserveError> {
    let mut room = reserved(entries)?;
    room.resize(entries, value);
    Ok(room)
}

/// Bytes of so many entries of so many bytes each.
pub(crate) fn bytes_of(entries: usize, each: usize) -> u64 {
    (entries as u64).saturating_mul(each as u64)
}
