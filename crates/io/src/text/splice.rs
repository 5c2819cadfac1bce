//! A copy of a text in which some spans are replaced.

use std::ops::Range;

/// A copy of a file with some spans replaced, given in rising order.
#[derive(Debug)]
pub(crate) struct Splice<'a> {
    source: &'a [u8],
    copied: usize,
    out: Vec<u8>,
}

impl<'a> Splice<'a> {
    /// A copy of `source` without changes so far.
    pub(crate) fn new(source: &'a [u8]) -> Self {
        Self {
            source,
            copied: 0,
            out: Vec::with_capacity(source.len() + source.len() / 8),
        }
    }

    /// Puts what `write` appends in the place of `span`, which stands behind all spans replaced so far.
    pub(crate) fn replace(&mut self, span: Range<usize>, write: impl FnOnce(&mut Vec<u8>)) {
        debug_assert!(self.copied <= span.start && span.start <= span.end && span.end <= self.source.len());
        self.out.extend_from_slice(&self.source[self.copied..span.start]);
        write(&mut self.out);
        self.copied = span.end;
    }

    /// The changed copy.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        self.out.extend_from_slice(&self.source[self.copied..]);
        self.out
    }
}
