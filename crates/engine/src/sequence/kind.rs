//! The kinds of sequences, by their files.

use std::path::{Path, PathBuf};

use pliant_io::PointCacheFormat;

use super::folder::Folder;
use super::open::is_gltf;
use super::source::cache_format;
use crate::EngineError;
use crate::animate::check_output;
use crate::edit_job::EditJob;
use crate::files::{Destination, OutputFolder, refuse_shared};
use crate::path_text::shown;

/// The kind of a sequence.
pub(super) enum Kind {
    /// A folder of frames, the first of them, and the folder to write.
    Folder {
        folder: Folder,
        mesh: PathBuf,
        output: OutputFolder,
    },
    /// A point cache, its mesh, and the cache to write.
    Cache {
        format: PointCacheFormat,
        mesh: PathBuf,
        to: Destination,
    },
    /// A glTF with an animation of morph targets.
    Animation { mesh: PathBuf },
}

impl Kind {
    /// The kind of a job's file. `mesh` is that of a point cache.
    ///
    /// # Errors
    /// A file that is no sequence, an output that does not fit it, a mesh where none is needed or a missing one.
    pub fn of(job: &EditJob<'_>, mesh: Option<&Path>) -> Result<Self, EngineError> {
        let Some(own) = cache_format(job.file) else {
            if mesh.is_some() {
                return Err(EngineError::Arguments(
                    "--mesh is for a point cache (.pc2 or .mdd), and other sequences need none: leave it out"
                        .to_owned(),
                ));
            }
            if is_gltf(job.file) {
                check_output(job.output)?;
                let mesh = job.file.to_owned();
                return Ok(Self::Animation { mesh });
            }
            let folder = Folder::of(job.file)?;
            return Ok(Self::Folder {
                mesh: folder.frames[0].clone(),
                folder,
                output: OutputFolder::of(job.output, ("FOLDER", job.file))?,
            });
        };
        if cache_format(job.output) != Some(own) {
            return Err(EngineError::Arguments(format!(
                "--output {} must be a point cache of the same kind as {}: give it the same extension",
                shown(job.output),
                shown(job.file)
            )));
        }
        let Some(mesh) = mesh else {
            return Err(EngineError::Arguments(format!(
                "{} holds only positions: give the mesh that it was made of as --mesh",
                shown(job.file)
            )));
        };
        refuse_shared(
            ("--output", job.output),
            [("FOLDER_OR_FILE", job.file), ("--mesh", mesh)],
        )?;
        Ok(Self::Cache {
            format: own,
            mesh: mesh.to_owned(),
            to: Destination::of(job.output)?,
        })
    }

    /// The file whose vertices and faces all frames have.
    pub fn mesh(&self) -> &Path {
        let (Self::Folder { mesh, .. } | Self::Cache { mesh, .. } | Self::Animation { mesh }) = self;
        mesh
    }
}
