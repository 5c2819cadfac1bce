//! What a new file can't keep of the file that was read, in sentences.

use crate::Format;
use crate::convert::faces::{lost, lost_where};
use crate::gltf::unread::MaterialsKept;
use crate::scene::stored::{Scene, Stored};

impl Scene {
    /// Sentences about the data of this file that a new file of the format can't have when vertices and triangles
    /// differ from the file's: skins, animations, morph targets, data that only this file's format names. The file is
    /// made with [`Self::appearance_with_originals`]; `has_own_names` says whether an OBJ keeps its libraries.
    pub fn lost_in_new_shape(&self, format: Format, has_own_names: bool) -> Vec<String> {
        let summary = self.summary();
        let motion = [
            ("skins", summary.skins > 0),
            ("animations", summary.animations > 0),
            ("morph targets", summary.morph_targets > 0),
        ];
        let motion: Vec<&str> = motion.iter().filter(|(_, has)| *has).map(|(name, _)| *name).collect();
        let motion = (!motion.is_empty()).then(|| {
            let list = motion.join(" and ");
            format!("A new shape can't keep the file's {list}, which belong to its old vertices.")
        });
        let unread = match &self.stored {
            Stored::Gltf(stored) => {
                let kept = match format {
                    Format::Glb | Format::Gltf => MaterialsKept::AsWritten,
                    _ => MaterialsKept::AsDrawn,
                };
                let list = stored.unread(kept);
                let own = self.format.extension();
                let sentence = || {
                    format!(
                        "The new shape leaves out {}: keep the .{own} for them.",
                        list.join(", ")
                    )
                };
                (!list.is_empty()).then(sentence)
            }
            _ => self.unread_lost(format),
        };
        let materials = match &self.stored {
            Stored::Obj(stored) if !has_own_names => stored.materials_lost(&format.to_string()),
            _ => None,
        };
        let smoothing = match &self.stored {
            Stored::Obj(stored) if !has_own_names => stored.smoothing_lost(),
            _ => None,
        };
        [motion, unread, materials, smoothing].into_iter().flatten().collect()
    }

    /// A warning about parts of the file that other formats do not get.
    pub(super) fn unread_lost(&self, format: Format) -> Option<String> {
        let unread = match &self.stored {
            Stored::Ply(stored) => stored.unread(),
            Stored::Stl(stored) => stored.unread(),
            Stored::Off(stored) => stored.unread(),
            Stored::Gltf(_) | Stored::Obj(_) | Stored::Threemf(_) | Stored::Usdz(_) => Vec::new(),
        };
        let own = self.format.extension();
        (!unread.is_empty()).then(|| {
            format!(
                "{format} output leaves out {}: keep the .{own} for them.",
                unread.join(", ")
            )
        })
    }

    /// A warning about skins, animations and morph targets, which only glTF holds.
    pub(super) fn motion_lost(&self, format: Format) -> Option<String> {
        let summary = self.summary();
        let motion = [
            ("skins", lost_where(summary.skins > 0)),
            ("animations", lost_where(summary.animations > 0)),
            ("morph targets", lost_where(summary.morph_targets > 0)),
        ];
        lost(&format.to_string(), &motion)
    }
}
