//! Bytes that are shared without a copy: a neighbour that a file names twice, an image within a buffer.

use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// A range of shared bytes. Cloning shares them.
#[derive(Clone, Default)]
pub struct Bytes {
    whole: Arc<Vec<u8>>,
    range: Range<usize>,
}

impl Bytes {
    /// The bytes of `range`, counted from this one's start; `None` if they are not all there.
    pub fn slice(&self, range: Range<usize>) -> Option<Self> {
        self.get(range.clone())?;
        let start = self.range.start;
        Some(Self {
            whole: Arc::clone(&self.whole),
            range: start + range.start..start + range.end,
        })
    }

    /// The place of the bytes in memory: equal only for two that share them, as long as both live.
    pub fn place(&self) -> (usize, Range<usize>) {
        (Arc::as_ptr(&self.whole).addr(), self.range.clone())
    }
}

impl From<Arc<Vec<u8>>> for Bytes {
    fn from(whole: Arc<Vec<u8>>) -> Self {
        let range = 0..whole.len();
        Self { whole, range }
    }
}

impl From<Vec<u8>> for Bytes {
    fn from(whole: Vec<u8>) -> Self {
        Self::from(Arc::new(whole))
    }
}

impl Deref for Bytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.whole[self.range.clone()]
    }
}

impl PartialEq for Bytes {
    fn eq(&self, other: &Self) -> bool {
        self.place() == other.place() || **self == **other
    }
}

impl Eq for Bytes {}

impl fmt::Debug for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_shares_the_bytes_and_stays_within_them() {
        let whole = Bytes::from(b"0123456789".to_vec());
        let part = whole.slice(2..8);
        assert_eq!(part.as_deref(), Some(&b"234567"[..]));
        let part = part.unwrap_or_default();
        assert_eq!(part.slice(1..3).as_deref(), Some(&b"34"[..]));
        assert_eq!(
            part.slice(1..3).map(|part| part.place()),
            whole.slice(3..5).map(|part| part.place())
        );
        assert!(part.slice(0..7).is_none() && whole.slice(11..12).is_none());
    }
}
