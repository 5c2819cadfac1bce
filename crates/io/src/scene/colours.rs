//! Saves other colours of vertices into a file.

use pliant_mesh::{Cancel, Progress};

use crate::convert::Parting;
use crate::save::colours::of_file as colours_of_file;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{Placement, Save, Saved};
use crate::scene::saving::with_neighbours;
use crate::scene::stored::{Scene, Stored};
use crate::{Appearance, Format, SaveError};

impl Scene {
    /// Returns true if a save in this format can have other colours of vertices: not STL, and not the file's own 3MF
    /// or USDZ, whose colours other data of the file may name, too.
    pub fn takes_colours(&self, format: Format) -> bool {
        let shares = matches!(format, Format::Threemf | Format::Usdz) && self.is_of_kind(format);
        format != Format::Stl && !shares
    }

    /// The file with other vertex colours: linear, from 0 to 65535, one for each drawn vertex. In the file's own format
    /// ([`Self::is_of_kind`]) only colours are added or replaced: `COLOR_0` in 16 bits in glTF, beside textures, sRGB
    /// bytes elsewhere. The shape then stays as in the file, so `save.positions` must be those at rest, and nothing may
    /// be turned.
    ///
    /// # Errors
    /// A wrong number of colours; a format without colours of vertices; [`SaveError::Cancelled`] soon after `cancel` is
    /// raised.
    pub fn save_with_colours(
        &self,
        save: &Save<'_>,
        colours: &[[u16; 4]],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Saved, SaveError> {
        let saved = self.coloured(save, colours, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    fn coloured(&self, save: &Save<'_>, colours: &[[u16; 4]], course: &Course<'_>) -> Result<Saved, SaveError> {
        course.reach(0, 1)?;
        let moved = Moved::of(save.drawn, save.positions, save.turned, save.format)?;
        let moves_patched = self.is_of_kind(save.format) && !moved.is_nothing();
        if colours.len() != save.drawn.positions.len() || moves_patched {
            return Err(SaveError::OtherScene {
                given: colours.len(),
                wanted: save.drawn.positions.len(),
            });
        }
        let of_file = || colours_of_file(save.drawn, colours);
        let (bytes, neighbours) = match (&self.stored, save.format) {
            (Stored::Gltf(stored), Format::Glb | Format::Gltf) => {
                return stored.save_with_colours(save, colours, course);
            }
            (_, Format::Stl) => return Err(SaveError::without_colours()),
            (Stored::Threemf(_), Format::Threemf) | (Stored::Usdz(_), Format::Usdz) => {
                return Err(SaveError::without_new_colours(save.format));
            }
            (Stored::Obj(stored), Format::Obj) => (stored.write_coloured(&of_file()), stored.neighbours()),
            (Stored::Ply(stored), Format::Ply) => (stored.write_coloured(&of_file())?, stored.neighbours()),
            (Stored::Off(stored), Format::Off) => (stored.write_coloured(&of_file()), (Vec::new(), Vec::new())),
            (_, format) => {
                let appearance = Appearance {
                    colours: Some(colours.to_vec()),
                    ..self.appearance()
                };
                return self.converted(&moved, appearance, save, (format, Parting::ByName), course);
            }
        };
        let saved = Saved::alone(save.name, bytes, Vec::new());
        Ok(match save.placement {
            Placement::OtherFolder => with_neighbours(saved, neighbours),
            Placement::SameFile | Placement::SameFolder => saved,
        })
    }
}
