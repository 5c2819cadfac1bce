//! Stanford PLY, ascii and binary in both byte orders, read with the place of every vertex, so that saving changes the
//! moved vertices' coordinates (and normals) and no other byte.
//!
//! Elements and properties may come in any order and of any type; unknown ones are skipped and stay in the bytes. Faces
//! are lists of corners or, in older scans, strips of triangles.

mod coloured;
mod face_normals;
mod header;
mod patch;
mod records;
mod rewriting;
mod scalar;
mod stored;
mod textures;
mod turned;
mod unread;
mod wedges;
mod write;

use pliant_mesh::Drawn;

use crate::appearance::colour::linear_colour;
use crate::convert::Polygons;
use crate::polygon::{cut_faces, left_out_note};
use crate::save::OutputFile;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::source::notes::Notes;
use crate::summary::Summary;
use crate::{Appearance, ReadError, SaveError};
use records::Records;
use textures::Textures;
use wedges::Wedges;

pub(crate) use stored::Stored;
pub(crate) use textures::renamed as texture_renamed;
pub(crate) use write::write_new;

/// Reads a PLY file.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let header = header::parse(source)?;
    let Records {
        vertex_element,
        columns,
        places,
        positions,
        normals,
        colours,
        uvs,
        mut corners,
        face_ends,
        corner_uvs,
        textures: texture_numbers,
        left_out,
    } = records::read(source, &header)?;
    let mut notes = Notes::default();
    notes.add("faces", left_out_note(left_out));
    for note in unread::notes(&header.elements, vertex_element) {
        notes.add("properties", Some(note));
    }
    let wedges = match corner_uvs.is_empty() {
        true => Wedges {
            uvs,
            further: Vec::new(),
        },
        false => Wedges::number(&mut corners, &corner_uvs, positions.len(), &uvs),
    };
    let mut drawn = wedges.place(positions);
    let (triangles, polygons) = cut_faces(&drawn.positions, corners, &face_ends, source.cancel)?;
    drawn.triangles = triangles;
    let textures = Textures::read(source, &header.textures, &mut notes);
    let starts = std::iter::once(0).chain(face_ends.iter().copied());
    let counts = starts.zip(&face_ends).map(|(start, &end)| end - start - 2);
    let (materials, groups) = textures.dress(&texture_numbers, counts, drawn.triangles.len() as u32);
    let stored = Stored {
        bytes: source.bytes.clone(),
        header,
        vertex_element,
        columns,
        places,
        normals,
        colours,
        uvs: wedges.uvs,
        further: wedges.further,
        textures,
        materials,
        groups,
        polygons,
        triangle_count: drawn.triangles.len() as u32,
        notes: notes.sentences(),
    };
    Ok((stored, drawn))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        Summary {
            images: self.textures.images.len(),
            ..Summary::of_one_mesh(self.triangle_count as usize)
        }
    }

    pub(crate) fn appearance(&self) -> Appearance {
        let unit = |normal: [f32; 3]| glam::Vec3::from(normal).normalize_or_zero().to_array();
        let are_any_set = self.normals.iter().any(|normal| *normal != [0.0; 3]);
        Appearance {
            obj: None,
            normals: are_any_set.then(|| self.of_drawn(&self.normals).map(unit).collect()),
            uvs: (!self.uvs.is_empty()).then(|| self.uvs.iter().map(|&[u, v]| [u, 1.0 - v]).collect()),
            second_uvs: None,
            colours: (!self.colours.is_empty()).then(|| self.of_drawn(&self.colours).map(linear_colour).collect()),
            flat: Vec::new(),
            groups: self.groups.clone(),
            materials: self.materials.clone(),
            images: self.textures.images.clone(),
        }
    }

    /// For each drawn vertex the entry of its file vertex.
    fn of_drawn<'a, T: Copy>(&'a self, of_file: &'a [T]) -> impl Iterator<Item = T> + 'a {
        let further = self.further.iter().map(|&vertex| of_file[vertex as usize]);
        of_file.iter().copied().chain(further)
    }

    /// The parts of the file that other formats do not get.
    pub(crate) fn unread(&self) -> Vec<String> {
        unread::parts(&self.header.elements, self.vertex_element, &self.columns)
    }

    /// The textures that a copy in another folder needs beside it, and warnings.
    pub(crate) fn neighbours(&self) -> (Vec<OutputFile>, Vec<String>) {
        self.textures.neighbours()
    }

    pub(crate) fn polygons(&self) -> Option<Polygons> {
        self.polygons.clone()
    }

    /// The number nearest to `value` that the column of a coordinate holds.
    pub(crate) fn nearest(&self, axis: usize, value: f64) -> f64 {
        patch::nearest(self, axis, value)
    }

    /// The file with another colour for each of its vertices, in sRGB.
    pub(crate) fn write_coloured(&self, colours: &[Option<[u8; 4]>]) -> Result<Vec<u8>, SaveError> {
        coloured::coloured(self, colours)
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        let (bytes, warnings) = patch::patched(self, moved, course)?;
        let bytes = face_normals::carried(self, bytes, moved);
        let bytes = match moved.turns_any() {
            true => {
                let turned = moved.turned_of_file();
                // This holds while each face still begins with the corner that it is read with.
                let bytes = face_normals::negated(self, bytes, &turned);
                turned::turned(self, &bytes, &turned)?
            }
            false => bytes,
        };
        Ok((bytes, warnings))
    }
}
