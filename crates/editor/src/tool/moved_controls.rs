//! Control points that a transform moves: where they were when it began, and how they are put.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Attachment;

use crate::workspace::{Workspace, middle, put_attachment};

/// The selected points of the method's cage or lattice.
#[derive(Debug)]
pub(super) struct MovedControls {
    name: &'static str,
    /// As it was when the transform began; the first move makes it the document's.
    attachment: Attachment,
    /// The points, and where they were seen.
    points: Vec<(u32, DVec3)>,
}

impl MovedControls {
    /// `None` if no point is selected.
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

    /// As the history calls them.
    pub(super) fn designation(&self) -> String {
        match self.points.as_slice() {
            [(point, _)] => format!("point {point} of the {}", self.name),
            points => format!("{} points of the {}", points.len(), self.name),
        }
    }

    /// The middle of where they were seen.
    pub(super) fn centre(&self) -> DVec3 {
        middle(self.points.iter().map(|(_, seen)| *seen))
    }

    /// The middle of where they are seen now.
    pub(super) fn centre_now(&self, workspace: &Workspace) -> Option<DVec3> {
        let shown = workspace.shown_controls()?;
        let seen: Option<Vec<DVec3>> = self
            .points
            .iter()
            .map(|(point, _)| shown.positions.get(*point as usize).copied())
            .collect();
        Some(middle(seen?.into_iter()))
    }

    /// Puts each point beside where it was by the way of where it was seen.
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
