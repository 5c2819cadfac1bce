//! A copy of a text with some spans replaced.

use std::ops::Range;

/// A copy of a file with some spans replaced, which are given in ascending order.
#[derive(Debug)]
pub(crate) struct Splice<'a> {
    source: &'a [u8],
    copied: usize,
    out: Vec<u8>,
}

impl<'a> Splice<'a> {
    /// A copy of `source` with no changes yet.
    pub(crate) fn new(source: &'a [u8]) -> Self {
        Self {
            source,
            copied: 0,
            out: Vec::with_capacity(source.len() + source.len() / 8),
        }
    }

    /// Replaces `span`, which comes after all spans replaced so far, with the bytes that `write` appends.
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
