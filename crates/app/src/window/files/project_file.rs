//! A project as a file: finds its mesh again, and keeps the mesh that it needs.

use std::path::{Path, PathBuf};

use pliant_assets::CREATURE;
use pliant_editor::{Beginning, MeshReference, Project, Snapshot, geometry_hash};
use pliant_mesh::{Cancel, Progress};

use super::names::{SAMPLE_NAME, file_name, original_name, saved_name};
use pliant_engine::files::{self, Staging};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded};

/// Where a mesh as it was read stands now.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum MeshSource {
    /// It is built in.
    Sample,
    /// In this file.
    File(PathBuf),
    /// Nowhere any more: it was saved over, and has to be written again if it is needed.
    Gone,
}

/// Writes a snapshot as a project. A mesh without a file is written beside it, as `NAME.source.EXT`.
///
/// # Errors
/// Where a file can't be written, or `cancel` is raised; an existing project is as it was then.
pub fn write(
    snapshot: &Snapshot,
    loaded: &Loaded,
    source: &MeshSource,
    path: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(), EngineError> {
    let geometry = geometry_hash(snapshot.model());
    let folder = files::folder_of(path);
    let mut beside = None;
    let mesh_path = match source {
        MeshSource::Sample => None,
        MeshSource::File(mesh) => Some(relative(mesh, folder)),
        MeshSource::Gone => {
            let kept = source_name(path, &loaded.path);
            if !kept.exists() {
                let at_rest = &loaded.model.rest_positions();
                beside = Some(saving::stage(loaded, &SaveAs::shape(at_rest, &kept), staging, progress, cancel)?.staged);
            }
            Some(file_name(&kept))
        }
    };
    let is_copy = *source == MeshSource::Gone;
    let project = snapshot.project(MeshReference {
        path: mesh_path,
        name: is_copy.then(|| file_name(&loaded.path)),
        geometry,
    });
    let staged = staging.stage([(path.to_owned(), project.to_json().as_bytes())])?;
    // The mesh first: the project must not be there without it.
    match beside {
        Some(mesh) => mesh.and(staged).commit()?,
        None => staged.commit()?,
    }
    Ok(())
}

/// The name that people know a project's mesh by; `None` if the project can't be read.
pub fn mesh_name(project: &Path) -> Option<String> {
    /// A project, as far as it tells that.
    #[derive(serde::Deserialize)]
    struct Named {
        mesh: MeshReference,
    }
    let text = files::read_text(project).ok()?;
    let Named { mesh } = serde_json::from_str(&text).ok()?;
    let of_path = |path: String| {
        let path = files::folder_of(project).join(path);
        file_name(&saved_name(&path).unwrap_or(path))
    };
    let name = mesh.name.or_else(|| mesh.path.map(of_path));
    Some(name.unwrap_or_else(|| SAMPLE_NAME.to_owned()))
}

/// Where a project keeps a mesh without a file; a `.gltf` is kept as a GLB.
fn source_name(project: &Path, mesh: &Path) -> PathBuf {
    let mut name = project.file_stem().unwrap_or_default().to_owned();
    name.push(".source.");
    let extension = mesh.extension().unwrap_or_default();
    name.push(if extension.eq_ignore_ascii_case("gltf") {
        "glb".as_ref()
    } else {
        extension
    });
    project.with_file_name(name)
}

/// The path as seen from `folder` where it stands below that, else whole.
fn relative(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(folder));
    let shown = path.strip_prefix(&folder).unwrap_or(&path);
    shown.to_string_lossy().replace('\\', "/")
}

/// A project, its mesh, and where that was found.
pub struct OpenedProject {
    /// What it says.
    pub project: Project,
    /// Its mesh.
    pub loaded: Loaded,
    /// Where that stands.
    pub source: MeshSource,
}

/// Reads a project and the mesh it belongs to: at its path, beside the project, or the kept original of either.
///
/// # Errors
/// A project that can't be read, or whose mesh is not to be found.
pub fn read(path: &Path, watch: &Watch) -> Result<OpenedProject, EngineError> {
    let text = files::read_text(path)?;
    let refuse = |source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    };
    let project = match Beginning::parse(&text).map_err(refuse)? {
        Beginning::Project(project) => *project,
        Beginning::Edit(_) => {
            return Err(refuse(pliant_editor::EditError::Project(
                "it names no `mesh`, so it is an edit: give it to `pliant apply --edit`".to_owned(),
            )));
        }
    };
    let weld = project.weld_options();
    let Some(named) = project.mesh().path.clone() else {
        let loaded = pliant_engine::load_bytes(CREATURE.to_vec(), Path::new(SAMPLE_NAME), &weld, watch)?;
        return if geometry_hash(&loaded.model) == project.mesh().geometry {
            Ok(OpenedProject {
                project,
                loaded,
                source: MeshSource::Sample,
            })
        } else {
            Err(EngineError::ProjectMesh {
                project: path.to_owned(),
                mesh: SAMPLE_NAME.into(),
                what: "another sample's",
            })
        };
    };
    let folder = files::folder_of(path);
    let at = folder.join(&named);
    let beside = folder.join(Path::new(&named).file_name().unwrap_or_default());
    let mut what = "missing";
    for mesh in [&at, &beside, &original_name(&at), &original_name(&beside)] {
        if !mesh.is_file() {
            continue;
        }
        let loaded = pliant_engine::load(mesh, &weld, watch)?;
        if geometry_hash(&loaded.model) == project.mesh().geometry {
            return Ok(OpenedProject {
                project,
                loaded,
                source: MeshSource::File(mesh.clone()),
            });
        }
        what = "another one now";
    }
    Err(EngineError::ProjectMesh {
        project: path.to_owned(),
        mesh: at,
        what,
    })
}
