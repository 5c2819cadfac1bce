//! Footprints of handles of a sequence, which are held wherever they rest on the ground.

use glam::DVec3;

use super::footprint_work::Shapes;
use super::state::Workspace;
use crate::document::{HandleFootprints, HandleId, Paint};

/// Holds a handle wherever it rests on the ground, or no longer.
pub(crate) fn set_footprints(workspace: &mut Workspace, handle: HandleId, footprints: Option<HandleFootprints>) {
    workspace.step("Footprints", |workspace| {
        let animation = workspace.document.animation().with_footprints(handle, footprints);
        workspace.document.set_animation(animation);
        workspace.try_to_follow_again();
        workspace.pose_frame();
    });
}

impl Workspace {
    /// The number of footprints of a handle; `None` until the frames were followed.
    pub(crate) fn footprints_of(&self, handle: HandleId) -> Option<usize> {
        self.frames.footprints.count(handle)
    }

    /// The positions of the vertices of handles with footprints, where the surface is so far from the file's.
    pub(super) fn held_shapes(&self, way: &[DVec3]) -> Shapes {
        let file = self.model().map_or(&[][..], |model| &model.surface.positions);
        let footprints = self.document.animation().footprints();
        let mut shapes = Shapes::new();
        for ((paint, file), way) in self.document.paint().iter().zip(file).zip(way) {
            if let Paint::Handle(id) = paint
                && footprints.contains_key(id)
            {
                shapes.entry(*id).or_default().push(*file + *way);
            }
        }
        shapes
    }
}
