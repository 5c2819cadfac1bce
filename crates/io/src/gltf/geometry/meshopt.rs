//! Buffer views under `EXT_meshopt_compression` or `KHR_meshopt_compression`, decoded into buffers of their own.
//!
//! The views then point there, so that accessors are read as from any other buffer. The file's own bytes do not change:
//! an edited accessor is saved as a new one, and the others stay compressed.

use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    BufferView, Filter, Mode, decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat,
    decode_index_buffer, decode_index_sequence, decode_vertex_buffer,
};
use pliant_mesh::{Cancel, Cancelled};
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::document::json::At;
use crate::quote::quoted;

const EXTENSIONS: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// A view's compressed bytes and their decoding.
struct Compressed<'a> {
    source: &'a [u8],
    mode: Mode,
    /// `None`: colours, which only `KHR_meshopt_compression` has.
    filter: Option<Filter>,
    count: usize,
    stride: usize,
    /// The decoded data.
    length: usize,
}

/// The place of a buffer view's compression.
pub(crate) fn extension_of(document: &Document, view: At) -> Option<At> {
    let json = &document.json;
    EXTENSIONS
        .iter()
        .find_map(|name| json.path(view, &["extensions", name]))
}

/// Decodes every compressed view. One that can't be decoded keeps its place in its fallback buffer; if that has no
/// bytes either, it is noted as undecoded with its fault.
pub(crate) fn decode(document: &mut Document, cancel: &Cancel) -> Result<(), Cancelled> {
    let views: Vec<(usize, At)> = document
        .views_at
        .iter()
        .enumerate()
        .filter_map(|(view, &at)| Some((view, extension_of(document, at)?)))
        .collect();
    if views.is_empty() {
        return Ok(());
    }
    let mut left = document.decoding_budget();
    let compressed: Vec<Result<Compressed<'_>, String>> = views
        .iter()
        .map(|&(_, extension)| {
            let compressed = Compressed::read(document, extension)?;
            let length = compressed.length;
            left = left
                .checked_sub(length)
                .ok_or_else(|| format!("would become {length} bytes, more than a file of its size can hold"))?;
            Ok(compressed)
        })
        .collect();
    let decoded: Vec<_> = compressed
        .into_par_iter()
        .map(|compressed| {
            let compressed = compressed?;
            if cancel.is_cancelled() {
                return Err("is no longer needed".to_owned());
            }
            let stride = (compressed.mode == Mode::Attributes).then_some(compressed.stride);
            Ok::<_, String>((compressed.decoded()?, stride))
        })
        .collect();
    cancel.check()?;
    for (&(view, _), decoded) in views.iter().zip(decoded) {
        match decoded {
            Ok((bytes, stride)) => document.redirect_view(view, bytes, stride),
            Err(_) if document.view(view).is_some() => {}
            Err(reason) => {
                document.undecoded_views.insert(view, reason);
            }
        }
    }
    Ok(())
}

impl<'a> Compressed<'a> {
    fn read(document: &'a Document, extension: At) -> Result<Self, String> {
        let json = &document.json;
        let whole = |key: &str| -> Option<usize> {
            let number = json.number(json.member(extension, key)?)?;
            (number.fract() == 0.0 && (0.0..9e15).contains(&number)).then_some(number as usize)
        };
        let word = |key: &str| json.member(extension, key).and_then(|at| json.string(at));
        let needed = |key: &str| whole(key).ok_or_else(|| format!("has no {key}"));
        let (buffer, offset, length) = (
            needed("buffer")?,
            whole("byteOffset").unwrap_or(0),
            needed("byteLength")?,
        );
        let (count, stride) = (needed("count")?, needed("byteStride")?);
        let source = offset
            .checked_add(length)
            .and_then(|end| document.buffer(buffer).get(offset..end))
            .ok_or_else(|| format!("is beyond the bytes of buffer {buffer}"))?;
        let mode = word("mode").unwrap_or_default();
        let filter = word("filter").unwrap_or_else(|| "NONE".to_owned());
        let unknown = |what: &str, name: &str| format!("has the unknown {what} '{}'", quoted(name));
        let mode = Mode::parse(&mode).map_err(|_| unknown("mode", &mode))?;
        let filter = match &*filter {
            "COLOR" => None,
            name => Some(Filter::parse(name).map_err(|_| unknown("filter", name))?),
        };
        let layout = BufferView::new(mode, filter.unwrap_or(Filter::None), count, stride);
        Ok(Self {
            source,
            mode,
            filter,
            count,
            stride,
            length: layout.map_err(broken)?.byte_length(),
        })
    }

    /// Either version of the codec, under either extension.
    fn decoded(&self) -> Result<Vec<u8>, String> {
        let Self {
            source, count, stride, ..
        } = *self;
        let mut workspace = Workspace::default();
        let decoded = match self.mode {
            Mode::Attributes => decode_vertex_buffer(count, stride, source, &mut workspace),
            Mode::Triangles => decode_index_buffer(count, stride, source, &mut workspace),
            Mode::Indices => decode_index_sequence(count, stride, source, &mut workspace),
        };
        let mut bytes = decoded.map_err(broken)?;
        let filtered = match self.filter {
            Some(Filter::None) => Ok(()),
            Some(Filter::Octahedral) => decode_filter_oct(&mut bytes, count, stride, &mut workspace),
            Some(Filter::Quaternion) => decode_filter_quat(&mut bytes, count, stride, &mut workspace),
            Some(Filter::Exponential) => decode_filter_exp(&mut bytes, count, stride, &mut workspace),
            None => decode_filter_color(&mut bytes, count, stride, &mut workspace),
        };
        filtered.map_err(broken)?;
        Ok(bytes)
    }
}

fn broken(error: meshoptimizer_rs::Error) -> String {
    format!("is broken ({error})")
}
