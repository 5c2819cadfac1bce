//! Reads a file of any format.

use std::sync::Arc;

use pliant_mesh::{Cancel, Drawn, Progress};

use crate::scene::stored::{Scene, Stored};
use crate::source::{Resolver, Source};
use crate::{Format, ReadError, gltf, obj, off, ply, stl, threemf, usdz};

/// The result of [`read`].
#[derive(Debug)]
pub struct SceneAndDrawn {
    /// The file as stored.
    pub scene: Scene,
    /// The geometry that it shows.
    pub drawn: Drawn,
}

/// Reads a file of the given format. `name` is used in messages only; `resolver` reads the neighbours.
pub fn read(
    bytes: Vec<u8>,
    format: Format,
    name: &str,
    resolver: &dyn Resolver,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<SceneAndDrawn, ReadError> {
    cancel.check()?;
    let bytes = Arc::new(bytes);
    let source = Source {
        bytes: &bytes,
        name,
        resolver,
        progress,
        cancel,
    };
    let (stored, drawn) = match format {
        Format::Glb | Format::Gltf => {
            let (stored, drawn) = gltf::read(&source, format)?;
            (Stored::Gltf(stored), drawn)
        }
        Format::Obj => {
            let (stored, drawn) = obj::read(&source)?;
            (Stored::Obj(stored), drawn)
        }
        Format::Ply => {
            let (stored, drawn) = ply::read(&source)?;
            (Stored::Ply(stored), drawn)
        }
        Format::Stl => {
            let (stored, drawn) = stl::read(&source)?;
            (Stored::Stl(stored), drawn)
        }
        Format::Off => {
            let (stored, drawn) = off::read(&source)?;
            (Stored::Off(stored), drawn)
        }
        Format::Threemf => {
            let (stored, drawn) = threemf::read(&source)?;
            (Stored::Threemf(stored), drawn)
        }
        Format::Usdz => {
            let (stored, drawn) = usdz::read(&source)?;
            (Stored::Usdz(stored), drawn)
        }
    };
    cancel.check()?;
    progress.set(1.0);
    Ok(SceneAndDrawn {
        scene: Scene { format, bytes, stored },
        drawn,
    })
}
