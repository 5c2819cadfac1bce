//! The GLB container: a header and chunks around the JSON and the binary buffer.

use std::ops::Range;

const MAGIC: &[u8; 4] = b"glTF";
const JSON_CHUNK: u32 = 0x4e4f_534a;
const BIN_CHUNK: u32 = 0x004e_4942;
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The spans of a GLB's parts in its bytes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Container {
    /// The JSON chunk's content, padding included.
    pub json: Range<usize>,
    /// The BIN chunk's content, padding included.
    pub bin: Option<Range<usize>>,
    /// The chunks after those two.
    pub further_chunks: Range<usize>,
    /// Bytes beyond the length in the header.
    pub trailing: Range<usize>,
}

/// Returns true if the bytes begin like a GLB.
pub(crate) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Finds a GLB's parts; the error names the fault.
pub(crate) fn split(bytes: &[u8]) -> Result<Container, String> {
    let word = |at: usize| -> Option<u32> { Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?)) };
    if !is_glb(bytes) {
        return Err("it does not begin with \"glTF\"".to_owned());
    }
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err("its header is cut short".to_owned());
    };
    if version != 2 {
        return Err(format!(
            "it is glTF version {version}, but only version 2 is supported: export it again"
        ));
    }
    let end = length as usize;
    if end > bytes.len() {
        return Err(format!("its header declares {end} bytes, but it has {}", bytes.len()));
    }
    let chunk = |at: usize| -> Result<Option<(u32, Range<usize>)>, String> {
        let (Some(length), Some(kind)) = (word(at), word(at + 4)) else {
            return Ok(None);
        };
        let content = at + CHUNK_HEADER_BYTES..at + CHUNK_HEADER_BYTES + length as usize;
        if content.start > end {
            return Ok(None);
        }
        if content.end > end {
            return Err(format!(
                "the chunk at byte {at} declares {length} bytes, more than the rest of the file"
            ));
        }
        Ok(Some((kind, content)))
    };
    let Some((JSON_CHUNK, json)) = chunk(HEADER_BYTES)? else {
        return Err("its first chunk is not JSON".to_owned());
    };
    let bin = match chunk(json.end)? {
        Some((BIN_CHUNK, bin)) => Some(bin),
        _ => None,
    };
    let further = bin.as_ref().unwrap_or(&json).end;
    Ok(Container {
        json,
        bin,
        further_chunks: further..end,
        trailing: end..bytes.len(),
    })
}

/// Writes a GLB. Chunks are padded to multiples of four; `None` if the result would be beyond 4 GiB.
pub(crate) fn join(json: &[u8], bin: Option<&[u8]>, further_chunks: &[u8], trailing: &[u8]) -> Option<Vec<u8>> {
    let padded = |length: usize| length.next_multiple_of(4);
    let length = HEADER_BYTES
        + CHUNK_HEADER_BYTES
        + padded(json.len())
        + bin.map_or(0, |bin| CHUNK_HEADER_BYTES + padded(bin.len()))
        + further_chunks.len();
    let total = u32::try_from(length).ok()?;
    let mut out = Vec::with_capacity(length + trailing.len());
    out.extend_from_slice(MAGIC);
    out.extend_from_slice(&2_u32.to_le_bytes());
    out.extend_from_slice(&total.to_le_bytes());
    let mut chunk = |kind: u32, content: &[u8], padding: u8| {
        out.extend_from_slice(&(padded(content.len()) as u32).to_le_bytes());
        out.extend_from_slice(&kind.to_le_bytes());
        out.extend_from_slice(content);
        out.resize(out.len().next_multiple_of(4), padding);
    };
    chunk(JSON_CHUNK, json, b' ');
    if let Some(bin) = bin {
        chunk(BIN_CHUNK, bin, 0);
    }
    out.extend_from_slice(further_chunks);
    out.extend_from_slice(trailing);
    Some(out)
}

/// A JSON chunk's content without the spaces that pad it.
pub(crate) fn without_padding(text: &[u8]) -> &[u8] {
    let end = text.iter().rposition(|&byte| byte != b' ').map_or(0, |last| last + 1);
    &text[..end]
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_is_split_again() {
        let further = [0, 0, 0, 0, b'X', b'Y', b'Z', b'W'];
        for bin in [None, Some(&b"12345"[..]), Some(&b""[..])] {
            let bytes = join(b"{}", bin, &further, b"tail").unwrap();
            let parts = split(&bytes).unwrap();
            assert_eq!(&bytes[parts.json], b"{}  ");
            assert_eq!(
                parts.bin.map(|bin| bin.len()),
                bin.map(|bin| bin.len().next_multiple_of(4))
            );
            assert_eq!(&bytes[parts.further_chunks], further);
            assert_eq!(&bytes[parts.trailing], b"tail");
        }
    }

    #[test]
    fn a_glb_cut_anywhere_is_refused() {
        let bytes = join(b"{}", Some(b"1234"), &[], &[]).unwrap();
        for length in 0..bytes.len() {
            assert!(split(&bytes[..length]).is_err(), "{length}");
        }
    }
}
