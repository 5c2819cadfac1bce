//! What the rows of the timeline have keys of.

use pliant_editor::{Editor, Handle, KeyFrame, KeyId, KeyRow};

/// A row of keys.
#[derive(Clone, Copy)]
pub enum Row<'a> {
    /// All keys.
    All,
    /// Those of a handle.
    Handle(&'a Handle),
    /// Those of the share of the edit.
    Strength,
    /// Those of the weights of examples.
    Weights,
}

impl<'a> Row<'a> {
    /// Its name.
    pub fn name(self) -> &'a str {
        match self {
            Self::All => "All",
            Self::Handle(handle) => &handle.name,
            Self::Strength => "Strength",
            Self::Weights => "Weights",
        }
    }

    /// Its row of keys; `None` for that of all.
    pub fn of_keys(self) -> Option<KeyRow> {
        match self {
            Self::All => None,
            Self::Handle(handle) => Some(KeyRow::Handle(handle.id)),
            Self::Strength => Some(KeyRow::Strength),
            Self::Weights => Some(KeyRow::Weights),
        }
    }

    /// Its keys at the moment of `key`: those of handles that exist.
    pub fn keys_in(self, editor: &Editor, key: &KeyFrame) -> Vec<KeyId> {
        let exists = |row: &KeyRow| row.handle().is_none_or(|id| editor.document().handle(id).is_some());
        let is_own = |row: &KeyRow| self.of_keys().map_or_else(|| exists(row), |own| *row == own);
        key.rows().filter(is_own).map(|row| KeyId::new(row, key.time)).collect()
    }
}

/// The rows, from above.
pub fn rows_of(editor: &Editor) -> Vec<Row<'_>> {
    let handles = editor.view().handles.iter().filter(|handle| !handle.is_pin);
    let keys = editor.document().animation().keys();
    let has_weights = keys.iter().any(|key| key.weights().is_some());
    std::iter::once(Row::All)
        .chain(handles.map(Row::Handle))
        .chain(editor.document().animation().has_strength().then_some(Row::Strength))
        .chain(has_weights.then_some(Row::Weights))
        .collect()
}
