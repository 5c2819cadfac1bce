//! Changes of the open file's triangles, off the window's thread: the engine makes a new shape in memory.

use std::path::Path;
use std::sync::Arc;

use pliant_editor::StitchRequest;
use pliant_engine::stitching::{Present, Remade, remake};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, memory};
use pliant_picture::drawing::Drawing;

use super::clause::as_sentence;
use crate::window::files::in_file::InFile;
use crate::window::files::other_shape::OtherShape;
use crate::window::files::rest_mesh::{MeshSource, RestMesh};
use crate::window::threads::message::{Refusal, Stitched};
use crate::window::viewport::gpu::Gpu;

/// Makes the new shape of the open file. `second` is the file that is appended.
///
/// # Errors
/// The refusal, with its place if it has one.
pub fn stitch(
    request: &StitchRequest,
    loaded: &Loaded,
    second: Option<&Path>,
    gpu: &Gpu,
    watch: &Watch,
) -> Result<Box<Stitched>, Refusal> {
    let made = make(request, loaded, second, gpu, watch);
    made.map_err(|error| Refusal {
        place: match &error {
            EngineError::Stitch { source, .. } => source.place(),
            _ => None,
        },
        sentence: match error {
            EngineError::Interrupted => format!("{} was stopped: the surface is unchanged.", request.change.name()),
            error => error.to_string(),
        },
    })
}

fn make(
    request: &StitchRequest,
    loaded: &Loaded,
    second: Option<&Path>,
    gpu: &Gpu,
    watch: &Watch,
) -> Result<Box<Stitched>, EngineError> {
    let present = Present {
        loaded,
        displacements: request.displacements(),
        inside_out: request.inside_out(),
    };
    let weld = loaded.model.weld;
    let second = second.map(|path| pliant_engine::load(path, &weld, watch)).transpose()?;
    let Remade {
        loaded,
        moved,
        done,
        warnings,
        left_open,
    } = remake(&present, &request.change, second.as_ref(), watch)?;
    let progress = watch.begin("preparing the picture");
    let mesh = request.onto(
        Arc::clone(&loaded.model),
        moved.as_deref(),
        memory::budget(),
        &watch.cancel,
    );
    let mesh = mesh.map_err(|_| EngineError::Interrupted)?;
    progress.set(0.3);
    let drawing = Drawing::new(&loaded.model, loaded.scene.appearance(), Arc::default());
    progress.set(0.7);
    let at_rest = vec![glam::DVec3::ZERO; loaded.model.surface.positions.len()];
    let pose = drawing.pose(&loaded.model, &at_rest);
    let surface = gpu.upload(&drawing, &pose);
    let surface = surface.map_err(|error| EngineError::System(error.to_string()))?;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let loaded = Arc::new(loaded);
    let notes = std::iter::once(done).chain(warnings).chain(mesh.lost().iter().cloned());
    Ok(Box::new(Stitched {
        notes: notes.map(|note| as_sentence(&note)).collect(),
        left_open,
        shape: OtherShape {
            morph_targets: loaded.scene.morph_targets(),
            drawing: Arc::new(drawing),
            surface: Some(surface),
            mesh: RestMesh::new(Arc::clone(&loaded), MeshSource::Gone),
            in_file: InFile::Made(request.change.name(), mesh.former().clone()),
            may_write_over: false,
            loaded,
        },
        mesh,
    }))
}
