//! The name of a key: its row in the timeline, and its time.

use super::handle::HandleId;

/// What a key moves: the rows of the timeline.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum KeyRow {
    /// A handle, with the curve that it follows.
    Handle(HandleId),
    /// The share of the edit that is made.
    Strength,
    /// The weights of the method's examples.
    Weights,
}

impl KeyRow {
    /// The handle, if it is the row of one.
    pub fn handle(self) -> Option<HandleId> {
        match self {
            Self::Handle(id) => Some(id),
            Self::Strength | Self::Weights => None,
        }
    }
}

impl From<HandleId> for KeyRow {
    fn from(id: HandleId) -> Self {
        Self::Handle(id)
    }
}

/// A key of one row, by its time.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct KeyId {
    /// The row.
    pub row: KeyRow,
    /// The time's bits, which are in the order of the times, because none is negative.
    time_bits: u64,
}

impl KeyId {
    /// The key of a row at a time in seconds, at least 0.
    pub fn new(row: impl Into<KeyRow>, time: f64) -> Self {
        // Without the sign of -0.
        let time_bits = time.abs().to_bits();
        Self {
            row: row.into(),
            time_bits,
        }
    }

    /// Its time in seconds.
    pub fn time(self) -> f64 {
        f64::from_bits(self.time_bits)
    }
}
