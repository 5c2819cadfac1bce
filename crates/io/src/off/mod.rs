//! OFF and its COFF, NOFF and STOFF variants, read with the place of every vertex, so that saving changes the moved
//! vertices' coordinates (and normals) and no other byte: comments, colours and faces stay the same.

mod coloured;
mod header;
mod patch;
mod records;
mod stored;
mod turned;
mod write;

use pliant_mesh::Drawn;

use crate::appearance::colour::linear_colour;
use crate::convert::Polygons;
use crate::polygon::{cut_faces, left_out_note};
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::summary::Summary;
use crate::{Appearance, ReadError, SaveError};

pub(crate) use stored::Stored;
pub(crate) use write::write_new;

/// Reads an OFF file.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let (header, cursor) = header::parse(source)?;
    let mut records = records::read(source, &header, cursor)?;
    let positions = std::mem::take(&mut records.positions);
    let corners = std::mem::take(&mut records.corners);
    let face_ends = std::mem::take(&mut records.face_ends);
    let (triangles, polygons) = cut_faces(&positions, corners, &face_ends, source.cancel)?;
    let of_colours = records
        .has_face_colours
        .then(|| "The colours of its faces are kept but not shown.".to_owned());
    let notes = left_out_note(records.left_out).into_iter().chain(of_colours).collect();
    let drawn = Drawn::once(positions, triangles);
    let triangle_count = drawn.triangles.len() as u32;
    Ok((
        Stored {
            bytes: source.bytes.clone(),
            records,
            polygons,
            triangle_count,
            face_count: header.faces,
            notes,
        },
        drawn,
    ))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        Summary::of_one_mesh(self.triangle_count as usize)
    }

    pub(crate) fn appearance(&self) -> Appearance {
        let records = &self.records;
        // Colours are written from 0 to 1 or to 255; a file's largest channel decides.
        let most = records
            .colours
            .iter()
            .flatten()
            .fold(1.0f32, |most, &channel| most.max(channel));
        let scale = if most > 1.0 { 1.0 / 255.0 } else { 1.0 };
        let colour = |&[r, g, b, alpha]: &[f32; 4]| {
            let alpha = if alpha.is_nan() { 1.0 } else { alpha * scale };
            linear_colour([r * scale, g * scale, b * scale, alpha])
        };
        let unit = |normal: &glam::DVec3| normal.normalize_or_zero().as_vec3().to_array();
        Appearance {
            normals: (!records.normals.is_empty()).then(|| records.normals.iter().map(unit).collect()),
            uvs: (!records.uvs.is_empty()).then(|| records.uvs.iter().map(|&[u, v]| [u, 1.0 - v]).collect()),
            colours: (!records.colours.is_empty()).then(|| records.colours.iter().map(colour).collect()),
            ..Appearance::plain(self.triangle_count)
        }
    }

    /// The parts of the file that other formats do not get.
    pub(crate) fn unread(&self) -> Vec<String> {
        let has_colours = self.records.has_face_colours;
        has_colours
            .then(|| "the colours of faces".to_owned())
            .into_iter()
            .collect()
    }

    pub(crate) fn polygons(&self) -> Option<Polygons> {
        self.polygons.clone()
    }

    /// The file with another colour for each of its vertices, in sRGB.
    pub(crate) fn write_coloured(&self, colours: &[Option<[u8; 4]>]) -> Vec<u8> {
        coloured::coloured(self, colours)
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        let bytes = patch::patched(self, moved, course)?;
        let Some(&first) = self.records.vertex_at.first().filter(|_| moved.turns_any()) else {
            return Ok((bytes, Vec::new()));
        };
        let has_normals = !self.records.normals.is_empty();
        // A moved vertex has no other place for the first record.
        let bytes = turned::turned(&bytes, first, &moved.turned_of_file(), has_normals, self.face_count);
        Ok((bytes, Vec::new()))
    }
}
