//! Renames a neighbour before a save writes it.

use crate::save::{Role, Saved};
use crate::{Format, SaveError, gltf, obj, ply, quoted};

impl Saved {
    /// Renames the neighbour at index `place` of the files to `name`, and replaces its name in the files that refer to
    /// it.
    ///
    /// # Errors
    /// [`SaveError::CannotHold`] if a file refers to it in a way that can't be distinguished from other references.
    pub fn rename(&mut self, place: usize, name: &str, format: Format) -> Result<(), SaveError> {
        let old = self.files[place].name.clone();
        let is_named = match self.files[place].role {
            Role::Library => {
                let new = obj::library_renamed(&self.files[0].bytes, &old, name);
                new.map(|bytes| self.files[0].bytes = bytes).is_some()
            }
            Role::Image if format == Format::Obj => {
                let mut is_named = false;
                let libraries = self.files.iter_mut().filter(|file| file.role == Role::Library);
                for library in libraries {
                    if let Some(bytes) = obj::texture_renamed(&library.bytes, &library.name, &old, name) {
                        library.bytes = bytes;
                        is_named = true;
                    }
                }
                is_named
            }
            Role::Image if format == Format::Ply => {
                let new = ply::texture_renamed(&self.files[0].bytes, &old, name);
                new.map(|bytes| self.files[0].bytes = bytes).is_some()
            }
            Role::Out | Role::Buffer | Role::Image => {
                let new = gltf::with_neighbours_renamed(&self.files[0].bytes, &[(&old, name.to_owned())]);
                new.map(|bytes| self.files[0].bytes = bytes).is_some()
            }
        };
        if !is_named {
            return Err(SaveError::CannotHold {
                what: format!("{}, whose name is taken there,", quoted(&old)),
                format,
                remedy: "choose another folder".to_owned(),
            });
        }
        name.clone_into(&mut self.files[place].name);
        Ok(())
    }
}
