//! glTF 2.0: the JSON and the buffers stay as read, and a save patches them.

use pliant_mesh::Drawn;

use crate::moved::Moved;
use crate::save::{Save, Saved};
use crate::scene::{Source, Summary};
use crate::{Appearance, Format, ReadError, SaveError};

#[derive(Debug)]
pub(crate) struct Stored {}

pub(crate) fn read(source: &Source<'_>, format: Format) -> Result<(Stored, Drawn), ReadError> {
    Err(source.malformed(format, "not read yet"))
}
impl Stored {
    pub fn notes(&self) -> &[String] {
        &[]
    }
    pub fn summary(&self) -> Summary {
        Summary::default()
    }
    pub fn appearance(&self) -> Appearance {
        Appearance::default()
    }
    pub fn save(&self, _save: &Save<'_>, _moved: &Moved<'_>) -> Result<Saved, SaveError> {
        Err(SaveError::TooLarge {
            format: Format::Glb,
        })
    }
}
