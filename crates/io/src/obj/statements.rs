//! An OBJ file's statements, with the place of every coordinate in the file.
//!
//! Only statements that affect the picture or the shape are kept (`v`, `vt`, `vn`, `f`, `usemtl`, `mtllib`, `o`, `g`,
//! and ZBrush's colours); everything else is skipped and stays in the bytes. Indices are resolved to numbers from 0; a
//! corner may name a `v` line that comes later.

use std::collections::HashMap;
use std::ops::Range;

use crate::obj::smoothing::Smoothing;
use crate::objects::short_name;
use crate::source::{Looks, Source};
use crate::text::{Cursor, excerpt, malformed_at, mark_len};
use crate::{Format, ReadError};
use glam::DVec3;

/// For a corner without a texture coordinate or without a normal.
pub(super) const NONE: u32 = u32::MAX;

/// For a drawn vertex that no corner has named yet; also the limit of every count.
pub(super) const UNUSED: u32 = NONE - 1;

/// One corner of a face: numbers of `v`, `vt` and `vn` lines from 0, the latter two possibly [`NONE`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// Faces that follow one another with one material and one object.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Run {
    /// The first face of the run; it ends where the next one begins.
    pub(super) first_face: usize,
    /// Index into [`Statements::material_names`].
    pub(super) material: Option<usize>,
    /// The `o` and the `g` name; empty where there is none.
    pub(super) names: [String; 2],
}

impl Run {
    /// The `o` name, or else the `g` name; empty if there is neither.
    pub(super) fn object(&self) -> &str {
        let [object, group] = &self.names;
        if object.is_empty() { group } else { object }
    }
}

/// The statements of an OBJ file, in the order of its lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Statements {
    pub(super) positions: Vec<DVec3>,
    /// Byte of the first coordinate of each `v`.
    pub(super) position_at: Vec<usize>,
    /// Colours after the positions, as written; empty if no `v` has any, white for a `v` without one.
    pub(super) colours: Vec<[f32; 3]>,
    /// f32: only ever drawn; saving copies the bytes.
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) normals: Vec<DVec3>,
    /// Byte of the first component of each `vn`.
    pub(super) normal_at: Vec<usize>,
    /// The corners of all faces, one after the other.
    pub(super) corners: Vec<Corner>,
    /// The end of each face's corners; they begin at the previous face's end.
    pub(super) face_ends: Vec<usize>,
    pub(super) runs: Vec<Run>,
    pub(super) material_names: Vec<String>,
    /// The spans of the names after `mtllib`.
    pub(super) libraries: Vec<Range<usize>>,
    /// Faces with fewer than three corners, which draw nothing: their number, and the byte of the first.
    pub(super) left_out: (usize, usize),
    /// Corners whose `vt` or `vn` doesn't exist: their number, and the byte of the first.
    pub(super) dangling: (usize, usize),
    pub(super) smoothing: Smoothing,
}

/// The highest number that a corner has named so far, and its place.
#[derive(Clone, Copy, Default)]
struct Highest {
    count: u32,
    at: usize,
}

impl Highest {
    fn note(&mut self, index: u32, at: usize) {
        if index != NONE && index >= self.count {
            *self = Self { count: index + 1, at };
        }
    }
}

/// Reads the statements of an OBJ file.
///
/// # Errors
/// A `v` without three numbers, a face corner that isn't one or names no `v`, and cancellation.
pub(super) fn parse(source: &Source<'_>) -> Result<Statements, ReadError> {
    let mut reader = Reader::new(source);
    while !reader.cursor.is_done() {
        source.pass(&mut reader.looks, reader.cursor.at())?;
        reader.line()?;
        reader.cursor.next_line();
    }
    reader.finish()
}

/// The statements read so far, and the data that they refer to.
struct Reader<'a> {
    source: &'a Source<'a>,
    cursor: Cursor<'a>,
    looks: Looks,
    found: Statements,
    highest_position: Highest,
    object: String,
    group: String,
    material: Option<usize>,
    material_numbers: HashMap<String, usize>,
    run_is_open: bool,
    /// The smoothing group of the faces that follow.
    smoothing: String,
    /// The colours of `#MRGB` lines, in the vertices' order.
    polypaint: Vec<[f32; 3]>,
}

impl<'a> Reader<'a> {
    fn new(source: &'a Source<'a>) -> Self {
        Self {
            source,
            cursor: Cursor::new(source.bytes, mark_len(source.bytes)),
            looks: Looks::default(),
            found: Statements::default(),
            highest_position: Highest::default(),
            object: String::new(),
            group: String::new(),
            material: None,
            material_numbers: HashMap::new(),
            run_is_open: false,
            smoothing: String::new(),
            polypaint: Vec::new(),
        }
    }

    /// Reads the statement on the cursor's line; leaves the cursor somewhere on its last line.
    fn line(&mut self) -> Result<(), ReadError> {
        self.cursor.skip_blanks();
        match self.cursor.word() {
            b"v" => self.position(),
            b"vt" => {
                self.texture_coordinate();
                Ok(())
            }
            b"vn" => {
                self.normal();
                Ok(())
            }
            b"f" | b"fo" => self.face(),
            b"usemtl" => {
                let material = self.rest();
                self.use_material(material);
                Ok(())
            }
            b"o" => {
                self.object = self.name();
                self.run_is_open = false;
                Ok(())
            }
            b"g" => {
                self.group = self.name();
                self.run_is_open = false;
                Ok(())
            }
            b"s" => {
                self.smoothing = self.name();
                Ok(())
            }
            b"#MRGB" => {
                self.polypaint();
                Ok(())
            }
            b"mtllib" => {
                self.cursor.skip_blanks();
                let start = self.cursor.at();
                let length = self.cursor.rest_of_line().trim_ascii_end().len();
                self.found.libraries.push(start..start + length);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn rest(&mut self) -> String {
        String::from_utf8_lossy(self.cursor.rest_of_line().trim_ascii()).into_owned()
    }

    /// Every run of its faces gets a copy of this name, so it is cut to a readable length.
    fn name(&mut self) -> String {
        short_name(&self.rest())
    }

    fn real(&mut self) -> Option<f64> {
        self.cursor.skip_blanks_continued();
        self.cursor.real()
    }

    /// `v x y z`, then nothing, `w`, `r g b` or `r g b a`.
    fn position(&mut self) -> Result<(), ReadError> {
        self.cursor.skip_blanks_continued();
        let at = self.cursor.at();
        let (Some(x), Some(y), Some(z)) = (self.real(), self.real(), self.real()) else {
            return Err(self.broken(at, "a 'v' needs three numbers: correct the line"));
        };
        let found = &mut self.found;
        if found.positions.len() >= UNUSED as usize {
            return Err(self.broken(at, "it has more vertices than 32 bits can number: split the file"));
        }
        found.positions.push(DVec3::new(x, y, z));
        found.position_at.push(at);
        self.cursor.skip_blanks_continued();
        if !self.cursor.is_at_line_end()
            && let (Some(r), Some(g), Some(b)) = (self.real(), self.real(), self.real())
        {
            let found = &mut self.found;
            found.colours.resize(found.positions.len() - 1, [1.0; 3]);
            found.colours.push([r as f32, g as f32, b as f32]);
        }
        Ok(())
    }

    /// `#MRGB` and blocks of eight hexadecimal digits, one for each vertex: ZBrush's mask, red, green and blue.
    fn polypaint(&mut self) {
        let text = self.rest();
        let blocks = text.as_bytes().chunks_exact(8);
        let channel = |block: &[u8], place: usize| {
            let digits = std::str::from_utf8(&block[place..place + 2]).ok()?;
            u8::from_str_radix(digits, 16).ok().map(|byte| f32::from(byte) / 255.0)
        };
        let colour = |block: &[u8]| Some([channel(block, 2)?, channel(block, 4)?, channel(block, 6)?]);
        self.polypaint.extend(blocks.map_while(colour));
    }

    /// `vt u [v [w]]`; anything that isn't a number counts as 0, because it moves nothing.
    fn texture_coordinate(&mut self) {
        let u = self.real().unwrap_or(0.0);
        let v = self.real().unwrap_or(0.0);
        self.found.uvs.push([u as f32, v as f32]);
    }

    /// `vn x y z`; a line without three numbers gives a normal that isn't finite, and so is never changed.
    fn normal(&mut self) {
        self.cursor.skip_blanks_continued();
        self.found.normal_at.push(self.cursor.at());
        let normal = match (self.real(), self.real(), self.real()) {
            (Some(x), Some(y), Some(z)) => DVec3::new(x, y, z),
            _ => DVec3::NAN,
        };
        self.found.normals.push(normal);
    }

    fn use_material(&mut self, name: String) {
        let fresh = self.found.material_names.len();
        let number = *self.material_numbers.entry(name.clone()).or_insert(fresh);
        if number == fresh {
            self.found.material_names.push(name);
        }
        self.material = Some(number);
        self.run_is_open = false;
    }

    /// `f` and its corners: `v`, `v/vt`, `v//vn` or `v/vt/vn` each.
    fn face(&mut self) -> Result<(), ReadError> {
        let first = self.found.corners.len();
        let face_at = self.cursor.at();
        loop {
            self.cursor.skip_blanks_continued();
            if self.cursor.is_at_line_end() {
                break;
            }
            self.source.pass(&mut self.looks, self.cursor.at())?;
            let corner = self.corner()?;
            self.found.corners.push(corner);
        }
        if self.found.corners.len() - first < 3 {
            self.found.corners.truncate(first);
            note(&mut self.found.left_out, face_at);
            return Ok(());
        }
        if !self.run_is_open {
            let run = Run {
                first_face: self.found.face_ends.len(),
                material: self.material,
                names: [self.object.clone(), self.group.clone()],
            };
            self.found.runs.push(run);
            self.run_is_open = true;
        }
        let faces = self.found.face_ends.len();
        self.found.smoothing.add_face(&self.smoothing, first, faces);
        self.found.face_ends.push(self.found.corners.len());
        Ok(())
    }

    fn corner(&mut self) -> Result<Corner, ReadError> {
        let at = self.cursor.at();
        let named = self.cursor.integer();
        let mut corner = Corner {
            position: NONE,
            uv: NONE,
            normal: NONE,
        };
        let Some(position) = named.and_then(|index| resolve(index, self.found.positions.len())) else {
            let reason = match named {
                Some(index) => format!("the face names the vertex {index}, which doesn't exist: correct the number"),
                None => no_corner(self.cursor.word()),
            };
            return Err(self.broken(at, reason));
        };
        corner.position = position;
        self.highest_position.note(position, at);
        for slot in 0..2 {
            if self.cursor.peek() != Some(b'/') {
                break;
            }
            self.cursor.step();
            let count = if slot == 0 {
                self.found.uvs.len()
            } else {
                self.found.normals.len()
            };
            if let Some(index) = self.cursor.integer() {
                let target = if slot == 0 { &mut corner.uv } else { &mut corner.normal };
                match resolve(index, count) {
                    Some(number) => *target = number,
                    None => note(&mut self.found.dangling, at),
                }
            }
        }
        if !matches!(self.cursor.peek(), None | Some(b' ' | b'\t'..=b'\r' | b'#' | b'\\')) {
            let reason = no_corner(Cursor::new(self.source.bytes, at).word());
            return Err(self.broken(at, reason));
        }
        Ok(corner)
    }

    /// Checks the corners that named later lines.
    fn finish(mut self) -> Result<Statements, ReadError> {
        // Every corner may need a drawn vertex of its own.
        if self.found.corners.len() + self.found.positions.len() >= UNUSED as usize {
            return Err(ReadError::TooLarge {
                name: self.source.name.to_owned(),
                what: format!("{} face corners", self.found.corners.len()),
            });
        }
        let highest = self.highest_position;
        if highest.count as usize > self.found.positions.len() {
            let (named, count) = (highest.count, self.found.positions.len());
            let reason = format!("the face names the vertex {named}, but the file has {count}: correct the number");
            return Err(self.broken(highest.at, reason));
        }
        let found = &mut self.found;
        let (uv_count, normal_count) = (found.uvs.len(), found.normals.len());
        for corner in &mut found.corners {
            for (index, count) in [(&mut corner.uv, uv_count), (&mut corner.normal, normal_count)] {
                if *index != NONE && *index as usize >= count {
                    *index = NONE;
                    found.dangling.0 += 1;
                }
            }
        }
        if found.colours.is_empty() {
            found.colours = self.polypaint;
        }
        if !found.colours.is_empty() {
            found.colours.resize(found.positions.len(), [1.0; 3]);
        }
        Ok(self.found)
    }

    fn broken(&self, at: usize, reason: impl Into<String>) -> ReadError {
        malformed_at(self.source, Format::Obj, at, &reason.into())
    }
}

fn no_corner(word: &[u8]) -> String {
    format!(
        "'{}' is not a corner of a face: correct it, as in 'f 1/2/3 4/5/6 7/8/9'",
        excerpt(word)
    )
}

/// Counts one more, keeping the place of the first.
fn note(counted: &mut (usize, usize), at: usize) {
    if counted.0 == 0 {
        counted.1 = at;
    }
    counted.0 += 1;
}

/// An index as written (from 1, or from the end when negative) as a number from 0; `None` if it can't exist.
pub(super) fn resolve(index: i64, count: usize) -> Option<u32> {
    let number = if index > 0 {
        index - 1
    } else {
        index.checked_add(i64::try_from(count).ok()?)?
    };
    if index == 0 {
        return None;
    }
    u32::try_from(number).ok().filter(|&number| number < UNUSED)
}
