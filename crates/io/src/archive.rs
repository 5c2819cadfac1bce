//! The zip archives of 3MF and USDZ: their parts by name, and copies with some of them replaced.

use std::borrow::Cow;
use std::io::{Cursor, Read, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::quote::quoted;

/// The bytes that parts may have for each byte of the archive.
const MOST_GROWTH: u64 = 64;

/// The allowance for the parts of the smallest archives.
const PARTS_ANYWAY: u64 = 64 << 20;

/// The way in which parts are packed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Packing {
    /// Compressed.
    Deflated,
    /// As they are, each from a multiple of 64 bytes on: programs map the parts of a USDZ into memory.
    Aligned,
}

/// An archive whose parts take at most a multiple of its own size.
pub(crate) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    left: u64,
}

/// The content of a part, and its place in the archive.
pub(crate) struct PartBytes {
    pub place: usize,
    pub bytes: Vec<u8>,
}

impl<'a> Archive<'a> {
    /// Reads an archive's directory.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|error| said(&error))?;
        let left = (bytes.len() as u64).saturating_mul(MOST_GROWTH).max(PARTS_ANYWAY);
        Ok(Self { zip, left })
    }

    /// The name of the first part; `None` if there is no part.
    pub fn first_name(&mut self) -> Option<String> {
        let first = self.zip.by_index_raw(0).ok()?;
        first.name().ok().map(|name| name.into_owned())
    }

    /// The content of the part with this name, which may begin with a slash; names differ in more than case.
    ///
    /// # Errors
    /// It is missing, damaged or larger than the archive justifies.
    pub fn part(&mut self, name: &str) -> Result<PartBytes, String> {
        let wanted = name.trim_start_matches('/');
        let place = self.zip.index_for_name(wanted).or_else(|| {
            let names = self.zip.file_names().filter_map(Result::ok);
            let other = names.into_iter().find(|other| other.eq_ignore_ascii_case(wanted));
            other.and_then(|other| self.zip.index_for_name(&other))
        });
        let place = place.ok_or_else(|| format!("it has no part {}", quoted(wanted)))?;
        let in_part = |why: String| format!("its part {}: {why}", quoted(wanted));
        let file = self.zip.by_index(place).map_err(|error| in_part(said(&error)))?;
        let mut bytes = Vec::new();
        // The declared size may lie: only what was read counts.
        let read = file.take(self.left + 1).read_to_end(&mut bytes);
        read.map_err(|error| in_part(format!("it is damaged ({})", quoted(&error.to_string()))))?;
        let length = bytes.len() as u64;
        self.left = self.left.checked_sub(length).ok_or_else(|| {
            in_part("it unpacks to more than an archive of this size can hold; export it again".to_owned())
        })?;
        Ok(PartBytes { place, bytes })
    }
}

/// A copy of an archive in which the parts at these places have other contents; every other part is copied as it is
/// compressed.
///
/// # Errors
/// The archive's fault, in words.
pub(crate) fn with_parts(bytes: &[u8], parts: &[(usize, Vec<u8>)], packing: Packing) -> Result<Vec<u8>, String> {
    let fault = |error: ZipError| said(&error);
    let mut old = ZipArchive::new(Cursor::new(bytes)).map_err(fault)?;
    let mut new = ZipWriter::new(Cursor::new(Vec::with_capacity(bytes.len())));
    new.set_raw_comment(old.comment().into()).map_err(fault)?;
    for place in 0..old.len() {
        let mut file = old.by_index_raw(place).map_err(fault)?;
        let replaced = parts.iter().find(|(other, _)| *other == place);
        let content = match replaced {
            Some((_, content)) => Cow::Borrowed(content),
            // A copy as it is would not keep the multiple at which the part begins.
            None if packing == Packing::Aligned && file.compression() == CompressionMethod::Stored => {
                let mut content = Vec::new();
                file.read_to_end(&mut content).map_err(|error| error.to_string())?;
                Cow::Owned(content)
            }
            None => {
                new.raw_copy_file(file).map_err(fault)?;
                continue;
            }
        };
        let options = options(content.len(), packing).compression_method(file.compression());
        let time = file.last_modified().map(|time| options.last_modified_time(time));
        let name = file.name().map_err(fault)?.into_owned();
        drop(file);
        push(&mut new, &name, time.unwrap_or(options), &content)?;
    }
    Ok(new.finish().map_err(fault)?.into_inner())
}

/// A new archive of these parts.
///
/// # Errors
/// A part that it can't hold, in words.
pub(crate) fn archive_of(parts: &[(&str, &[u8])], packing: Packing) -> Result<Vec<u8>, String> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in parts {
        push(&mut zip, name, options(content.len(), packing), content)?;
    }
    Ok(zip.finish().map_err(|error| said(&error))?.into_inner())
}

/// No present time, so that the same shape has the same bytes.
fn options(length: usize, packing: Packing) -> SimpleFileOptions {
    let options = match packing {
        Packing::Deflated => SimpleFileOptions::default().compression_method(CompressionMethod::Deflated),
        Packing::Aligned => SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .with_alignment(64),
    };
    options.large_file(u32::try_from(length).is_err())
}

fn push(
    zip: &mut ZipWriter<Cursor<Vec<u8>>>,
    name: &str,
    options: SimpleFileOptions,
    content: &[u8],
) -> Result<(), String> {
    zip.start_file(name, options).map_err(|error| said(&error))?;
    zip.write_all(content).map_err(|error| error.to_string())
}

fn said(error: &ZipError) -> String {
    format!("its archive can't be read ({})", quoted(&error.to_string()))
}
