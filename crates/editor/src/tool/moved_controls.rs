//! Control points that a transform moves: their positions at its beginning, and their new positions.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Attachment;

use crate::workspace::{Workspace, middle, put_attachment};

/// The selected points of the method's cage or lattice.
#[derive(Debug)]
pub(super) struct MovedControls {
    name: &'static str,
    /// The attachment at the beginning of the transform; the first move makes it the document's.
    attachment: Attachment,
    /// The points, and their visible positions.
    points: Vec<(u32, DVec3)>,
}

impl MovedControls {
    /// The selected points; `None` if there are none.
    pub(super) fn of_selected(workspace: &Workspace) -> Option<Self> {
        if workspace.controls.is_empty() {
            return None;
        }
        let shown = workspace.shown_controls()?;
        let seen = |point: u32| shown.positions.get(point as usize).map(|position| (point, *position));
        let points: Vec<(u32, DVec3)> = workspace
            .controls
            .points()
            .iter()
            .filter_map(|&point| seen(point))
            .collect();
        (!points.is_empty()).then_some(Self {
            name: shown.name,
            attachment: shown.attachment,
            points,
        })
    }

    /// Their name in the history.
    pub(super) fn designation(&self) -> String {
        match self.points.as_slice() {
            [(point, _)] => format!("point {point} of the {}", self.name),
            points => format!("{} points of the {}", points.len(), self.name),
        }
    }

    /// The middle of their visible positions at the beginning.
    pub(super) fn centre(&self) -> DVec3 {
        middle(self.points.iter().map(|(_, seen)| *seen))
    }

    /// The middle of their present visible positions.
    pub(super) fn centre_now(&self, workspace: &Workspace) -> Option<DVec3> {
        let shown = workspace.shown_controls()?;
        let seen: Option<Vec<DVec3>> = self
            .points
            .iter()
            .map(|(point, _)| shown.positions.get(*point as usize).copied())
            .collect();
        Some(middle(seen?.into_iter()))
    }

    /// Moves each point by the displacement of its visible position.
    pub(super) fn put(&self, workspace: &mut Workspace, way: impl Fn(DVec3) -> DVec3) {
        let mut moved = self.attachment.moved().map_or_else(Vec::new, |moved| moved.to_vec());
        for (point, seen) in &self.points {
            moved[*point as usize] += way(*seen);
        }
        if moved.iter().any(|point| !point.is_finite()) {
            return;
        }
        workspace.refusal = None;
        let attachment = self.attachment.with_moved(Arc::new(moved));
        put_attachment(&mut workspace.document, self.name, attachment);
    }
}
