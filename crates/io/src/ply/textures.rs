//! The textures that a PLY file names: `comment TextureFile NAME`, one for each number that a face's `texnumber` may
//! have.

use std::ops::Range;

use crate::appearance::{Group, Image, Material, Origin};
use crate::gltf::stays_inside;
use crate::quote::quoted;
use crate::save::{OutputFile, Role};
use crate::source::Source;
use crate::source::notes::Notes;
use crate::text::Splice;

/// The textures as read.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub(super) images: Vec<Image>,
    /// The path of each image.
    paths: Vec<String>,
    /// The image of each name in the header; `None` if it could not be read.
    of_name: Vec<Option<usize>>,
}

impl Textures {
    /// Reads the textures that the header names; those that can't be read are noted.
    pub(super) fn read(source: &Source<'_>, names: &[Range<usize>], notes: &mut Notes) -> Self {
        let mut out = Self::default();
        for name in names {
            let path = String::from_utf8_lossy(&source.bytes[name.clone()])
                .trim_matches('"')
                .replace('\\', "/");
            let found = out.paths.iter().position(|known| *known == path);
            let image = found.or_else(|| out.read_one(source, &path, notes));
            out.of_name.push(image);
        }
        out
    }

    /// Reads an image at its path, or by its bare name beside the file (for paths of another computer).
    fn read_one(&mut self, source: &Source<'_>, path: &str, notes: &mut Notes) -> Option<usize> {
        let bare = path.rsplit('/').next().unwrap_or(path);
        let read = |path: &str| source.resolver.read(path).map(|encoded| (path.to_owned(), encoded));
        let found = match read(path) {
            Err(reason) if bare != path => read(bare).map_err(|_| reason),
            found => found,
        };
        match found {
            Ok((path, encoded)) => {
                let is_inside = stays_inside(&path);
                let outside = format!(
                    "The texture {} was read from outside the file's own folder.",
                    quoted(&path)
                );
                notes.add("textures of other folders", (!is_inside).then_some(outside));
                let origin = if is_inside { Origin::Inside } else { Origin::Outside };
                self.images.push(Image {
                    name: bare.to_owned(),
                    encoded,
                    origin,
                });
                self.paths.push(path);
                Some(self.images.len() - 1)
            }
            Err(reason) => {
                let path = quoted(path);
                let note = format!("The texture {path} could not be read ({reason}), so it is not shown.");
                notes.add("textures", Some(note));
                None
            }
        }
    }

    /// A material for each name, and the runs of triangles that share one: `numbers` has the texture of each face, and
    /// `triangles` the number of its triangles.
    pub(super) fn dress(
        &self,
        numbers: &[u32],
        triangles: impl Iterator<Item = u32>,
        triangle_count: u32,
    ) -> (Vec<Material>, Vec<Group>) {
        let material = |image: &Option<usize>| Material {
            base_colour_image: *image,
            ..Material::plain("")
        };
        let mut materials: Vec<Material> = self.of_name.iter().map(material).collect();
        if materials.is_empty() {
            materials.push(Material::plain(""));
        }
        let group = |triangles, material| Group {
            triangles,
            material,
            node_name: String::new(),
        };
        if numbers.is_empty() {
            return (materials, vec![group(0..triangle_count, 0)]);
        }
        let mut groups: Vec<Group> = Vec::new();
        let mut start = 0;
        let numbers = numbers.iter().copied().chain(std::iter::repeat(0));
        for (number, count) in numbers.zip(triangles) {
            // A number without a name in the header means the first texture.
            let material = Some(number as usize)
                .filter(|&number| number < materials.len())
                .unwrap_or(0);
            match groups.last_mut() {
                Some(last) if last.material == material => last.triangles.end += count,
                _ => groups.push(group(start..start + count, material)),
            }
            start += count;
        }
        if groups.is_empty() {
            groups.push(group(0..triangle_count, 0));
        }
        (materials, groups)
    }

    /// The textures that a copy in another folder needs beside it, and warnings about those that are not copied.
    pub(super) fn neighbours(&self) -> (Vec<OutputFile>, Vec<String>) {
        let (mut files, mut warnings) = (Vec::new(), Vec::new());
        for (image, path) in self.images.iter().zip(&self.paths) {
            if stays_inside(path) {
                files.push(OutputFile {
                    name: path.clone(),
                    role: Role::Image,
                    bytes: image.encoded.to_vec(),
                });
            } else {
                let path = quoted(path);
                warnings.push(format!(
                    "{path} is outside the file's own folder and was not copied: copy it yourself."
                ));
            }
        }
        (files, warnings)
    }
}

/// A PLY file with another name for a texture; `None` if it names no such texture.
pub(crate) fn renamed(bytes: &[u8], old: &str, new: &str) -> Option<Vec<u8>> {
    let mut splice = Splice::new(bytes);
    let (mut at, mut is_named) = (0, false);
    for line in bytes.split_inclusive(|&byte| byte == b'\n' || byte == b'\r') {
        let text = line.trim_ascii();
        if text == b"end_header" {
            break;
        }
        let behind = text.strip_prefix(b"comment").map(<[u8]>::trim_ascii_start);
        if let Some(name) = behind.and_then(|behind| behind.strip_prefix(b"TextureFile")) {
            let name = name.trim_ascii();
            if String::from_utf8_lossy(name).replace('\\', "/") == old {
                // It ends the line.
                let end = at + line.trim_ascii_end().len();
                splice.replace(end - name.len()..end, |out| out.extend_from_slice(new.as_bytes()));
                is_named = true;
            }
        }
        at += line.len();
    }
    is_named.then(|| splice.finish())
}
