//! The numbers of PLY records: their types, and reading and writing one in each encoding.

use std::ops::Range;

use crate::text::Cursor;

/// The encoding of the records.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number, by its old and its new name (`uchar` and `uint8`).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    pub(super) fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"int64" => Self::I64,
            b"uint64" => Self::U64,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary record.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The least and the largest value of an integer type; `None` for the floating-point types.
    pub(super) fn integer_range(self) -> Option<[f64; 2]> {
        Some(match self {
            Self::I8 => [-128.0, 127.0],
            Self::U8 => [0.0, 255.0],
            Self::I16 => [-32_768.0, 32_767.0],
            Self::U16 => [0.0, 65_535.0],
            Self::I32 => [f64::from(i32::MIN), f64::from(i32::MAX)],
            Self::U32 => [0.0, f64::from(u32::MAX)],
            Self::I64 => [-(2f64.powi(63)), 2f64.powi(63) - 1024.0],
            Self::U64 => [0.0, 2f64.powi(64) - 2048.0],
            Self::F32 | Self::F64 => return None,
        })
    }

    /// `value` as the type stores it: rounded, and cut to the range of an integer.
    pub(super) fn nearest(self, value: f64) -> f64 {
        match self.integer_range() {
            Some([least, most]) => value.round().clamp(least, most),
            None if self == Self::F32 => f64::from(value as f32),
            None => value,
        }
    }
}

/// The bytes `N` long at `at`; `None` beyond the end.
#[inline]
fn array<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// The binary number at byte `at`, as f64 (exact except for integers of 64 bits); `None` beyond the end.
#[inline]
pub(super) fn decode(bytes: &[u8], at: usize, scalar: Scalar, encoding: Encoding) -> Option<f64> {
    macro_rules! number {
        ($type:ty) => {{
            let raw = array(bytes, at)?;
            if encoding == Encoding::Big {
                <$type>::from_be_bytes(raw)
            } else {
                <$type>::from_le_bytes(raw)
            }
        }};
    }
    Some(match scalar {
        Scalar::I8 => f64::from(number!(i8)),
        Scalar::U8 => f64::from(number!(u8)),
        Scalar::I16 => f64::from(number!(i16)),
        Scalar::U16 => f64::from(number!(u16)),
        Scalar::I32 => f64::from(number!(i32)),
        Scalar::U32 => f64::from(number!(u32)),
        Scalar::I64 => number!(i64) as f64,
        Scalar::U64 => number!(u64) as f64,
        Scalar::F32 => f64::from(number!(f32)),
        Scalar::F64 => number!(f64),
    })
}

/// Writes `value`, which the type can store (see [`Scalar::nearest`]), over the binary number at byte `at`.
pub(super) fn encode(out: &mut [u8], at: usize, value: f64, scalar: Scalar, encoding: Encoding) {
    macro_rules! bytes {
        ($type:ty) => {{
            let value = value as $type;
            let raw = if encoding == Encoding::Big {
                value.to_be_bytes()
            } else {
                value.to_le_bytes()
            };
            if let Some(target) = out.get_mut(at..at + raw.len()) {
                target.copy_from_slice(&raw);
            }
        }};
    }
    match scalar {
        Scalar::I8 => bytes!(i8),
        Scalar::U8 => bytes!(u8),
        Scalar::I16 => bytes!(i16),
        Scalar::U16 => bytes!(u16),
        Scalar::I32 => bytes!(i32),
        Scalar::U32 => bytes!(u32),
        Scalar::I64 => bytes!(i64),
        Scalar::U64 => bytes!(u64),
        Scalar::F32 => bytes!(f32),
        Scalar::F64 => bytes!(f64),
    }
}

/// Reads number after number in either kind of encoding.
#[derive(Clone, Debug)]
pub(super) struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl<'a> Walk<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, encoding: Encoding) -> Self {
        Self { bytes, at, encoding }
    }

    /// The place where the search for the next number begins.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// The number of bytes that follow.
    pub(super) fn left(&self) -> u64 {
        (self.bytes.len() - self.at) as u64
    }

    /// Skips bytes without a check; the caller knows that they are there.
    pub(super) fn skip(&mut self, bytes: usize) {
        self.at = self.bytes.len().min(self.at.saturating_add(bytes));
    }

    /// The next number and its span; `None` at the file's end or if there is no number.
    #[inline]
    pub(super) fn number(&mut self, scalar: Scalar) -> Option<(f64, Range<usize>)> {
        if self.encoding == Encoding::Ascii {
            let mut cursor = Cursor::new(self.bytes, self.at);
            cursor.skip_space();
            let start = cursor.at();
            let value = cursor.real()?;
            self.at = cursor.at();
            Some((value, start..self.at))
        } else {
            let value = decode(self.bytes, self.at, scalar, self.encoding)?;
            let start = self.at;
            self.at += scalar.size();
            Some((value, start..self.at))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_is_read_as_it_was_written_in_both_byte_orders() {
        let types = [
            b"char" as &[u8],
            b"uint8",
            b"short",
            b"ushort",
            b"int32",
            b"uint",
            b"int64",
            b"uint64",
            b"float",
            b"double",
        ];
        for encoding in [Encoding::Little, Encoding::Big] {
            for scalar in types.iter().filter_map(|name| Scalar::from_name(name)) {
                for value in [-3.0, 0.0, 1.0, 100.0, 1e20] {
                    let value = scalar.nearest(value);
                    let mut bytes = vec![0xaa; 12];
                    encode(&mut bytes, 2, value, scalar, encoding);
                    assert_eq!(decode(&bytes, 2, scalar, encoding), Some(value), "{scalar:?}");
                    assert_eq!((bytes[1], bytes[2 + scalar.size()]), (0xaa, 0xaa));
                }
                assert_eq!(decode(&[0; 16], 17 - scalar.size(), scalar, encoding), None);
            }
        }
    }
}
