//! The materials that an OBJ file's `mtllib` libraries give to its `usemtl` names, read by `tobj`.
//!
//! No error here prevents a file from being opened: a material that is missing or can't be read becomes a note and is
//! drawn plain.

mod library;
mod names;
mod neighbours;

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use crate::Bytes;
use crate::appearance::{Image, Material, Origin};
use crate::gltf::stays_inside;
use crate::quote::quoted;
use crate::source::Source;
use crate::source::notes::Notes;
use crate::text::excerpt;
use library::{image_names, parse, set_base_colour};
use names::texture_file;
pub(super) use names::{as_uri, behind_options, folder_of, join};
pub(super) use neighbours::{names_of, neighbours, unread_lost};

/// One material for each name, in order, and the images they use.
#[derive(Debug, Default)]
pub(super) struct Materials {
    pub(super) materials: Vec<Material>,
    pub(super) images: Vec<Image>,
    pub(super) notes: Notes,
    /// The libraries as read, by their paths.
    pub(super) libraries: Vec<(String, Bytes)>,
    /// The path at which each image was read.
    pub(super) image_paths: Vec<String>,
    /// The libraries' statements with an effect that aren't read: maps other than the base colour's, shine.
    pub(super) unread: BTreeSet<String>,
}

/// Looks up `names` in the libraries (the rests of the `mtllib` lines; each may name several files).
pub(super) fn look_up(source: &Source<'_>, libraries: &[&[u8]], names: &[String]) -> Materials {
    let mut out = Materials::default();
    let mut known: HashMap<String, (tobj::Material, String)> = HashMap::new();
    let mut asked: Vec<&[u8]> = Vec::new();
    for &library in libraries {
        // The same library is often named before every object.
        if asked.contains(&library) || asked.len() >= MOST_LIBRARIES {
            continue;
        }
        asked.push(library);
        match read_library(source, library) {
            Ok(files) => {
                for (path, text) in files {
                    if out.libraries.iter().any(|(_, other)| other.place() == text.place()) {
                        continue;
                    }
                    out.notes.add(
                        "libraries of other folders",
                        outside_note("The material library", &path),
                    );
                    let folder = folder_of(&path).to_owned();
                    for name in image_names(&text) {
                        note_image(source, &join(&folder, &texture_file(&name).0));
                    }
                    for material in parse(&text, &mut out.unread) {
                        let folder = folder.clone();
                        known.entry(material.name.clone()).or_insert((material, folder));
                    }
                    out.libraries.push((path, text));
                }
            }
            Err(reason) => {
                let library = excerpt(library);
                let note = format!(
                    "The material library {library} could not be read ({reason}), so its materials are drawn plain."
                );
                out.notes.add("material libraries", Some(note));
            }
        }
    }
    let mut image_of: HashMap<String, Option<usize>> = HashMap::new();
    let mut image_at: HashMap<(usize, Range<usize>), usize> = HashMap::new();
    let mut without: Vec<&str> = Vec::new();
    for name in names {
        let mut material = Material::plain(name);
        let in_another_case = || {
            known
                .iter()
                .filter(|(own, _)| own.eq_ignore_ascii_case(name))
                .min_by_key(|(own, _)| *own)
        };
        let found = known.get_key_value(name).or_else(in_another_case);
        if let Some((own, _)) = found.filter(|(own, _)| *own != name) {
            let (own, name) = (excerpt(own.as_bytes()), excerpt(name.as_bytes()));
            let note = format!("The library has no material '{name}', so its material '{own}' is used.");
            out.notes.add("materials", Some(note));
        }
        if found.is_none() && !known.is_empty() {
            without.push(name);
        }
        if let Some((_, (stored, folder))) = found {
            set_base_colour(&mut material, stored);
            if let Some(texture) = &stored.diffuse_texture {
                let (file, wrap) = texture_file(texture);
                material.wrap = [wrap; 2];
                let uri = join(folder, &file);
                let image = *image_of
                    .entry(uri.clone())
                    .or_insert_with(|| read_image(source, &uri, &mut image_at, &mut out));
                material.base_colour_image = image;
            }
        }
        out.materials.push(material);
    }
    for name in without {
        let name = excerpt(name.as_bytes());
        let note = format!("No material library has the material '{name}', so it is drawn plain.");
        out.notes.add("materials", Some(note));
    }
    if names.is_empty() && !known.is_empty() {
        let note = "Its material library is not shown, because no 'usemtl' gives its materials to faces.";
        out.notes.add("material libraries", Some(note.to_owned()));
    }
    out
}

/// The most libraries that are read: more than any real file has.
const MOST_LIBRARIES: usize = 256;

/// The bytes of libraries, with their paths, for the rest of a `mtllib` line: all of it as one name, or else as
/// several, each ending at `.mtl` or at a blank.
fn read_library(source: &Source<'_>, library: &[u8]) -> Result<Vec<(String, Bytes)>, String> {
    let whole = as_uri(&String::from_utf8_lossy(library));
    let read = |uri: &str| source.resolver.read(uri).map(|text| (uri.to_owned(), text));
    let mut found = read(&whole).map(|file| vec![file]);
    for names in [
        names_by_extension(&whole),
        whole.split_whitespace().map(str::to_owned).collect(),
    ] {
        if found.is_err() && names.len() > 1 {
            let all: Result<Vec<_>, _> = names.iter().take(MOST_LIBRARIES).map(|name| read(name)).collect();
            found = all.or(found);
        }
    }
    found
}

/// The names in a line, each up to its `.mtl`.
fn names_by_extension(line: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut name = String::new();
    for word in line.split_whitespace() {
        if !name.is_empty() {
            name.push(' ');
        }
        name.push_str(word);
        if word.to_ascii_lowercase().ends_with(".mtl") {
            names.push(std::mem::take(&mut name));
        }
    }
    names.extend((!name.is_empty()).then_some(name));
    names
}

/// Reads an image at its path, or by its bare name beside the file (for paths of another computer).
///
/// `known` maps each place in memory to its image, so that one file is one image for every spelling of its path.
fn read_image(
    source: &Source<'_>,
    uri: &str,
    known: &mut HashMap<(usize, Range<usize>), usize>,
    out: &mut Materials,
) -> Option<usize> {
    let bare = uri.rsplit('/').next().unwrap_or(uri);
    let read = |path: &str| source.resolver.read(path).map(|encoded| (path.to_owned(), encoded));
    let found = match read(uri) {
        Err(reason) if bare != uri => read(bare).map_err(|_| reason),
        found => found,
    };
    match found {
        Ok((path, encoded)) => {
            let next = out.images.len();
            let number = *known.entry(encoded.place()).or_insert(next);
            if number < next {
                return Some(number);
            }
            out.notes
                .add("textures of other folders", outside_note("The texture", &path));
            out.images.push(Image {
                name: bare.to_owned(),
                encoded,
                origin: if stays_inside(&path) {
                    Origin::Inside
                } else {
                    Origin::Outside
                },
            });
            out.image_paths.push(path);
            Some(out.images.len() - 1)
        }
        Err(reason) => {
            let uri = excerpt(uri.as_bytes());
            let note = format!("The texture {uri} could not be read ({reason}), so its material is drawn plain.");
            out.notes.add("textures", Some(note));
            None
        }
    }
}

/// Tells the resolver of an image at its path, or at its bare name as in [`read_image`].
fn note_image(source: &Source<'_>, uri: &str) {
    let bare = uri.rsplit('/').next().unwrap_or(uri);
    let _ = source.resolver.note_unread(uri) || source.resolver.note_unread(bare);
}

/// A sentence about a neighbour outside the file's folder.
fn outside_note(what: &str, path: &str) -> Option<String> {
    (!stays_inside(path)).then(|| format!("{what} {} was read from outside the file's own folder.", quoted(path)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::appearance::Wrap;

    #[test]
    fn a_library_with_broken_lines_gives_what_it_can() {
        let text = b"Kd 1 1 1\nnewmtl\nnewmtl a b\r\nKd 1\nKd 0.5 0.25 1\nd x\nmap_Kd\nillum q\nmap_Kd -s 1 1 1 -clamp on my tex.png\nnewmtl c\nTr 0.25\n\xff\xfe";
        let mut unread = BTreeSet::new();
        let materials = parse(text, &mut unread);
        assert!(unread.is_empty(), "{unread:?}");
        assert_eq!(
            materials
                .iter()
                .map(|material| material.name.as_str())
                .collect::<Vec<_>>(),
            ["a b", "c"]
        );
        assert_eq!(materials[0].diffuse, Some([0.5, 0.25, 1.0]));
        let texture = materials[0].diffuse_texture.as_deref().unwrap_or_default();
        assert_eq!(texture_file(texture), ("my tex.png".to_owned(), Wrap::ClampToEdge));
        let mut material = Material::plain("c");
        set_base_colour(&mut material, &materials[1]);
        assert_eq!(material.base_colour[3], 0.75);
    }

    #[test]
    fn what_shines_and_other_maps_are_named_when_another_kind_goes_without() {
        let unread_of = |text: &[u8]| {
            let mut materials = Materials::default();
            parse(text, &mut materials.unread);
            unread_lost(&materials, "GLB")
        };
        let plain = b"newmtl a\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0.0\nKe 0 0 0\nNs 10\nillum 2\nmap_Kd a.png\n";
        assert_eq!(unread_of(plain), None);
        let rich = b"newmtl a\nKs 0 0.5 0\nmap_Bump b.png\nnorm n.png\nKe x\nPm 1\nmap_Bump c.png\n";
        assert_eq!(
            unread_of(rich).as_deref(),
            Some(
                "GLB output leaves out the material library's statements Ks, Pm, map_Bump, norm: keep the .obj for them."
            )
        );
    }
}
