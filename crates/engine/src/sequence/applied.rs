//! An edit from a file on an open sequence.

use std::collections::BTreeMap;
use std::path::Path;

use pliant_editor::{EditFile, HandlePlace, SequenceEdit};

use super::bend::{place, vertices_of_handles};
use super::open::OpenSequence;
use super::side_by_side::side_by_side;
use crate::EngineError;
use crate::files;
use crate::watch::Watch;

impl OpenSequence {
    /// The edit of a file at `edit_path` on this sequence. The frames that have keys are read for the places of handles,
    /// and one frame of the sequence that leads some.
    ///
    /// # Errors
    /// Those of [`EditFile::frames_with_places`] and [`SequenceEdit::of`]; another sequence that does not fit; a frame that
    /// can't be read; [`EngineError::Interrupted`].
    pub fn applied(&self, edit: &EditFile, edit_path: &Path, watch: &Watch) -> Result<SequenceEdit, EngineError> {
        let in_edit = |source| EngineError::Edit {
            edit: edit_path.to_owned(),
            source,
        };
        edit.frames_with_places(self.count()).map_err(in_edit)?;
        let model = &self.mesh().model;
        let setup = edit.resolve(model).map_err(in_edit)?;
        let handles = vertices_of_handles(&setup);
        let first = &model.surface.positions;
        let mut frames: Vec<usize> = edit
            .keys
            .iter()
            .filter_map(|key| key.frame)
            .map(|frame| frame as usize)
            .collect();
        frames.sort_unstable();
        frames.dedup();
        let places = |frame: usize| -> Result<Vec<HandlePlace>, EngineError> {
            let positions = self.positions(frame, watch)?;
            Ok(handles
                .iter()
                .map(|vertices| place(vertices, first, &positions))
                .collect())
        };
        let read = side_by_side(&frames, places, watch)?;
        let known: BTreeMap<usize, Vec<HandlePlace>> = frames.into_iter().zip(read).collect();
        let rest: Vec<HandlePlace> = handles.iter().map(|vertices| place(vertices, first, first)).collect();
        let mut edit = edit.clone();
        if let Some(mix) = &mut edit.mix {
            let path = files::path_of_text(files::folder_of(edit_path), &mix.sequence);
            self.other(&path)?.positions(0, watch)?;
            mix.sequence = files::path_as_text(&path);
        }
        let place_in = |frame: usize, handle: usize| known[&frame][handle];
        SequenceEdit::of(&edit, &setup, &rest, place_in).map_err(in_edit)
    }
}
