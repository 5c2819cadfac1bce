//! The status line: what the program is doing, and what one can do next.

use crate::document::Paint;
use crate::editor::Editor;
use crate::tool::{Tool, ToolMode};
use crate::{Counts, JobKind};

impl Editor {
    pub(crate) fn status(&self) -> String {
        let Some(model) = self.engine.model.as_ref() else {
            return "Open a mesh, or drop one here".to_owned();
        };
        if model.surface.triangles.is_empty() {
            return "This file holds no triangle: open another".to_owned();
        }
        let now = match &self.tool {
            Tool::Navigate(navigate) => format!("{}: Esc takes it back", navigate.status()),
            Tool::Paint(stroke) => format!("{}: Esc takes it back", self.painting(stroke.paint())),
            Tool::Stiffness(_) => "Painting stiffness: Esc takes it back".to_owned(),
            Tool::Outline(outline) => outline.status(),
            Tool::Widen(widen) => widen.status(self),
            Tool::Transform(drag) => drag.status(self),
            Tool::Idle | Tool::Adjust(_) => self.idle(),
        };
        let parts = [self.working(), self.descent(), Some(now)];
        parts.into_iter().flatten().collect::<Vec<_>>().join(" · ")
    }

    /// How far the shape's descent is, where its method takes steps.
    fn descent(&self) -> Option<String> {
        let descent = self.descent.filter(|_| self.document.is_displaced())?;
        let energy = format!("energy {:.3e}", descent.energy);
        Some(if descent.converged && self.document.settled {
            format!("Converged, {energy}")
        } else if descent.finished && self.document.settled {
            format!("Stopped at its limit of steps, {energy}")
        } else {
            format!("Settling, {energy}")
        })
    }

    fn painting(&self, paint: Paint) -> String {
        match paint {
            Paint::Bare => "Erasing".to_owned(),
            Paint::Fixed => "Painting what is held still".to_owned(),
            Paint::Free => "Painting what may bend".to_owned(),
            Paint::Handle(id) => {
                format!(
                    "Painting {}",
                    self.document
                        .handle(id)
                        .map_or("a handle", |handle| handle.name.as_str())
                )
            }
        }
    }

    /// What can be done while nothing is going on.
    fn idle(&self) -> String {
        let hint = if self.document.handles.is_empty() {
            match self.mode {
                ToolMode::PaintHandle => "Paint what you want to move",
                ToolMode::PaintFree => "Paint what may bend, then a handle (1)",
                ToolMode::PaintFixed => "Paint what is held still, then a handle (1)",
                ToolMode::Erase | ToolMode::Select | ToolMode::PaintStiffness => {
                    "Press 1 and paint what you want to move"
                }
            }
        } else if self.wants_pivot {
            "Click the point that the handle turns about"
        } else if self.wants_new_handle {
            "Paint the new handle"
        } else if self.selected.is_none() {
            "Press Tab to select a handle, or paint a new one"
        } else if self.document.is_displaced() {
            "Drag the gizmo, paint on from this shape, or save"
        } else {
            "Drag the gizmo, or press G, R or S to move, turn or scale"
        };
        let Counts { fixed, free, handle } = self.engine.region.counts;
        let [handle, free, fixed] = [handle, free, fixed].map(thousands);
        format!("{hint} · {handle} handle, {free} free, {fixed} fixed vertices")
    }

    /// What is computed in the background, as far as somebody waits for it.
    fn working(&self) -> Option<String> {
        let given_up = [JobKind::Order, JobKind::Region, JobKind::Bind]
            .into_iter()
            .any(|kind| self.engine.has_given_up(kind));
        if given_up && !self.document.handles.is_empty() {
            return Some("Nothing is bound: handles move alone until the regions change".to_owned());
        }
        let (kind, fraction) = self.engine.running().into_iter().rfind(|(kind, _)| match kind {
            JobKind::Solve => false,
            JobKind::Pick => self.engine.pickable.is_none(),
            JobKind::Order => !self.document.handles.is_empty(),
            JobKind::Region | JobKind::Bind | JobKind::Mirror | JobKind::Enclose => true,
        })?;
        let doing = kind.doing();
        let waits = matches!(self.tool, Tool::Transform(_)) || !self.document.settled;
        let doing = if waits && kind != JobKind::Pick {
            format!("{doing}, the surface will catch up")
        } else {
            doing.to_owned()
        };
        Some(if fraction > 0.0 {
            format!("{doing} {:.0}%", fraction * 100.0)
        } else {
            doing
        })
    }
}

/// A count with its thousands apart: 48 485.
pub fn thousands(count: usize) -> String {
    let digits = count.to_string();
    let mut spaced = String::with_capacity(digits.len() + digits.len() / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            spaced.push('\u{202f}');
        }
        spaced.push(digit);
    }
    spaced
}
