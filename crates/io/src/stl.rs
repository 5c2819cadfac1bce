//! Placeholder of the STL room, replaced by its owner.

use pliant_mesh::Drawn;

use crate::moved::Moved;
use crate::new_mesh::NewMesh;
use crate::save::Saved;
use crate::scene::{Source, Summary};
use crate::{Appearance, Format, ReadError, SaveError};

#[derive(Debug)]
pub(crate) struct Stored {}

pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    Err(source.malformed(Format::Stl, "not read yet"))
}

pub(crate) fn write_new(_mesh: &NewMesh<'_>) -> Result<Saved, SaveError> {
    Err(SaveError::TooLarge {
        format: Format::Stl,
    })
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
    pub fn write(&self, _moved: &Moved<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        Ok((Vec::new(), Vec::new()))
    }
}
