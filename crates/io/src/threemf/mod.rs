//! 3MF: objects of triangles in XML parts of a zip archive, placed by a build list.
//!
//! Saving changes the moved vertices' coordinates in the parts that have them, and keeps every other part of the archive
//! as it is: settings of slicers, thumbnails, relationships. Archive and XML are read by the crates `zip` and
//! `quick-xml`. The crate `threemf2` reads and writes whole documents into types of its own: elements and attributes
//! that it does not know, such as those of slicers, would be lost, and a coordinate has no place in the file.

mod build;
mod model;
mod patch;
mod placed;
mod resources;
mod stored;
mod write;
mod xml;

use std::ops::Range;

use glam::{DAffine3, DVec3};
use pliant_mesh::{Drawn, Object};

use crate::objects;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::summary::Summary;
use crate::{Appearance, Format, ReadError, SaveError};

use stored::Instance;

pub(crate) use stored::Stored;
pub(crate) use write::write_new;

/// Reads a 3MF file.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let malformed = |reason: String| source.malformed(Format::Threemf, reason);
    let parts = build::parts(source)?;
    let placed = placed::placed(&parts, source.bytes.len(), source.cancel)?;
    let placed = placed.map_err(malformed)?;
    Ok((
        Stored {
            bytes: source.bytes.clone(),
            parts: parts.parts,
            instances: placed.instances,
            look: placed.look,
            notes: placed.notes,
        },
        placed.drawn,
    ))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        let meshes = self.parts.iter().flat_map(|part| &part.objects);
        Summary {
            meshes: meshes.filter(|object| !object.vertices.is_empty()).count(),
            primitives: self.look.groups.len(),
            nodes: self.instances.len(),
            materials: self.look.materials.len(),
            images: self.look.images.len(),
            ..Summary::default()
        }
    }

    pub(crate) fn objects(&self) -> Vec<Object> {
        objects::of_groups(&self.look)
    }

    pub(crate) fn appearance(&self) -> Appearance {
        self.look.clone()
    }

    /// Ranges of drawn vertices, ascending, and the largest error of each of their coordinates when they are saved: none
    /// where the build list does not transform them.
    pub(crate) fn roundings(&self, drawn: &Drawn) -> Vec<(Range<u32>, DVec3)> {
        let within = |instance: &Instance| {
            if instance.transform == DAffine3::IDENTITY {
                return DVec3::ZERO;
            }
            let range = instance.vertices.start as usize..instance.vertices.end as usize;
            let finite = drawn.positions[range].iter().filter(|position| position.is_finite());
            let size = finite.fold(0.0, |size: f64, position| size.max(position.length()));
            let inverse = instance.transform.inverse();
            let norm = |transform: &DAffine3| {
                transform
                    .matrix3
                    .to_cols_array()
                    .iter()
                    .map(|number| number.abs())
                    .sum::<f64>()
            };
            let offset = instance.transform.translation.length();
            DVec3::splat(32.0 * f64::EPSILON * norm(&instance.transform) * norm(&inverse) * (size + offset))
        };
        self.instances
            .iter()
            .map(|instance| (instance.vertices.clone(), within(instance)))
            .collect()
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        patch::patched(self, moved, course).map(|bytes| (bytes, Vec::new()))
    }
}
