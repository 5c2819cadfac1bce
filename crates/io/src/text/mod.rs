//! Text files read and edited in place: a cursor over bytes, numbers as written, and a splice that replaces some spans
//! and copies everything between them.
//!
//! It works on bytes, not strings: scans contain comments and names in any encoding, and those are kept unchanged.

mod number;
mod splice;

use crate::source::Source;
use crate::{Format, ReadError, quoted};
use number::parse_real;

pub(crate) use number::{push_f32, push_f64, shortest_f32};
pub(crate) use splice::Splice;

/// A position in a text file that moves forward.
///
/// Line ends are `\n`, `\r\n` and (in old files) a bare `\r`. A method that finds nothing does not move the cursor.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// A cursor at byte `at`, which is at most the length of `bytes`.
    pub(crate) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self {
            bytes,
            at: at.min(bytes.len()),
        }
    }

    /// The cursor's position, in bytes from the start of the file.
    #[inline]
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// The number of remaining bytes.
    #[inline]
    pub(crate) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next byte, if any.
    #[inline]
    pub(crate) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Returns true if the cursor is at the end.
    #[inline]
    pub(crate) fn is_done(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Skips one byte of any kind.
    #[inline]
    pub(crate) fn step(&mut self) {
        self.at = (self.at + 1).min(self.bytes.len());
    }

    /// Returns true if the line has no more content: the cursor is at its end, the file's end, or a comment's `#`.
    #[inline]
    pub(crate) fn is_at_line_end(&self) -> bool {
        matches!(self.peek(), None | Some(b'\n' | b'\r' | b'#'))
    }

    /// Skips spaces and tabs within the line.
    #[inline]
    pub(crate) fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t' | 0x0b | 0x0c) = self.peek() {
            self.at += 1;
        }
    }

    /// Skips spaces, tabs, and line ends preceded by a backslash (OBJ's continued lines).
    #[inline]
    pub(crate) fn skip_blanks_continued(&mut self) {
        loop {
            self.skip_blanks();
            if self.peek() != Some(b'\\') {
                return;
            }
            match (self.bytes.get(self.at + 1), self.bytes.get(self.at + 2)) {
                (Some(b'\r'), Some(b'\n')) => self.at += 3,
                (Some(b'\r' | b'\n'), _) => self.at += 2,
                _ => return,
            }
        }
    }

    /// Skips white space, including line ends.
    #[inline]
    pub(crate) fn skip_space(&mut self) {
        while let Some(b' ' | b'\t'..=b'\r') = self.peek() {
            self.at += 1;
        }
    }

    /// Skips white space, line ends and `#` comments.
    pub(crate) fn skip_space_and_comments(&mut self) {
        loop {
            self.skip_space();
            if self.peek() != Some(b'#') {
                return;
            }
            self.next_line();
        }
    }

    /// Moves past the next line end.
    pub(crate) fn next_line(&mut self) {
        let rest = &self.bytes[self.at..];
        match rest.iter().position(|&byte| byte == b'\n' || byte == b'\r') {
            Some(end) if rest[end] == b'\r' && rest.get(end + 1) == Some(&b'\n') => self.at += end + 2,
            Some(end) => self.at += end + 1,
            None => self.at = self.bytes.len(),
        }
    }

    /// Returns the rest of the line without its end, and moves past it.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest
            .iter()
            .position(|&byte| byte == b'\n' || byte == b'\r')
            .unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// Returns the bytes up to the next white space (none if the cursor is on white space), and moves past them.
    pub(crate) fn word(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest
            .iter()
            .position(|byte| matches!(byte, b' ' | b'\t'..=b'\r'))
            .unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// An integer with an optional sign; it ends with its digits. `None` without digits or beyond ±10¹⁸.
    #[inline]
    pub(crate) fn integer(&mut self) -> Option<i64> {
        let mut at = self.at;
        let negative = self.bytes.get(at) == Some(&b'-');
        if negative || self.bytes.get(at) == Some(&b'+') {
            at += 1;
        }
        let first = at;
        let mut value = 0i64;
        while let Some(digit @ b'0'..=b'9') = self.bytes.get(at) {
            value = value * 10 + i64::from(digit - b'0');
            if value > 1_000_000_000_000_000_000 / 10 {
                return None;
            }
            at += 1;
        }
        if at == first {
            return None;
        }
        self.at = at;
        Some(if negative { -value } else { value })
    }

    /// An integer followed by white space, a comment or the end of the file.
    pub(crate) fn whole(&mut self) -> Option<i64> {
        let mut ahead = self.clone();
        let number = ahead.integer()?;
        if !matches!(ahead.peek(), None | Some(b' ' | b'\t'..=b'\r' | b'#')) {
            return None;
        }
        *self = ahead;
        Some(number)
    }

    /// A real number, correctly rounded, followed by white space, a comment, a backslash or the end of the file. All
    /// spellings of `nan` and `inf` are numbers.
    #[inline]
    pub(crate) fn real(&mut self) -> Option<f64> {
        let mut at = self.at;
        let negative = self.bytes.get(at) == Some(&b'-');
        if negative || self.bytes.get(at) == Some(&b'+') {
            at += 1;
        }
        let first = at;
        let mut mantissa = 0u64;
        while let Some(digit @ b'0'..=b'9') = self.bytes.get(at) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
            at += 1;
        }
        let mut digits = at - first;
        let mut decimals = 0;
        if self.bytes.get(at) == Some(&b'.') {
            at += 1;
            let first_decimal = at;
            while let Some(digit @ b'0'..=b'9') = self.bytes.get(at) {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
                at += 1;
            }
            decimals = at - first_decimal;
            digits += decimals;
        }
        // Within these limits the mantissa and the power of ten are exact in f64, so one division rounds once.
        let ends = match self.bytes.get(at) {
            None | Some(b' ' | b'\t'..=b'\r' | b'\\') => true,
            // A comment, except in `1.#QNAN`.
            Some(b'#') => digits > 0 && self.bytes[at - 1] != b'.',
            _ => false,
        };
        if ends && digits > 0 && digits <= 19 && mantissa <= 1 << 53 && decimals < POWERS_OF_TEN.len() {
            self.at = at;
            let value = mantissa as f64 / POWERS_OF_TEN[decimals];
            return Some(if negative { -value } else { value });
        }
        self.real_of_word()
    }

    /// A real number in any other notation: exponents, many digits, `nan`, `inf`, `1.#IND`.
    fn real_of_word(&mut self) -> Option<f64> {
        let mut ahead = self.clone();
        let word = ahead.word();
        if let Some(value) = parse_real(word) {
            self.at = ahead.at;
            return Some(value);
        }
        // A comment or a continuation may follow the number directly.
        let end = word.iter().position(|byte| matches!(byte, b'#' | b'\\'))?;
        let value = parse_real(&word[..end])?;
        self.at += end;
        Some(value)
    }
}

/// The powers of ten that an f64 holds exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// The number of a text's bytes that are a byte-order mark, which some editors put before UTF-8.
pub(crate) fn mark_len(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 }
}

/// A [`ReadError::Malformed`] that begins with the line of byte `at`.
pub(crate) fn malformed_at(source: &Source<'_>, format: Format, at: usize, reason: &str) -> ReadError {
    source.malformed(format, format!("line {}: {reason}", line_of(source.bytes, at)))
}

/// The line that contains byte `at`, counted from 1.
pub(crate) fn line_of(bytes: &[u8], at: usize) -> usize {
    let before = &bytes[..at.min(bytes.len())];
    let breaks = |(index, &byte): (usize, &u8)| match byte {
        b'\n' => true,
        b'\r' => bytes.get(index + 1) != Some(&b'\n'),
        _ => false,
    };
    1 + before.iter().enumerate().filter(|&pair| breaks(pair)).count()
}

/// Bytes of a file as text for a message: decoded lossily, and cut to a readable length.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(160)]);
    let blank = |letter: char| if letter.is_control() { ' ' } else { letter };
    let mut short = quoted(text.chars().map(blank).take(40).collect::<String>().trim());
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn real(text: &str) -> Option<f64> {
        Cursor::new(text.as_bytes(), 0).real()
    }

    #[test]
    fn reals_are_read_as_the_standard_library_reads_them() {
        for text in [
            "0",
            "-0",
            "1",
            "-1.5",
            ".5",
            "5.",
            "+2.25",
            "1e5",
            "-1.25E-3",
            "0.1",
            "0.30000000000000004",
            "123456789012345678",
            "9007199254740993",
            "0.00000000000000000000000001",
            "1e-320",
            "1.7976931348623157e308",
            "179769313486231570000",
            "-0.35444599999999998",
            "74.009689",
            "inf",
            "-inf",
        ] {
            assert_eq!(
                real(text).map(f64::to_bits),
                Some(text.parse::<f64>().unwrap().to_bits()),
                "{text}"
            );
        }
        for text in ["nan", "-nan", "NaN", "-nan(ind)", "1.#QNAN", "-1.#IND000"] {
            assert!(real(text).unwrap().is_nan(), "{text}");
        }
        assert_eq!(real("-1.#INF"), Some(f64::NEG_INFINITY));
        for text in ["", "-", ".", "x", "1x", "1/2", "--1", "e5", "1,5"] {
            assert_eq!(real(text), None, "{text}");
        }
    }

    #[test]
    fn a_number_ends_at_a_comment_or_a_continuation() {
        for (text, end) in [("1.5#x", 3), ("1.5\\\n", 3), ("1e3#x", 3), ("2 3", 1), ("2\r\n", 1)] {
            let mut cursor = Cursor::new(text.as_bytes(), 0);
            assert!(cursor.real().is_some(), "{text}");
            assert_eq!(cursor.at(), end, "{text}");
        }
    }

    #[test]
    fn written_numbers_read_back_bit_equal() {
        let mut bits = 0x9e37_79b9_7f4a_7c15u64;
        for _ in 0..20_000 {
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            for value in [f64::from_bits(bits), (bits as i64) as f64 / 1e12] {
                if value.is_nan() {
                    continue;
                }
                let mut text = Vec::new();
                push_f64(&mut text, value);
                assert_eq!(Cursor::new(&text, 0).real().map(f64::to_bits), Some(value.to_bits()));
                assert!(text.len() < 26);
                let narrow = value as f32;
                text.clear();
                push_f32(&mut text, narrow);
                assert_eq!(
                    Cursor::new(&text, 0).real().map(|v| (v as f32).to_bits()),
                    Some(narrow.to_bits())
                );
                assert!(text.len() < 18);
            }
        }
    }

    #[test]
    fn lines_are_counted_with_every_kind_of_end() {
        let text = b"a\nb\r\nc\rd";
        assert_eq!([0, 1, 2, 5, 7].map(|at| line_of(text, at)), [1, 1, 2, 3, 4]);
        let mut cursor = Cursor::new(text, 0);
        for start in [2, 5, 7, 8] {
            cursor.next_line();
            assert_eq!(cursor.at(), start);
        }
    }

    #[test]
    fn a_splice_changes_its_spans_and_nothing_else() {
        let mut splice = Splice::new(b"v 1 2 3 # x\n");
        splice.replace(2..3, |out| out.extend_from_slice(b"10"));
        splice.replace(6..7, |_| ());
        assert_eq!(splice.finish(), b"v 10 2  # x\n");
    }
}
