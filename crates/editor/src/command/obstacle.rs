//! When each command can be done, and what stands in its way where it can't.

use std::borrow::Cow;

use crate::command::Command;
use crate::document::{Handle, Paint};
use crate::editor::Editor;
use crate::tool::Tool;

/// Why a command can't be done now, as a sentence with the remedy where there is one.
type Obstacle = Cow<'static, str>;

const NOTHING_OPEN: &str = "Nothing is open: open a file first.";
const NO_HANDLE_SELECTED: &str = "No handle is selected: select one in the list, or paint one.";
const HANDLE_GONE: &str = "That handle is not there any more.";

impl Editor {
    /// Whether the command would do anything now.
    pub fn is_enabled(&self, command: &Command) -> bool {
        self.obstacle(command).is_none()
    }

    /// Whether a tool is in the middle of something that Esc ends: a stroke, a drag, a pivot to be picked.
    pub fn is_acting(&self) -> bool {
        !matches!(self.tool, Tool::Idle) || self.wants_pivot
    }

    /// What stands in the way of a command; `None` where it can be done.
    pub fn obstacle(&self, command: &Command) -> Option<Obstacle> {
        let selected = self.selected.and_then(|id| self.document.handle(id));
        match command {
            Command::Undo => unless(
                self.history.undo_name().is_some(),
                "Nothing was done that could be taken back.",
            ),
            Command::Redo => unless(
                self.history.redo_name().is_some(),
                "Nothing was taken back that could be done again.",
            ),
            Command::GoToStep(steps) => unless(
                *steps <= self.history.names().0.len(),
                "The history has no such step any more.",
            ),
            Command::Region(_) => self.region_obstacle(),
            Command::ClearStiffness => unless(self.document.stiffness.is_some(), "No stiffness is painted."),
            Command::DuplicateHandle
            | Command::PickPivot
            | Command::Widen
            | Command::ResetRegion
            | Command::DeleteHandle => unlocked(selected).err(),
            Command::MakeTwin(_) => match unlocked(selected) {
                Err(obstacle) => Some(obstacle),
                Ok(handle) if handle.twin.is_some() => {
                    Some(format!("{} has a twin already: part them first.", handle.name).into())
                }
                Ok(_) => None,
            },
            Command::Untwin => match selected {
                None => Some(NO_HANDLE_SELECTED.into()),
                Some(handle) if handle.twin.is_none() => Some(format!("{} has no twin.", handle.name).into()),
                Some(_) => None,
            },
            Command::Deselect | Command::Move | Command::Turn | Command::Scale => {
                unless(selected.is_some(), NO_HANDLE_SELECTED)
            }
            Command::ResetHandle => match selected {
                None => Some(NO_HANDLE_SELECTED.into()),
                Some(handle) if !handle.is_displaced() => {
                    Some(format!("{} stands where it was painted.", handle.name).into())
                }
                Some(_) => None,
            },
            Command::NextHandle => unless(
                !self.document.handles.is_empty(),
                "There is no handle yet: paint one on the surface.",
            ),
            Command::ToggleSelected(id)
            | Command::SetHandleColour(id, _)
            | Command::ToggleHandleVisible(id)
            | Command::ToggleHandleLocked(id)
            | Command::SetPivotPlace(id, _)
            | Command::SetPivot(id, _)
            | Command::SelectHandle(id)
            | Command::RenameHandle(id, _)
            | Command::SetHandleTransform(id, _)
            | Command::SetTurn(id, _)
            | Command::SetReach(id, _)
            | Command::SetContinuity(id, _)
            | Command::SetSoft(id, _) => unless(self.document.handle(*id).is_some(), HANDLE_GONE),
            Command::Apply => unless(
                self.document.is_displaced(),
                "Nothing is bent that could be applied: move a handle first.",
            ),
            Command::ResetShape => unless(
                self.document.is_displaced() || self.document.applied,
                "The shape is as in the file already.",
            ),
            Command::ClearRegions => unless(
                self.document.paint.iter().any(|paint| *paint != Paint::Bare),
                "Nothing is painted.",
            ),
            Command::CancelJobs => {
                let mut running = self.engine.running().into_iter();
                let is_any = running.any(|(kind, _)| kind != crate::JobKind::Pick);
                unless(is_any, "Nothing is under way.")
            }
            Command::ShowEverything => unless(!self.document.access.shows_all(), "Nothing is hidden."),
            Command::NewHandle
            | Command::Objects(..)
            | Command::ObjectHere(_)
            | Command::Isolate
            | Command::SetMethod(_)
            | Command::SetLoose(_)
            | Command::SetLoosePart(..)
            | Command::FramePart(_)
            | Command::SetStiffness(_)
            | Command::FrameAll
            | Command::FrameSelected
            | Command::FrameFileVertex(_) => self.unopened(),
            Command::CameraBack => unless(
                !self.camera_history.behind.is_empty(),
                "The view was nowhere else before.",
            ),
            Command::CameraForth => unless(
                !self.camera_history.ahead.is_empty(),
                "The view was not taken back anywhere.",
            ),
            Command::SetTool(_)
            | Command::SetBrushRadius(_)
            | Command::GrowBrush
            | Command::ShrinkBrush
            | Command::View(_)
            | Command::SetUp(_)
            | Command::SetShading(_)
            | Command::SetClay(_)
            | Command::ToggleFlat
            | Command::ToggleWireframe
            | Command::ToggleBorders
            | Command::ToggleOutlines
            | Command::ToggleRegions
            | Command::SetOrientation(_)
            | Command::SetStrokeShape(_)
            | Command::SetDepth(_)
            | Command::SetBrushMetric(_)
            | Command::SetStiffnessBrush(_)
            | Command::ToggleGrid
            | Command::ToggleProjection
            | Command::SetOrbit(_)
            | Command::StepView(_)
            | Command::TurnAround
            | Command::SetGizmo(_) => None,
        }
    }

    /// What stands in the way of doing something to the region in hand.
    fn region_obstacle(&self) -> Option<Obstacle> {
        match self.role_in_hand() {
            None => Some("No region is in hand: select a handle, or take the brush of what is free or fixed.".into()),
            Some(Paint::Handle(id)) => unlocked(self.document.handle(id)).err(),
            Some(_) => self.unopened(),
        }
    }

    fn unopened(&self) -> Option<Obstacle> {
        unless(self.engine.model.is_some(), NOTHING_OPEN)
    }
}

/// The obstacle, unless it can be done.
fn unless(can_be_done: bool, obstacle: &'static str) -> Option<Obstacle> {
    (!can_be_done).then_some(Cow::Borrowed(obstacle))
}

/// The selected handle, if it may be changed.
fn unlocked(selected: Option<&Handle>) -> Result<&Handle, Obstacle> {
    match selected {
        None => Err(NO_HANDLE_SELECTED.into()),
        Some(handle) if handle.locked => Err(format!("{} is locked: unlock it in the list first.", handle.name).into()),
        Some(handle) => Ok(handle),
    }
}
