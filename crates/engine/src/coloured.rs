//! Saves other vertex colours together with another shape.
//!
//! Colours are patched into a file whose shape stays ([`Scene::save_with_colours`](pliant_io::Scene)). So the shape is
//! saved first, in memory, and the colours go into the file that this gives.

use std::path::Path;

use pliant_io::{Bytes, Format, OutputFile, Resolver, Save, SaveError, Saved, Scene, SceneAndDrawn};
use pliant_mesh::{Cancel, Drawn, Progress};

use crate::EngineError;
use crate::files::Neighbours;

/// The file that was read from `path`, with the shape of `save` and these colours of its drawn vertices.
///
/// # Errors
/// Those of a save, as `refused` words them.
pub(crate) fn save_with_colours(
    (path, scene): (&Path, &Scene),
    save: &Save<'_>,
    colours: &[[u16; 4]],
    refused: impl Fn(SaveError) -> EngineError,
    (progress, cancel): (&Progress, &Cancel),
) -> Result<Saved, EngineError> {
    let moves = save.positions != save.drawn.positions.as_slice() || save.turned.contains(&true);
    if !moves || !scene.is_of_kind(save.format) {
        let coloured = scene.save_with_colours(save, colours, progress, cancel);
        return coloured.map_err(&refused);
    }
    let (of_shape, of_reading) = (progress.part(0.0, 0.5), progress.part(0.5, 0.7));
    let shaped = scene.save(save, &of_shape, cancel).map_err(&refused)?;
    let neighbours = Neighbours::of(path);
    let beside = Beside(&shaped.files, &neighbours);
    let bytes = shaped.files.first().map(|file| file.bytes.clone()).unwrap_or_default();
    let back = pliant_io::read(bytes, save.format, save.name, &beside, &of_reading, cancel);
    let SceneAndDrawn { scene, drawn } = back?;
    let colours = carried(save, &drawn, colours);
    let again = Save {
        drawn: &drawn,
        positions: &drawn.positions,
        turned: &[],
        ..*save
    };
    let coloured = scene.save_with_colours(&again, &colours, &progress.part(0.7, 1.0), cancel);
    let coloured = coloured.map_err(refused)?;
    Ok(Saved {
        triangles: shaped.triangles.clone(),
        ..with_files_of(coloured, shaped)
    })
}

/// The formats of text in whose own files new colours keep every vertex.
const TEXT: [Format; 3] = [Format::Obj, Format::Ply, Format::Off];

/// Returns true if [`save_targets_with_colours`] can save this file.
pub(crate) fn targets_take_colours(scene: &Scene) -> bool {
    scene.is_of_kind(Format::Glb) || TEXT.into_iter().any(|format| scene.is_of_kind(format))
}

/// A file that was read from `path`, with morph targets and with these colours of its drawn vertices: the colours go into
/// the file at rest, in memory, and `targets` saves the file that this gives.
///
/// # Errors
/// Those of both saves, as `refused` words them.
pub(crate) fn save_targets_with_colours(
    (path, scene): (&Path, &Scene),
    save: &Save<'_>,
    colours: &[[u16; 4]],
    targets: impl FnOnce(&Scene, &Save<'_>, &Progress) -> Result<Saved, SaveError>,
    refused: impl Fn(SaveError) -> EngineError,
    (progress, cancel): (&Progress, &Cancel),
) -> Result<Saved, EngineError> {
    let own = TEXT.into_iter().find(|format| scene.is_of_kind(*format));
    let format = own.unwrap_or(save.format);
    let at_rest = Save {
        positions: &save.drawn.positions,
        turned: &[],
        format,
        ..*save
    };
    let coloured = scene.save_with_colours(&at_rest, colours, &progress.part(0.0, 0.3), cancel);
    let coloured = coloured.map_err(&refused)?;
    let neighbours = Neighbours::of(path);
    let beside = Beside(&coloured.files, &neighbours);
    let bytes = coloured
        .files
        .first()
        .map(|file| file.bytes.clone())
        .unwrap_or_default();
    let of_reading = progress.part(0.3, 0.5);
    let SceneAndDrawn { scene, drawn } = pliant_io::read(bytes, format, save.name, &beside, &of_reading, cancel)?;
    let with_targets = Save { drawn: &drawn, ..*save };
    let saved = targets(&scene, &with_targets, &progress.part(0.5, 1.0)).map_err(refused)?;
    match own {
        // The neighbours of a text file are in the glTF.
        Some(_) => Ok(saved),
        None => Ok(with_files_of(saved, coloured)),
    }
}

/// A save with the further files of the one before it, which it may still name, and with the warnings of both.
fn with_files_of(mut saved: Saved, before: Saved) -> Saved {
    let is_there = |file: &OutputFile| saved.files.iter().any(|own| own.name == file.name);
    let further: Vec<OutputFile> = before
        .files
        .into_iter()
        .skip(1)
        .filter(|file| !is_there(file))
        .collect();
    saved.files.extend(further);
    saved.warnings = before.warnings.into_iter().chain(saved.warnings).collect();
    saved
}

/// The colours on the drawn vertices of the saved shape. Faces that were turned may show a text file's vertices in
/// another order.
fn carried(save: &Save<'_>, drawn: &Drawn, colours: &[[u16; 4]]) -> Vec<[u16; 4]> {
    if matches!(save.format, Format::Glb | Format::Gltf) {
        return colours.to_vec();
    }
    let mut of_file = vec![[u16::MAX; 4]; save.drawn.file_vertex_count];
    for (vertex, colour) in save.drawn.file_vertex.iter().zip(colours) {
        of_file[vertex.0 as usize] = *colour;
    }
    let own = |vertex: u32| of_file.get(vertex as usize).copied().unwrap_or([u16::MAX; 4]);
    drawn.file_vertex.iter().map(|vertex| own(vertex.0)).collect()
}

/// The neighbours that the saved shape has, and those of the original.
struct Beside<'a>(&'a [OutputFile], &'a Neighbours);

impl Resolver for Beside<'_> {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        match self.0.iter().skip(1).find(|file| file.name == uri) {
            Some(file) => Ok(Bytes::from(file.bytes.clone())),
            None => self.1.read(uri),
        }
    }

    fn note_unread(&self, uri: &str) -> bool {
        self.1.note_unread(uri)
    }
}
