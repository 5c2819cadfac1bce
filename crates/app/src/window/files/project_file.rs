//! A project as a file: finds its mesh again, and keeps the mesh that it needs.

use std::path::{Path, PathBuf};

use pliant_editor::{Beginning, MeshReference, Project, Snapshot, geometry_hash};
use pliant_mesh::{Cancel, Progress};

use super::rest_mesh::{Check, MeshSource, RestMesh, load_sample};
use crate::files::names::{SAMPLE_NAME, file_name, original_names, saved_name, source_names, sources_of};
use crate::files::original::{Kept, free_or_same};
use pliant_engine::files::{self, Staged, Staging, Stamp};
use pliant_engine::flow::colour_hash;
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded};

/// Writes a snapshot as a project. A mesh without a file, or whose file is another one now, is written beside it, under
/// one of the [`source_names`], so that every project that exists can be opened.
///
/// # Errors
/// If a file can't be written, or `cancel` is raised; an existing project is then unchanged.
pub fn stage(
    snapshot: &Snapshot,
    mesh: &RestMesh,
    path: &Path,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<StagedProject, EngineError> {
    let (mesh_path, beside) = match &mesh.source {
        MeshSource::Sample => (None, None),
        MeshSource::File(file) if mesh.is_in(file, Stamp::is_current) => {
            (Some(relative(file, files::folder_of(path))), None)
        }
        MeshSource::File(_) | MeshSource::Gone => {
            let (kept, staged) = stage_mesh(mesh, path, Stamp::is_current, staging, progress, cancel)?;
            (
                Some(files::name_as_text(kept.file_name().unwrap_or_default())),
                Some((kept, staged)),
            )
        }
    };
    let name = beside.is_some().then(|| file_name(&mesh.loaded.path));
    assembled(snapshot, mesh, (mesh_path, name), beside, path, staging)
}

/// A project that names its mesh by a path and, if that is not its own name, by the name that people know.
fn assembled(
    snapshot: &Snapshot,
    mesh: &RestMesh,
    (mesh_path, name): (Option<String>, Option<String>),
    beside: Option<(PathBuf, Option<Staged>)>,
    path: &Path,
    staging: &Staging,
) -> Result<StagedProject, EngineError> {
    let project = snapshot.project(MeshReference {
        path: mesh_path,
        name,
        geometry: geometry_hash(snapshot.model()),
    });
    // Kept dye lies over the mesh's own colours, so it must not come upon a file that has it already.
    let project = match snapshot.kept_dye() {
        Some(_) => project.over_colours(colour_hash(&mesh.loaded)),
        None => project,
    };
    let sequence = mesh.sequence.as_ref();
    let mixed = project
        .mixed_sequence()
        .map(|named| relative(Path::new(named), files::folder_of(path)));
    let project = match mixed {
        Some(mixed) => project.mixed_with(mixed),
        None => project,
    };
    let project = project.of_sequence(sequence.map(|place| relative(place, files::folder_of(path))));
    let project = match mesh.has_own_key_times {
        true => project.with_own_key_times(),
        false => project,
    };
    let staged = staging.stage([(path.to_owned(), project.to_json().as_bytes())])?;
    let (kept, staged_mesh) = beside.unzip();
    Ok(StagedProject {
        // The mesh comes first: the project must not exist without it.
        staged: match staged_mesh.flatten() {
            Some(staged_mesh) => staged_mesh.and(staged),
            None => staged,
        },
        kept,
    })
}

/// Writes a snapshot as a project that only its owner may read, always with the mesh beside it. `model` is the open
/// file; the project names it if possible, for the person who opens the project.
///
/// # Errors
/// If a file can't be written; an existing project is then unchanged.
pub fn write_with_mesh(
    snapshot: &Snapshot,
    mesh: &RestMesh,
    model: Option<&Path>,
    path: &Path,
) -> Result<(), EngineError> {
    let (staging, progress, cancel) = (Staging::private(), Progress::new(), Cancel::new());
    let beside = match mesh.source {
        MeshSource::Sample => None,
        MeshSource::File(_) | MeshSource::Gone => {
            let check = Stamp::looks_current;
            Some(stage_mesh(mesh, path, check, &staging, &progress, &cancel)?)
        }
    };
    let kept = beside.as_ref().map(|(kept, _)| &**kept);
    let stands_at = kept.map(|kept| relative(model.unwrap_or(kept), files::folder_of(path)));
    // If the model has a file, its path says which.
    let name = (beside.is_some() && model.is_none()).then(|| file_name(&mesh.loaded.path));
    let StagedProject { staged, kept } = assembled(snapshot, mesh, (stands_at, name), beside, path, &staging)?;
    staged.commit()?;
    if let Some(kept) = kept {
        mesh.note_copy(&kept, Stamp::of(&kept)?);
    }
    Ok(())
}

/// A project that is ready to be committed.
pub struct StagedProject {
    /// Its files.
    pub staged: Staged,
    /// The file beside it that holds its mesh, if it needs one.
    pub kept: Option<PathBuf>,
}

/// Stages the mesh at rest beside a project, unless it is already there. Returns its path, too.
pub fn stage_mesh(
    mesh: &RestMesh,
    project: &Path,
    check: Check,
    staging: &Staging,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<(PathBuf, Option<Staged>), EngineError> {
    let names = || source_names(project, &mesh.loaded.path);
    if let Some(known) = names()
        .take_while(|name| name.exists())
        .find(|name| mesh.is_in(name, check))
    {
        return Ok((known, None));
    }
    let first = names().next().unwrap_or_default();
    let bytes = saving::bytes_at_rest(&mesh.loaded, &first, progress, cancel)?;
    match free_or_same(names(), &bytes)? {
        Kept::Under(kept) => {
            let at_rest = &mesh.loaded.model.rest_positions();
            let save = SaveAs::shape(at_rest, &kept);
            let staged = saving::stage(&mesh.loaded, &save, staging, progress, cancel)?.staged;
            Ok((kept, Some(staged)))
        }
        Kept::Already(kept) => Ok((kept, None)),
        Kept::Nothing => Ok((first, None)),
    }
}

/// The name by which people know a project's mesh; `None` if the project can't be read.
pub fn mesh_name(project: &Path) -> Option<String> {
    /// The parts of a project that have the name.
    #[derive(serde::Deserialize)]
    struct Named {
        mesh: MeshReference,
    }
    let text = files::read_text(project).ok()?;
    let Named { mesh } = serde_json::from_str(&text).ok()?;
    let of_path = |path: String| {
        let path = files::path_of_text(files::folder_of(project), &path);
        file_name(&saved_name(&path).unwrap_or(path))
    };
    let name = mesh.name.or_else(|| mesh.path.map(of_path));
    Some(name.unwrap_or_else(|| SAMPLE_NAME.to_owned()))
}

/// The path relative to `folder` if it is inside it, otherwise absolute; with `/` between folders, and names that are
/// not UTF-8 in the form of [`files::name_as_text`].
pub(super) fn relative(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(folder));
    files::path_as_text(path.strip_prefix(&folder).unwrap_or(&path))
}

/// A project, its mesh, and the mesh's path.
pub struct OpenedProject {
    /// The contents of the project.
    pub project: Project,
    /// Its mesh.
    pub loaded: Loaded,
    /// The mesh's path.
    pub source: MeshSource,
    /// The place of the sequence of whose frames the mesh is one.
    pub sequence: Option<PathBuf>,
    /// The mesh's path in the project; empty for the sample.
    pub named: PathBuf,
    /// The project's file as it was read.
    pub stamp: Stamp,
}

/// Reads a project and the mesh it belongs to: at its path, beside the project, or the kept original of either.
///
/// # Errors
/// A project that can't be read, or whose mesh is missing.
pub fn read(path: &Path, watch: &Watch) -> Result<OpenedProject, EngineError> {
    let (text, stamp) = files::read_text_stamped(path)?;
    let refuse = |source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    };
    let project = match Beginning::parse(&text).map_err(refuse)? {
        Beginning::Project(project) => *project,
        Beginning::Edit(_) | Beginning::Sequence(_) => {
            return Err(refuse(pliant_editor::EditError::Project(
                "it names no `mesh`, so it is an edit: give it to `pliant apply --edit`".to_owned(),
            )));
        }
    };
    let weld = project.weld_options();
    let Some(named) = project.mesh().path.clone() else {
        let loaded = load_sample(&weld, watch)?;
        return if geometry_hash(&loaded.model) == project.mesh().geometry {
            Ok(OpenedProject {
                project,
                loaded,
                source: MeshSource::Sample,
                sequence: None,
                named: PathBuf::new(),
                stamp,
            })
        } else {
            Err(EngineError::ProjectMesh {
                project: path.to_owned(),
                mesh: SAMPLE_NAME.into(),
                what: "from another sample",
            })
        };
    };
    let folder = files::folder_of(path);
    let sequence = project.sequence().map(|named| files::path_of_text(folder, named));
    let mixed = project.mixed_sequence().map(|named| files::path_of_text(folder, named));
    let project = match mixed {
        Some(mixed) => project.mixed_with(files::path_as_text(&mixed)),
        None => project,
    };
    let at = files::path_of_text(folder, &named);
    let beside = folder.join(at.file_name().unwrap_or_default());
    let (mut what, mut found) = ("missing", None);
    let places = [&at, &beside].into_iter().cloned();
    let originals = original_names(&at).chain(original_names(&beside));
    let places = places.chain(originals).chain(sources_of(path));
    for mesh in places.filter(|place| place.is_file()) {
        let loaded = match pliant_engine::load(&mesh, &weld, watch) {
            Ok(loaded) => loaded,
            Err(EngineError::Interrupted) => return Err(EngineError::Interrupted),
            // The path now has something else, which may not be a mesh.
            Err(_) => {
                what = "a different mesh now";
                continue;
            }
        };
        if geometry_hash(&loaded.model) != project.mesh().geometry {
            what = "a different mesh now";
        } else if project
            .mesh_colours()
            .is_none_or(|colours| colours == colour_hash(&loaded))
        {
            found = Some((loaded, mesh));
            break;
        } else {
            // A file with other colours may have the kept dye in them already: the original is better.
            found.get_or_insert((loaded, mesh));
        }
    }
    if let Some((loaded, mesh)) = found {
        return Ok(OpenedProject {
            project,
            loaded,
            source: MeshSource::File(mesh),
            sequence,
            named: at.clone(),
            stamp,
        });
    }
    Err(EngineError::ProjectMesh {
        project: path.to_owned(),
        mesh: at,
        what,
    })
}
