//! A PLY file's header: the elements that follow, their counts and their properties.

use std::ops::Range;

use super::scalar::{Encoding, Scalar};
use crate::source::{Looks, Source};
use crate::text::{Cursor, excerpt, malformed_at, mark_len};
use crate::{Format, ReadError};

/// The kind of a property's value in a record.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    /// The number of records in the header, checked against the bytes later.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The bytes of a binary record; `None` if a list makes them vary.
    pub(super) fn stride(&self) -> Option<usize> {
        self.properties.iter().try_fold(0, |sum, property| match property.kind {
            Kind::Scalar(scalar) => Some(sum + scalar.size()),
            Kind::List { .. } => None,
        })
    }

    /// The fewest bytes that a record can take: a digit and a separator a number in ascii, empty lists in binary.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> u64 {
        let of_property = |property: &Property| match (encoding, property.kind) {
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(scalar) | Kind::List { count: scalar, .. }) => scalar.size() as u64,
        };
        self.properties.iter().map(of_property).sum()
    }

    /// The number of the first property with one of these names, in any case.
    pub(super) fn property(&self, names: &[&str]) -> Option<usize> {
        let is_named = |property: &Property| names.iter().any(|name| property.name.eq_ignore_ascii_case(name));
        self.properties.iter().position(is_named)
    }
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The places of the names after `comment TextureFile`.
    pub(super) textures: Vec<Range<usize>>,
    /// The start of the first record.
    pub(super) data_at: usize,
}

/// The most textures that are read: more than any real file has.
const MOST_TEXTURES: usize = 256;

/// Reads the header, whose lines may end in any way.
///
/// # Errors
/// Anything that makes the records' layout uncertain.
pub(super) fn parse(source: &Source<'_>) -> Result<Header, ReadError> {
    let bytes: &[u8] = source.bytes;
    let fail = |at, reason: &str| malformed_at(source, Format::Ply, at, reason);
    let mut cursor = Cursor::new(bytes, mark_len(bytes));
    if cursor.rest_of_line().trim_ascii() != b"ply" {
        return Err(fail(0, "the file doesn't begin with 'ply': export it again as PLY"));
    }
    let ends_in_return_alone = bytes.get(cursor.at()) == Some(&b'\r') && bytes.get(cursor.at() + 1) != Some(&b'\n');
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut textures = Vec::new();
    let mut looks = Looks::default();
    loop {
        cursor.next_line();
        if cursor.is_done() {
            return Err(fail(
                cursor.at(),
                "the header has no 'end_header': the file is cut short",
            ));
        }
        let at = cursor.at();
        source.pass(&mut looks, at)?;
        let line = cursor.clone().rest_of_line();
        let words: Vec<&[u8]> = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty())
            .take(6)
            .collect();
        match words.as_slice() {
            [b"format", name, ..] => {
                encoding = Some(match *name {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::Little,
                    b"binary_big_endian" => Encoding::Big,
                    other => {
                        return Err(fail(
                            at,
                            &format!("'{}' is not a format of PLY: export it again", excerpt(other)),
                        ));
                    }
                });
            }
            [b"element", name, count, ..] => {
                let count = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                let count = count.ok_or_else(|| fail(at, "the element's count is not a number: correct the header"))?;
                elements.push(Element {
                    name: text(name),
                    count,
                    properties: Vec::new(),
                });
            }
            [b"property", rest @ ..] => {
                let property = property(rest).ok_or_else(|| {
                    fail(
                        at,
                        &format!("'{}' is not a property: correct the header", excerpt(line)),
                    )
                })?;
                let Some(element) = elements.last_mut() else {
                    return Err(fail(
                        at,
                        "a property comes before the first element: correct the header",
                    ));
                };
                element.properties.push(property);
            }
            // Names may have blanks.
            [b"comment", b"TextureFile", ..] if textures.len() < MOST_TEXTURES => {
                let keyword = line.windows(11).position(|word| word == b"TextureFile").unwrap_or(0) + 11;
                let name = &line[keyword..];
                let start = at + keyword + (name.len() - name.trim_ascii_start().len());
                textures.push(start..start + name.trim_ascii().len());
            }
            [b"end_header", ..] => break,
            _ => {}
        }
    }
    let encoding = encoding.ok_or_else(|| fail(cursor.at(), "the header has no 'format' line: add one"))?;
    cursor.rest_of_line();
    // Data may begin with a byte that looks like the second half of a line break.
    if ends_in_return_alone {
        cursor.step()
    } else {
        cursor.next_line()
    }
    Ok(Header {
        encoding,
        elements,
        textures,
        data_at: cursor.at(),
    })
}

fn property(words: &[&[u8]]) -> Option<Property> {
    match *words {
        [b"list", count, item, name, ..] => {
            let (count, item) = (Scalar::from_name(count)?, Scalar::from_name(item)?);
            Some(Property {
                name: text(name),
                kind: Kind::List { count, item },
            })
        }
        [scalar, name, ..] => Some(Property {
            name: text(name),
            kind: Kind::Scalar(Scalar::from_name(scalar)?),
        }),
        _ => None,
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
