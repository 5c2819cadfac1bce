//! Stanford PLY, ascii and binary in both byte orders, read with the place of every vertex, so that saving changes the
//! moved vertices' coordinates (and normals) and no other byte.
//!
//! Elements and properties may come in any order and of any type; those that nothing is known of are passed over and
//! stay in the bytes. Faces are lists of corners or, in older scans, strips of triangles.

mod face_normals;
mod header;
mod patch;
mod records;
mod rewriting;
mod scalar;
mod turned;
mod write;

use std::sync::Arc;

use pliant_mesh::Drawn;

use crate::appearance::colour::{byte, linear_of_srgb};
use crate::convert::Polygons;
use crate::polygon::{cut_faces, left_out_note};
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::scene::summary::Summary;
use crate::source::Source;
use crate::{Appearance, Format, ReadError, SaveError};
use header::Header;
use records::{Columns, Places, Records};

pub(crate) use write::write_new;

/// A PLY file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    bytes: Arc<Vec<u8>>,
    header: Header,
    vertex_element: Option<usize>,
    columns: Columns,
    places: Places,
    normals: Vec<[f32; 3]>,
    colours: Vec<[f32; 4]>,
    uvs: Vec<[f32; 2]>,
    /// The faces, where one has more than three corners.
    polygons: Option<Polygons>,
    triangle_count: u32,
    notes: Vec<String>,
}

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
        corners,
        face_ends,
        left_out,
    } = records::read(source, &header)?;
    let (triangles, polygons) = cut_faces(&positions, corners, &face_ends, source.cancel)?;
    let notes = left_out_note(left_out).into_iter().collect();
    let drawn = Drawn::once(positions, triangles);
    let stored = Stored {
        bytes: source.bytes.clone(),
        header,
        vertex_element,
        columns,
        places,
        normals,
        colours,
        uvs,
        polygons,
        triangle_count: drawn.triangles.len() as u32,
        notes,
    };
    Ok((stored, drawn))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        Summary::of_one_mesh(self.triangle_count as usize)
    }

    pub(crate) fn appearance(&self) -> Appearance {
        let colour = |&[r, g, b, alpha]: &[f32; 4]| {
            let [r, g, b] = [r, g, b].map(|channel| byte(linear_of_srgb(channel)));
            [r, g, b, byte(alpha)]
        };
        let unit = |&normal: &[f32; 3]| glam::Vec3::from(normal).normalize_or_zero().to_array();
        let are_any_set = self.normals.iter().any(|normal| *normal != [0.0; 3]);
        Appearance {
            normals: are_any_set.then(|| self.normals.iter().map(unit).collect()),
            uvs: (!self.uvs.is_empty()).then(|| self.uvs.iter().map(|&[u, v]| [u, 1.0 - v]).collect()),
            colours: (!self.colours.is_empty()).then(|| self.colours.iter().map(colour).collect()),
            ..Appearance::plain(self.triangle_count)
        }
    }

    pub(crate) fn polygons(&self) -> Option<Polygons> {
        self.polygons.clone()
    }

    /// The number nearest to `value` that the column of a coordinate holds.
    pub(crate) fn nearest(&self, axis: usize, value: f64) -> f64 {
        patch::nearest(self, axis, value)
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        let (bytes, warnings) = patch::patched(self, moved, course)?;
        let bytes = face_normals::carried(self, bytes, moved);
        let bytes = match moved.turns_any() {
            true => {
                let turned = moved.turned_of_file();
                // While each face still begins with the corner that it is read with.
                let bytes = face_normals::negated(self, bytes, &turned);
                turned::turned(self, &bytes, &turned)?
            }
            false => bytes,
        };
        Ok((bytes, warnings))
    }

    fn cannot_hold(what: String, remedy: &str) -> SaveError {
        SaveError::CannotHold {
            what,
            format: Format::Ply,
            remedy: remedy.to_owned(),
        }
    }
}
