//! The differences of two files, in words.

use pliant_mesh::{Cancel, Drawn, Progress};

use crate::difference::{self, Difference};
use crate::scene::pose::has_same_faces;
use crate::scene::stored::{Scene, Stored};
use crate::{Format, MorphDeltas, Placement, Save};

impl Scene {
    /// The differences between this file and another, given the drawn set that [`crate::read`] returned with each; empty if
    /// their contents are the same. Two glTF files are compared part by part, for any containers and any places of
    /// their numbers. Other files are compared by the shapes that they show, and two of the same format also by whether
    /// anything besides the shape differs.
    pub fn differences(&self, drawn: &Drawn, other: &Self, other_drawn: &Drawn) -> Vec<Difference> {
        if self.format == other.format
            && self.bytes == other.bytes
            && !matches!(self.format, Format::Gltf | Format::Obj)
        {
            return Vec::new();
        }
        if let (Stored::Gltf(a), Stored::Gltf(b)) = (&self.stored, &other.stored) {
            return a.differences(b);
        }
        let shown = |scene: &Self| (scene.appearance(), scene.summary());
        let are_faces_alike = has_same_faces((self, drawn), (other, other_drawn));
        let mut out = difference::of_shapes((drawn, &shown(self).0), (other_drawn, &shown(other).0), are_faces_alike);
        // An STL's normals follow from its shape, but were rounded from more digits than the file keeps.
        let is_comparable = self.format == other.format && self.format != Format::Stl;
        if is_comparable && drawn.positions.len() == other_drawn.positions.len() {
            // If nothing else differs, this file saved with the other's shape is the other file.
            let save = Save {
                drawn,
                positions: &other_drawn.positions,
                deltas: MorphDeltas::WhereFarOff,
                turned: &[],
                format: self.format,
                name: "same",
                placement: Placement::SameFolder,
            };
            if let Ok(saved) = self.save(&save, &Progress::new(), &Cancel::new()) {
                out.extend(difference::of_bytes(&saved.files[0].bytes, &other.bytes));
            }
        }
        out
    }
}
