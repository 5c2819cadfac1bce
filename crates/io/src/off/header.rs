//! An OFF file's first words: the contents of each vertex, and the numbers of vertices and faces.

use crate::source::Source;
use crate::text::{Cursor, excerpt, malformed_at, mark_len};
use crate::{Format, ReadError};

/// The contents of the keyword and the counts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Header {
    /// `N`: a normal after each position.
    pub(super) has_normals: bool,
    /// `C`: a colour after that.
    pub(super) has_colours: bool,
    /// `ST`: texture coordinates last.
    pub(super) has_uvs: bool,
    pub(super) vertices: usize,
    pub(super) faces: usize,
}

/// Reads the keyword, which some files leave out, and the counts, which follow it or are on a line of their own. Gives
/// the cursor after them.
///
/// # Errors
/// Refused in words: binary OFF, coordinates of other than three dimensions, and counts that the bytes can't hold.
pub(super) fn parse<'a>(source: &Source<'a>) -> Result<(Header, Cursor<'a>), ReadError> {
    let bytes: &'a [u8] = source.bytes;
    let fail = |at, reason: &str| malformed_at(source, Format::Off, at, reason);
    let mut header = Header::default();
    let mut cursor = Cursor::new(bytes, mark_len(bytes));
    cursor.skip_space_and_comments();
    let at = cursor.at();
    let word = cursor.clone().word();
    if word.ends_with(b"OFF") || word.first().is_some_and(|byte| !byte.is_ascii_digit()) {
        let Some(mut flags) = word.strip_suffix(b"OFF") else {
            return Err(fail(
                at,
                &format!(
                    "'{}' is in the place of 'OFF': export the file again as OFF",
                    excerpt(word)
                ),
            ));
        };
        cursor.word();
        for (flag, is_set) in [
            (b"ST".as_slice(), &mut header.has_uvs),
            (b"C".as_slice(), &mut header.has_colours),
            (b"N".as_slice(), &mut header.has_normals),
        ] {
            if let Some(rest) = flags.strip_prefix(flag) {
                *is_set = true;
                flags = rest;
            }
        }
        let unsupported = |feature: &str| ReadError::Unsupported {
            name: source.name.to_owned(),
            feature: feature.to_owned(),
            remedy: "export it again as ascii OFF with three coordinates a vertex".to_owned(),
        };
        match flags {
            b"" => {}
            b"4" | b"n" | b"4n" => return Err(unsupported("coordinates that are not of three dimensions")),
            _ => {
                return Err(fail(
                    at,
                    &format!("'{}' is not a kind of OFF: export the file again as OFF", excerpt(word)),
                ));
            }
        }
        let mut ahead = cursor.clone();
        ahead.skip_blanks();
        if ahead.word() == b"BINARY" {
            return Err(unsupported("the binary kind of OFF"));
        }
    }
    let mut count = |what: &str| {
        cursor.skip_space_and_comments();
        let at = cursor.at();
        let count = cursor.whole().and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| {
            fail(
                at,
                &format!("the number of {what} is missing: correct the file's header"),
            )
        })
    };
    header.vertices = count("vertices")?;
    header.faces = count("faces")?;
    // The number of edges, which is never needed and which some files leave out, ends the line.
    cursor.next_line();
    // Three digits with separators per vertex, one per face; the last needs no separator after it.
    let least = header
        .vertices
        .saturating_mul(6)
        .saturating_add(header.faces.saturating_mul(2));
    if least > cursor.left() + 1 || header.vertices >= u32::MAX as usize {
        let reason = format!(
            "the header declares {} vertices and {} faces, but only {} bytes follow: the file is cut short",
            header.vertices,
            header.faces,
            cursor.left()
        );
        return Err(source.malformed(Format::Off, reason));
    }
    Ok((header, cursor))
}
