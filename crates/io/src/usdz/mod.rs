//! USDZ: meshes of a USD layer in a zip archive, for phones.
//!
//! A layer that is text (`.usda`) is read where it holds plain meshes, and saving changes the moved points and normals
//! in it, and keeps everything else. A binary layer (`.usdc`) is refused. The crate `openusd` 0.6, the last for this
//! compiler, reads both, but not safely: of broken binary layers, some make it allocate 2 TB at once, which ends the
//! program, and a run over broken text layers did not end within a minute.

mod drawing;
mod fault;
mod layer;
mod looks;
mod mesh;
mod patch;
mod placed;
mod stored;
mod tokens;
mod transform;
mod values;
mod write;

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Drawn, Object};

use crate::archive::Archive;
use crate::convert::Polygons;
use crate::objects;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::summary::Summary;
use crate::{Appearance, Format, ReadError, SaveError};

use fault::Fault;
use looks::Looks;
use stored::Instance;

pub(crate) use stored::Stored;
pub(crate) use write::write_new;

/// Reads a USDZ file.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let unsupported = |feature: String, remedy: String| ReadError::Unsupported {
        name: source.name.to_owned(),
        feature,
        remedy,
    };
    let error = |fault: Fault| match fault {
        Fault::Malformed(reason) => source.malformed(Format::Usdz, reason),
        Fault::Composed => unsupported(
            "references, variants or instances of USD".to_owned(),
            "flatten it (`usdcat --flatten`), or export it as .glb".to_owned(),
        ),
        Fault::Unsupported { feature, remedy } => unsupported(feature, remedy),
        Fault::Stopped(stopped) => stopped,
    };
    let malformed = |reason: String| source.malformed(Format::Usdz, reason);
    let mut archive = Archive::open(source.bytes).map_err(malformed)?;
    let name = archive
        .first_name()
        .ok_or_else(|| malformed("it is empty".to_owned()))?;
    let part = archive.part(&name).map_err(malformed)?;
    if part.bytes.starts_with(b"PXR-USDC") {
        return Err(unsupported(
            "a binary layer of USD".to_owned(),
            "write the layer as text (`usdcat -o model.usda`) and pack it again (`usdzip`), or export it as .glb"
                .to_owned(),
        ));
    }
    let layer = layer::layer(&part.bytes, source.cancel).map_err(error)?;
    let looks = Looks::new(&part.bytes, &layer, archive, &name);
    let placed = placed::placed(&part.bytes, &layer, looks, source.cancel).map_err(error)?;
    let (drawn, instances) = (placed.drawn, placed.instances);
    let (look, notes, polygons) = (placed.looks.look, placed.looks.notes, placed.polygons);
    let stored = Stored {
        bytes: source.bytes.clone(),
        place: part.place,
        text: part.bytes,
        instances,
        polygons: (polygons.len() < drawn.triangles.len()).then_some(polygons),
        look,
        notes,
    };
    Ok((stored, drawn))
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        Summary {
            meshes: self.instances.len(),
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

    /// The faces over drawn vertices, if any of them is not a triangle.
    pub(crate) fn polygons(&self) -> Option<Polygons> {
        self.polygons.clone()
    }

    pub(crate) fn appearance(&self) -> Appearance {
        self.look.clone()
    }

    /// Ranges of drawn vertices, ascending, and the largest error of each of their coordinates when they are saved.
    pub(crate) fn roundings(&self, drawn: &Drawn) -> Vec<(Range<u32>, DVec3)> {
        let within = |instance: &Instance| {
            let inverse = instance.transform.inverse();
            let range = instance.vertices.start as usize..instance.vertices.end as usize;
            let finite = drawn.positions[range].iter().filter(|position| position.is_finite());
            let sizes = finite.map(|&position| {
                let own = inverse.transform_point3(position).abs().max_element();
                (position.abs().max_element(), own)
            });
            let (size, own) = sizes.fold((0.0_f64, 0.0_f64), |most, next| {
                (most.0.max(next.0), most.1.max(next.1))
            });
            let rows = instance.transform.matrix3.transpose();
            let sum = |row: DVec3| row.abs().element_sum();
            let step = if instance.mesh.is_single {
                f64::from(f32::EPSILON)
            } else {
                0.0
            };
            let offset = instance.transform.translation.abs().max_element();
            [rows.x_axis, rows.y_axis, rows.z_axis]
                .map(|row| sum(row) * own * (step + 32.0 * f64::EPSILON) + 8.0 * f64::EPSILON * (size + offset))
                .into()
        };
        let each = self.instances.iter();
        each.map(|instance| (instance.vertices.clone(), within(instance)))
            .collect()
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        patch::patched(self, moved, course)
    }
}
