//! STL, binary and ascii: three corners per facet, each its own file vertex; welding joins them.
//!
//! Saving replaces the moved corners' numbers and the normals of their facets and no other byte: headers, attribute
//! bytes, names of solids and white space stay.

mod ascii;
mod binary;
mod facets;
mod write;

use std::sync::Arc;

use pliant_mesh::{Drawn, DrawnVertex};

use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::summary::Summary;
use crate::text::{mark_len, shortest_f32};
use crate::{Appearance, ReadError, SaveError};

pub(crate) use write::write_new;

/// An STL file as stored.
#[derive(Debug)]
pub(crate) struct Stored {
    bytes: Arc<Vec<u8>>,
    layout: Layout,
    facet_count: usize,
    notes: Vec<String>,
    unread: Vec<String>,
}

#[derive(Debug)]
enum Layout {
    Binary,
    /// The byte position of each facet's `facet` keyword.
    Ascii(Vec<usize>),
}

/// Reads an STL file of either kind.
///
/// Some binary files begin with "solid", and an ascii file can have any length. So a file is binary if its length fits
/// its facet count; otherwise ascii if it begins with "solid"; otherwise binary, too.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let bytes: &[u8] = source.bytes;
    let (mut notes, mut unread) = (Vec::new(), Vec::new());
    let begins_as_ascii = bytes[mark_len(bytes)..]
        .trim_ascii_start()
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let (positions, layout) = if begins_as_ascii && !binary::is_certain(bytes) {
        let found = ascii::read(source)?;
        if found.solids > 1 {
            unread.push(format!("the division into {} solids", found.solids));
        }
        (found.corners, Layout::Ascii(found.places))
    } else {
        let facets = binary::read(source, &mut notes)?;
        if facets.have_attributes {
            notes.push(
                "The facets have attribute bytes, which some programs use for colours; they are kept but not shown."
                    .to_owned(),
            );
            unread.push("the facets' attribute bytes, which some programs use for colours".to_owned());
        }
        (facets.corners, Layout::Binary)
    };
    let count = positions.len() as u32;
    let corners = |facet| [0, 1, 2].map(|k| DrawnVertex(3 * facet + k));
    let drawn = Drawn::once(positions, (0..count / 3).map(corners).collect());
    Ok((
        Stored {
            bytes: source.bytes.clone(),
            layout,
            facet_count: drawn.triangles.len(),
            notes,
            unread,
        },
        drawn,
    ))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The parts of the file that other formats do not get.
    pub(crate) fn unread(&self) -> Vec<String> {
        self.unread.clone()
    }

    pub(crate) fn summary(&self) -> Summary {
        Summary::of_one_mesh(self.facet_count)
    }

    /// No normals are taken from the file: with facet normals every triangle of a scan would be visible.
    pub(crate) fn appearance(&self) -> Appearance {
        Appearance::plain(self.facet_count as u32)
    }

    /// The nearest number to `value` that the file stores for a coordinate, as it is read back.
    pub(crate) fn nearest(&self, value: f64) -> f64 {
        match self.layout {
            // f32 is the format's precision.
            Layout::Binary => f64::from(value as f32),
            Layout::Ascii(_) => shortest_f32(value),
        }
    }

    /// The file with the moved corners and their facets' normals replaced, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        let bytes = match &self.layout {
            Layout::Binary => binary::patched(&self.bytes, self.facet_count, moved, course)?,
            Layout::Ascii(facets) => ascii::patched(&self.bytes, facets, moved, course)?,
        };
        if !moved.turns_any() {
            return Ok((bytes, Vec::new()));
        }
        let turned = moved.turned_of_file();
        let is_turned = |facet: usize| turned.get(3 * facet).is_some_and(|is_turned| *is_turned);
        let bytes = match &self.layout {
            Layout::Binary => binary::turned(bytes, self.facet_count, is_turned),
            Layout::Ascii(_) => ascii::turned(&bytes, is_turned),
        };
        Ok((bytes, Vec::new()))
    }
}
