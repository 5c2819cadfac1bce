//! Broken files by the million: mutations that follow the structure of each format's files, and the tests for every
//! file. The test `fuzz.rs` does a short run, the example `fuzz` long ones.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    reason = "a fault is told by panicking"
)]

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::Path;

use glam::DVec3;
use pliant_io::{Bytes, Format, MorphTarget, Placement, Resolver, Save, decode_images, read};
use pliant_mesh::{Cancel, Progress};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

/// The memory limit of a broken image.
const IMAGE_BUDGET: u64 = 64 << 20;

/// A small generator of even quality (SplitMix64).
pub struct Chance(pub u64);

impl Chance {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    pub fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// The kind as which a sound file is read.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Kind {
    Mesh(usize),
    Image,
}

/// A sound file to begin from.
pub struct Sound {
    pub name: String,
    pub kind: Kind,
    pub bytes: Vec<u8>,
}

/// The sound files of a folder, by name.
pub fn corpus(folder: &Path) -> Vec<Sound> {
    let mut files = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("the corpus is there") {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let kind = match Format::of_name(&name) {
            Ok(format) => Kind::Mesh(Format::ALL.iter().position(|other| *other == format).unwrap()),
            Err(_) if [".png", ".jpg", ".webp", ".ktx2"].iter().any(|end| name.ends_with(end)) => Kind::Image,
            Err(_) => continue,
        };
        let bytes = std::fs::read(&path).unwrap();
        files.insert(name.clone(), Sound { name, kind, bytes });
    }
    files.into_values().collect()
}

/// A file's neighbours, in memory: each has these bytes, under any name.
pub struct Beside(pub Bytes);

const LIBRARY: &str = "# looks\nnewmtl red\nKd 0.5 0.25 1e-1\nd 0.75\nTr 0.25\nmap_Kd -s 2 2 1 -o 0.5 0 0 -clamp on skin.png\n\
newmtl b\nPr 0.5\nPm 1\nNs 96.0\nillum 2\nmap_Kd -bm 1.0 art\\\\my skin.png\n";

impl Beside {
    /// Neighbours of a run: a broken library of materials, or a buffer of random bytes.
    pub fn of(sound: &[Sound], chance: &mut Chance) -> Self {
        if chance.below(2) == 0 {
            return Self(vec![7; 600].into());
        }
        let library = Sound {
            name: "library.mtl".to_owned(),
            kind: Kind::Image,
            bytes: LIBRARY.into(),
        };
        Self(broken(&library, sound, chance).into())
    }
}

impl Resolver for Beside {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        match uri.len() % 3 {
            0 => Err("no such file".to_owned()),
            _ => Ok(self.0.clone()),
        }
    }
}

const STRANGE: [&str; 20] = [
    "0",
    "-1",
    "-0",
    "1",
    "2",
    "3",
    "255",
    "65535",
    "65536",
    "4294967295",
    "-9223372036854775808",
    "18446744073709551616",
    "1e308",
    "1e-310",
    "nan",
    "-inf",
    "x",
    "",
    "1/2/3//",
    "0.5",
];
const STRANGE_JSON: [&str; 27] = [
    "null",
    "-1",
    "0",
    "1",
    "2",
    "3",
    "17",
    "4294967295",
    "18446744073709551615",
    "1e300",
    "0.5",
    "\"x\"",
    "[]",
    "{}",
    "true",
    "[0,0,0]",
    "\"./a.bin\"",
    "\"b/../%61.bin\"",
    "\"../a.bin\"",
    "\"/a.bin\"",
    "\"\\\\\\\\server\\\\a.bin\"",
    "[0,1]",
    "5121",
    "5123",
    "5126",
    "\"VEC3\"",
    "\"SCALAR\"",
];
const STRANGE_WORDS: [u32; 10] = [
    0,
    1,
    0xff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x7f80_0000,
    0x7fc0_0000,
    36,
];

/// A sound file, broken; sometimes only noise.
pub fn broken(sound: &Sound, others: &[Sound], chance: &mut Chance) -> Vec<u8> {
    if chance.below(50) == 0 {
        let length = chance.below(300);
        let mut noise: Vec<u8> = (0..length).map(|_| chance.next() as u8).collect();
        // Half of the noise begins like a file of the kind.
        let magic = sound.bytes.len().min(chance.below(24));
        if chance.below(2) == 0 && noise.len() > magic {
            noise[..magic].copy_from_slice(&sound.bytes[..magic]);
        }
        return noise;
    }
    // Half of the runs break a part of an archive before its checksum is made, so that readers see what is broken.
    if sound.bytes.starts_with(b"PK") && chance.below(2) == 0 {
        return with_broken_part(sound, others, chance);
    }
    let mut bytes = sound.bytes.clone();
    let is_glb = bytes.starts_with(b"glTF");
    for _ in 0..=chance.below(3) * chance.below(2) {
        if bytes.is_empty() {
            break;
        }
        match chance.below(8) {
            _ if sound.kind == Kind::Image && chance.below(3) == 0 => of_image_size(&mut bytes, chance),
            0 => of_bytes(&mut bytes, chance),
            1 | 2 if is_glb => of_bin(&mut bytes, chance),
            1 | 2 => of_words(&mut bytes, chance),
            3..=6 if is_glb => of_glb(&mut bytes, chance),
            3..=6 if bytes.starts_with(b"{") => of_json(&mut bytes, 0, chance),
            3..=6 => of_text(&mut bytes, chance),
            _ => {
                // A piece of another file.
                let other = chance.of(others);
                let start = chance.below(other.bytes.len());
                let end = other.bytes.len().min(start + chance.below(64));
                let at = chance.below(bytes.len());
                let over = bytes.len().min(at + chance.below(2) * (end - start));
                bytes.splice(at..over, other.bytes[start..end].iter().copied());
            }
        }
    }
    bytes
}

/// An archive in which one part is broken.
fn with_broken_part(sound: &Sound, others: &[Sound], chance: &mut Chance) -> Vec<u8> {
    let mut old = ZipArchive::new(Cursor::new(&sound.bytes)).unwrap();
    let mut new = ZipWriter::new(Cursor::new(Vec::new()));
    let names = old.len();
    // The part with the geometry is the largest.
    let sizes = (0..names).map(|place| old.by_index(place).unwrap().size());
    let largest = sizes
        .enumerate()
        .max_by_key(|(_, size)| *size)
        .map_or(0, |(place, _)| place);
    let wanted = if chance.below(4) == 0 {
        chance.below(names)
    } else {
        largest
    };
    for place in 0..names {
        let mut file = old.by_index(place).unwrap();
        let options = SimpleFileOptions::default().compression_method(file.compression());
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        if place == wanted && !bytes.is_empty() {
            let part = Sound {
                name: String::new(),
                kind: sound.kind,
                bytes,
            };
            bytes = broken(&part, others, chance);
        }
        new.start_file(file.name().unwrap(), options).unwrap();
        new.write_all(&bytes).unwrap();
    }
    new.finish().unwrap().into_inner()
}

fn of_bytes(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let at = chance.below(bytes.len());
    let end = bytes.len().min(at + chance.below(40));
    match chance.below(6) {
        0 => bytes[at] ^= 1 << chance.below(8),
        1 => bytes[at] = chance.next() as u8,
        2 => bytes.truncate(at),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
        }
        _ => drop(bytes.splice(at..at, [0xff; 3])),
    }
}

/// A number of 32 bits becomes an extreme one, in either byte order.
fn of_words(bytes: &mut [u8], chance: &mut Chance) {
    if bytes.len() < 4 {
        return;
    }
    let at = chance.below(bytes.len() - 3) & !(chance.below(2) * 3);
    let word = *chance.of(&STRANGE_WORDS);
    let word = if chance.below(2) == 0 {
        word.to_le_bytes()
    } else {
        word.to_be_bytes()
    };
    bytes[at..at + 4].copy_from_slice(&word);
}

/// A number in the BIN chunk becomes an extreme one, or a few of its bytes noise.
fn of_bin(bytes: &mut [u8], chance: &mut Chance) {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let start = word(12).map_or(0, |length| (28 + length).min(bytes.len()));
    let bin = &mut bytes[start..];
    match chance.below(3) {
        0 if !bin.is_empty() => {
            let at = chance.below(bin.len());
            let end = bin.len().min(at + 1 + chance.below(6));
            bin[at..end].iter_mut().for_each(|byte| *byte = chance.next() as u8);
        }
        _ => of_words(bin, chance),
    }
}

/// The size in an image's header changes, often to a huge one, and the header's checksum follows.
fn of_image_size(bytes: &mut [u8], chance: &mut Chance) {
    let mut side = |most: u32| match chance.below(3) {
        0 => most,
        1 => 1 << chance.below(15),
        _ => chance.next() as u32 % (most + 1),
    };
    let find = |bytes: &[u8], needle: &[u8]| bytes.windows(needle.len()).position(|window| window == needle);
    if bytes.starts_with(b"\x89PNG") && bytes.len() > 33 {
        let (width, height) = (side(16384), side(16384));
        bytes[16..20].copy_from_slice(&width.to_be_bytes());
        bytes[20..24].copy_from_slice(&height.to_be_bytes());
        let sum = crc(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&sum.to_be_bytes());
    } else if bytes.starts_with(b"\xabKTX 20") && bytes.len() > 28 {
        bytes[20..24].copy_from_slice(&side(16384).to_le_bytes());
        bytes[24..28].copy_from_slice(&side(16384).to_le_bytes());
    } else if let Some(at) = find(bytes, b"VP8 ").filter(|at| at + 18 <= bytes.len()) {
        bytes[at + 14..at + 16].copy_from_slice(&(side(16383) as u16).to_le_bytes());
        bytes[at + 16..at + 18].copy_from_slice(&(side(16383) as u16).to_le_bytes());
    } else if let Some(at) = find(bytes, b"VP8L").filter(|at| at + 13 <= bytes.len()) {
        let size = side(16383) | side(16383) << 14 | 1 << 28;
        bytes[at + 9..at + 13].copy_from_slice(&size.to_le_bytes());
    } else if let Some(at) = find(bytes, &[0xff, 0xc0]).filter(|at| at + 9 <= bytes.len()) {
        bytes[at + 5..at + 7].copy_from_slice(&(side(16384) as u16).to_be_bytes());
        bytes[at + 7..at + 9].copy_from_slice(&(side(16384) as u16).to_be_bytes());
    }
}

/// PNG's checksum of a chunk.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    })
}

/// A line is dropped or repeated, or two change places.
pub fn change_lines(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let mut lines: Vec<Vec<u8>> = bytes
        .split_inclusive(|&byte| byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect();
    let (a, b) = (chance.below(lines.len()), chance.below(lines.len()));
    match chance.below(3) {
        0 => drop(lines.remove(a)),
        1 => lines.swap(a, b),
        _ => lines.insert(b, lines[a].clone()),
    }
    *bytes = lines.concat();
}

fn of_text(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let at = chance.below(bytes.len());
    if chance.below(2) == 0 {
        return change_lines(bytes, chance);
    }
    let is_word = |byte: &u8| !byte.is_ascii_whitespace();
    let start = bytes[..at]
        .iter()
        .rposition(|byte| !is_word(byte))
        .map_or(0, |space| space + 1);
    let end = bytes[at..]
        .iter()
        .position(|byte| !is_word(byte))
        .map_or(bytes.len(), |space| at + space);
    let strange = *chance.of(&STRANGE);
    bytes.splice(start..end.max(start), strange.bytes());
}

/// A value within the JSON chunk changes, and the chunk's lengths follow.
fn of_glb(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let word = |bytes: &[u8], at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let Some(length) = word(bytes, 12) else { return };
    let Some(text) = bytes.get(20..20 + length) else { return };
    let mut text = text.to_vec();
    of_json(&mut text, 0, chance);
    text.resize(text.len().next_multiple_of(4), b' ');
    let new = text.len() as u32;
    bytes.splice(20..20 + length, text);
    bytes[12..16].copy_from_slice(&new.to_le_bytes());
    let total = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&total.to_le_bytes());
}

/// A JSON scalar, or sometimes a whole list or object, becomes another value.
fn of_json(text: &mut Vec<u8>, from: usize, chance: &mut Chance) {
    let starts: Vec<usize> = (from..text.len())
        .filter(|&at| at > 0 && matches!(text[at - 1], b':' | b',' | b'['))
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = *chance.of(&starts);
    let mut depth = 0_i32;
    let mut end = start;
    while let Some(&byte) = text.get(end) {
        match byte {
            b'[' | b'{' => depth += 1,
            b']' | b'}' if depth == 0 => break,
            b']' | b'}' => depth -= 1,
            b',' if depth == 0 => break,
            _ => {}
        }
        end += 1;
    }
    let new = match chance.below(4) {
        // The value at another place.
        0 => {
            let other = *chance.of(&starts);
            let length = text[other..]
                .iter()
                .position(|byte| matches!(byte, b',' | b']' | b'}'))
                .unwrap_or(0);
            text[other..other + length].to_vec()
        }
        _ => chance.of(&STRANGE_JSON).bytes().collect(),
    };
    text.splice(start..end, new);
}

/// The result for a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Outcome {
    Refused,
    Read,
}

/// Reads a file; a file that is read is inspected, and saved unchanged and moved, in its own format and in `other`.
///
/// `after_reading` is called once the file was read or refused.
pub fn exercise(bytes: &[u8], kind: Kind, other: Format, beside: &Beside, after_reading: impl FnOnce()) -> Outcome {
    let format = match kind {
        Kind::Image => {
            let decoded = decode_images(&[bytes, bytes], IMAGE_BUDGET, &Cancel::new()).unwrap();
            after_reading();
            let pixels: usize = decoded.iter().flatten().map(|image| image.pixels.pixels.len()).sum();
            assert!(pixels as u64 <= IMAGE_BUDGET, "{pixels} bytes of pixels");
            return match decoded.into_iter().next().unwrap().map(|image| image.pixels) {
                Ok(image) => {
                    assert_eq!(image.pixels.len(), image.width as usize * image.height as usize * 4);
                    Outcome::Read
                }
                Err(error) => {
                    assert!(!error.to_string().contains('\n'), "{error}");
                    Outcome::Refused
                }
            };
        }
        Kind::Mesh(format) => Format::ALL[format],
    };
    let name = format!("in.{}", format.extension());
    let opened = read(bytes.to_vec(), format, &name, beside, &Progress::new(), &Cancel::new());
    after_reading();
    let opened = match opened {
        Ok(opened) => opened,
        Err(error) => {
            assert!(!error.to_string().contains('\n'), "{error}");
            return Outcome::Refused;
        }
    };
    let (scene, drawn) = (&opened.scene, &opened.drawn);
    let count = drawn.positions.len();
    assert_eq!(count, drawn.file_vertex.len());
    assert!(drawn.triangles.iter().flatten().all(|corner| corner.index() < count));
    assert!(
        drawn
            .file_vertex
            .iter()
            .all(|file| file.index() < drawn.file_vertex_count)
    );
    let looks = scene.appearance();
    assert!(looks.groups.iter().all(|group| group.material < looks.materials.len()));
    assert!(looks.normals.is_none_or(|normals| normals.len() == count));
    scene.summary();
    let save = |positions: &[DVec3], format: Format| {
        let name = format!("out.{}", format.extension());
        let placement = Placement::OtherFolder;
        scene.save(
            &Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn,
                positions,
                format,
                name: &name,
                placement,
            },
            &Progress::new(),
            &Cancel::new(),
        )
    };
    if let Ok(same) = save(&drawn.positions, format) {
        assert!(same.files[0].bytes == bytes, "unmoved: byte for byte");
    }
    let shift = |p: &DVec3| {
        if p.is_finite() {
            *p * 0.5 + DVec3::new(0.25, -1.0, 3.0)
        } else {
            *p
        }
    };
    let half = drawn.positions.iter().enumerate();
    let positions: Vec<DVec3> = half.map(|(v, p)| if v % 2 == 0 { shift(p) } else { *p }).collect();
    for format in [format, other] {
        if let Ok(saved) = save(&positions, format) {
            let again = read(
                saved.files[0].bytes.clone(),
                format,
                "again",
                &saved,
                &Progress::new(),
                &Cancel::new(),
            );
            // Neighbours that were missing or broken are still missing.
            if let Ok(again) = again {
                assert!(again.drawn.triangles.len() <= drawn.triangles.len());
            }
        }
    }
    if matches!(format, Format::Glb | Format::Gltf) {
        let _ = scene.save_as_morph(
            &Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn,
                positions: &positions,
                format: Format::Glb,
                name: "out.glb",
                placement: Placement::OtherFolder,
            },
            &MorphTarget { name: "x", weight: 1.0 },
            &Progress::new(),
            &Cancel::new(),
        );
    }
    Outcome::Read
}
