//! A glTF as read: its JSON, its buffers, and where its objects stand in the text.
//!
//! The `gltf` crate's types read accessors, buffer views, materials, textures, samplers and images, each section for
//! itself and without validation. Nodes, meshes and scenes are read from the text: node transforms as f64 (the crate
//! has f32, which moves scans at geographic coordinates by half a metre), attributes with whatever names, and scenes
//! without nodes, which the crate refuses.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use ::gltf::json::validation::USize64;
use ::gltf::json::{self, Accessor, Material, Texture, texture::Sampler};

use super::container::{self, Container};
use super::fault::Fault;
use super::json::{At, Json};
use super::uri::{self, Address};
use crate::Format;
use crate::source::Source;

/// A glTF as read.
#[derive(Debug)]
pub(super) struct Document {
    /// The whole file.
    pub file: Arc<Vec<u8>>,
    /// Where a GLB's parts stand in it; `None` for a `.gltf`.
    pub container: Option<Container>,
    /// A byte-order mark in front of a `.gltf`'s text.
    pub has_mark: bool,
    pub json: Json,
    pub buffers: Vec<Buffer>,
    pub images: Vec<ImageFile>,
    pub accessors: Vec<Accessor>,
    pub views: Vec<json::buffer::View>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub samplers: Vec<Sampler>,
    /// Where each object stands, by section.
    pub accessors_at: Vec<At>,
    pub views_at: Vec<At>,
    pub meshes_at: Vec<At>,
    pub nodes_at: Vec<At>,
    pub buffers_at: Vec<At>,
    pub images_at: Vec<At>,
    pub materials_at: Vec<At>,
    /// What was missing but not needed, as sentences.
    pub notes: Vec<String>,
    /// Compressed buffer views without bytes, and what is wrong with them.
    pub undecoded_views: BTreeMap<usize, String>,
    /// Compressed primitives whose accessors have no bytes, and what is wrong with them.
    pub undecoded_primitives: Vec<(At, String)>,
}

/// A buffer's bytes and where they came from.
#[derive(Debug)]
pub(super) enum Buffer {
    /// The GLB's BIN chunk: a range of the file.
    Bin(Range<usize>),
    /// A data URI.
    Data(Vec<u8>),
    /// A file beside this one, by its decoded path.
    Neighbour { path: String, bytes: Vec<u8> },
    /// None at all: a placeholder that an extension fills.
    Absent,
    /// What a compressed buffer view or accessor holds: no buffer of the file. These stand behind the file's own.
    Decoded(Vec<u8>),
}

/// An image's bytes and where they came from.
#[derive(Debug)]
pub(super) enum ImageFile {
    /// A buffer view.
    View(usize),
    /// A data URI.
    Data(Vec<u8>),
    /// A file beside this one, by its decoded path; no bytes where it is missing.
    Neighbour { path: String, bytes: Option<Vec<u8>> },
    /// Nowhere that is read.
    Absent,
}

/// How many bytes of geometry a byte of the file may become.
pub(super) const MOST_GROWTH: usize = 64;

/// What compressed geometry may become in the smallest of files.
const DECODED_ANYWAY: usize = 1 << 20;

impl Document {
    /// Splits the container, parses the JSON and fetches the neighbours.
    pub fn read(source: &Source<'_>, format: Format) -> Result<Self, Fault> {
        let file = Arc::clone(source.bytes);
        let container = match format {
            Format::Glb => Some(container::split(&file)?),
            _ if container::is_glb(&file) => Some(container::split(&file)?),
            _ => None,
        };
        let text = container.as_ref().map_or(&file[..], |parts| &file[parts.json.clone()]);
        let has_mark = text.starts_with(b"\xef\xbb\xbf");
        let json = Json::parse(text[if has_mark { 3 } else { 0 }..].to_vec())?;
        source.cancel.check()?;
        if json
            .path(json.root(), &["asset", "version"])
            .and_then(|at| json.string(at))
            .is_none()
        {
            return Err("its JSON has no asset.version, so it is not glTF".to_owned().into());
        }
        let section = |key: &str| objects(&json, key);
        let (accessors_at, views_at, meshes_at) = (section("accessors")?, section("bufferViews")?, section("meshes")?);
        let (nodes_at, buffers_at, images_at) = (section("nodes")?, section("buffers")?, section("images")?);
        let materials_at = section("materials")?;
        let accessors = typed(&json, &accessors_at, "accessor")?;
        let views = typed(&json, &views_at, "buffer view")?;
        let materials = typed(&json, &materials_at, "material")?;
        let textures = typed(&json, &section("textures")?, "texture")?;
        let samplers = typed(&json, &section("samplers")?, "sampler")?;
        let mut document = Self {
            file,
            container,
            has_mark,
            buffers: Vec::new(),
            images: Vec::new(),
            accessors,
            views,
            materials,
            textures,
            samplers,
            accessors_at,
            views_at,
            meshes_at,
            nodes_at,
            buffers_at,
            images_at,
            materials_at,
            notes: Vec::new(),
            undecoded_views: BTreeMap::new(),
            undecoded_primitives: Vec::new(),
            json,
        };
        document.fetch_buffers(source)?;
        document.fetch_images(source)?;
        Ok(document)
    }

    /// The bytes of a buffer.
    pub fn buffer(&self, buffer: usize) -> &[u8] {
        match self.buffers.get(buffer) {
            Some(Buffer::Bin(range)) => &self.file[range.clone()],
            Some(Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } | Buffer::Decoded(bytes)) => bytes,
            Some(Buffer::Absent) | None => &[],
        }
    }

    /// The bytes of a buffer view; `None` where they are not all there.
    pub fn view(&self, view: usize) -> Option<&[u8]> {
        let view = self.views.get(view)?;
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let length = usize::try_from(view.byte_length.0).ok()?;
        self.buffer(view.buffer.value()).get(start..start.checked_add(length)?)
    }

    /// The encoded bytes of an image; `None` where they are missing.
    pub fn image(&self, image: usize) -> Option<&[u8]> {
        match self.images.get(image)? {
            ImageFile::View(view) => self.view(*view),
            ImageFile::Data(bytes) => Some(bytes),
            ImageFile::Neighbour { bytes, .. } => bytes.as_deref(),
            ImageFile::Absent => None,
        }
    }

    /// How many bytes were read in all, neighbours included.
    pub fn loaded_bytes(&self) -> usize {
        let of_buffers = self.buffers.iter().map(|buffer| match buffer {
            Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } => bytes.len(),
            Buffer::Bin(_) | Buffer::Absent | Buffer::Decoded(_) => 0,
        });
        let of_images = self.images.iter().map(|image| match image {
            ImageFile::Data(bytes) | ImageFile::Neighbour { bytes: Some(bytes), .. } => bytes.len(),
            _ => 0,
        });
        self.file.len() + of_buffers.sum::<usize>() + of_images.sum::<usize>()
    }

    /// How many bytes compressed geometry may become in all.
    pub fn decoding_budget(&self) -> usize {
        self.loaded_bytes().saturating_mul(MOST_GROWTH).max(DECODED_ANYWAY)
    }

    /// Lets a buffer view of the file point at bytes that were decoded from it.
    pub fn redirect_view(&mut self, view: usize, bytes: Vec<u8>, stride: Option<usize>) {
        let (buffer, length) = (self.buffers.len() as u32, bytes.len() as u64);
        let Some(view) = self.views.get_mut(view) else { return };
        view.buffer = json::Index::new(buffer);
        view.byte_offset = None;
        view.byte_length = USize64(length);
        view.byte_stride = stride.map(json::buffer::Stride);
        self.buffers.push(Buffer::Decoded(bytes));
    }

    /// Gives an accessor bytes of its own, elements tightly packed, in a buffer view that the file does not have.
    pub fn fill_accessor(&mut self, accessor: usize, bytes: Vec<u8>) {
        let Some(accessor) = self.accessors.get_mut(accessor) else {
            return;
        };
        accessor.buffer_view = Some(json::Index::new(self.views.len() as u32));
        accessor.byte_offset = None;
        self.views.push(json::buffer::View {
            buffer: json::Index::new(self.buffers.len() as u32),
            byte_length: USize64(bytes.len() as u64),
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: Default::default(),
        });
        self.buffers.push(Buffer::Decoded(bytes));
    }

    /// Whether an accessor's bytes came out of a compressed primitive.
    pub fn is_filled(&self, accessor: usize) -> bool {
        let view = self.accessors.get(accessor).and_then(|accessor| accessor.buffer_view);
        view.is_some_and(|view| view.value() >= self.views_at.len())
    }

    /// An object's member that is an index below `count`, by name; `what` names the object in an error.
    pub fn index(
        &self,
        object: At,
        key: &str,
        count: usize,
        what: impl Fn() -> String,
    ) -> Result<Option<usize>, String> {
        let Some(at) = self.json.member(object, key) else {
            return Ok(None);
        };
        self.index_at(at, count, || format!("{} names {key}", what())).map(Some)
    }

    /// A value that is an index below `count`; `what` says who names what in an error.
    pub fn index_at(&self, at: At, count: usize, what: impl Fn() -> String) -> Result<usize, String> {
        let number = self
            .json
            .number(at)
            .filter(|number| number.fract() == 0.0 && *number >= 0.0);
        match number {
            Some(number) if number < count as f64 => Ok(number as usize),
            _ => {
                let raw = String::from_utf8_lossy(self.json.raw(at))
                    .chars()
                    .map(|letter| if letter.is_control() { ' ' } else { letter })
                    .take(24)
                    .collect::<String>();
                Err(format!("{} {raw}, but there are {count}", what()))
            }
        }
    }

    /// A node's, mesh's or image's name; empty where it has none.
    pub fn name(&self, object: At) -> String {
        self.json
            .member(object, "name")
            .and_then(|at| self.json.string(at))
            .unwrap_or_default()
    }

    fn fetch_buffers(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.buffers_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let bin = self.container.as_ref().and_then(|parts| parts.bin.clone());
            let buffer = match (uri, bin) {
                (None, Some(bin)) if number == 0 => Buffer::Bin(bin),
                (None, _) => Buffer::Absent,
                (Some(uri), _) => match uri::address(&uri).map_err(|reason| format!("buffer {number} is {reason}"))? {
                    Address::Data(bytes) => Buffer::Data(bytes),
                    Address::Neighbour(path) => match source.resolver.read(&path) {
                        Ok(bytes) => Buffer::Neighbour { path, bytes },
                        Err(reason) => return Err(Fault::Neighbour { uri, reason }),
                    },
                    Address::Elsewhere => {
                        let reason = "it is an address that is not a file's".to_owned();
                        return Err(Fault::Neighbour { uri, reason });
                    }
                },
            };
            self.buffers.push(buffer);
        }
        Ok(())
    }

    fn fetch_images(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.images_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let view = self.index(at, "bufferView", self.views.len(), || format!("image {number}"))?;
            let image = match (view, uri.as_deref().map(uri::address)) {
                (Some(view), _) => ImageFile::View(view),
                (None, Some(Ok(Address::Data(bytes)))) => ImageFile::Data(bytes),
                (None, Some(Ok(Address::Neighbour(path)))) => {
                    let bytes = match source.resolver.read(&path) {
                        Ok(bytes) => Some(bytes),
                        Err(reason) => {
                            self.notes
                                .push(format!("Image {path} is not shown: it could not be read ({reason})."));
                            None
                        }
                    };
                    ImageFile::Neighbour { path, bytes }
                }
                (None, _) => {
                    self.notes.push(format!(
                        "Image {number} is not shown: it has neither bytes nor a file's name."
                    ));
                    ImageFile::Absent
                }
            };
            self.images.push(image);
        }
        Ok(())
    }
}

/// Where a section's objects stand; in words what is wrong where it is no list of objects.
fn objects(json: &Json, section: &str) -> Result<Vec<At>, String> {
    let Some(list) = json.member(json.root(), section) else {
        return Ok(Vec::new());
    };
    let objects: Vec<At> = json.elements(list).collect();
    let is_sound = json.raw(list).starts_with(b"[") && objects.iter().all(|&at| json.raw(at).starts_with(b"{"));
    if is_sound {
        Ok(objects)
    } else {
        Err(format!("its {section} are not a list of objects"))
    }
}

/// A section's objects as types of the `gltf` crate.
fn typed<T: serde::de::DeserializeOwned>(json: &Json, section: &[At], what: &str) -> Result<Vec<T>, String> {
    let one = |(number, &at): (usize, &At)| {
        json.typed(at)
            .map_err(|error| format!("{what} {number} is broken: {error}"))
    };
    section.iter().enumerate().map(one).collect()
}
