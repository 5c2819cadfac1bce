//! A stroke of the brush: handle, region, fixed or nothing, from button down to button up.
//!
//! No stroke moves a drawn vertex: the first vertex that changes while something is displaced makes the present shape
//! the rest shape, within the same step.

use glam::{DVec2, DVec3};
use pliant_mesh::SurfaceVertex;

use super::context::Context;
use super::mode::ToolMode;
use super::other_side::OtherSide;
use super::settings::ToolSettings;
use super::stroke::{Stroke, StrokeGesture, meet};
use crate::document::{Document, HandleId, HandleLine, Paint, Reach};
use crate::input::Pointer;
use crate::workspace::{Workspace, tidy_handles};

/// The message if paint has no effect.
const LOCKED_OBJECT: &str = "This object is locked: unlock it in the list of objects to paint on it.";

/// The stroke's action.
#[derive(Debug)]
pub(super) struct PaintStroke {
    paint: Paint,
    other_side: Option<OtherSide>,
}

impl PaintStroke {
    /// Begins a stroke, without a dab, and cancels the running binding. `None`, with a sentence, if the handle is
    /// locked.
    pub fn begin(workspace: &mut Workspace, settings: &ToolSettings, pointer: Pointer) -> Option<StrokeGesture<Self>> {
        let is_erasing = pointer.modifiers.ctrl || matches!(settings.mode, ToolMode::Erase | ToolMode::Select);
        if !is_erasing
            && settings.mode == ToolMode::PaintHandle
            && !workspace.selection.wants_new_handle
            && let Some(handle) = workspace.selected().filter(|handle| handle.locked)
        {
            let name = &handle.name;
            workspace.refuse(format!(
                "{name} is locked: unlock it in the list, or press Shift+N for a new handle."
            ));
            return None;
        }
        let mut transaction = workspace.begin_stroke("Paint");
        let (paint, name) = match settings.mode {
            _ if is_erasing => (Paint::Bare, "Erase".to_owned()),
            ToolMode::PaintFree => (Paint::Free, "Paint region".to_owned()),
            ToolMode::PaintFixed => (Paint::Fixed, "Paint fixed".to_owned()),
            _ => {
                let id = handle_to_paint(workspace);
                let handle = workspace.document.handle(id);
                let name = handle.map_or("handle", |handle| handle.name.as_str());
                (Paint::Handle(id), format!("Paint {name}"))
            }
        };
        transaction.rename(name);
        let stroke = Self {
            paint,
            other_side: OtherSide::of(workspace),
        };
        Some(StrokeGesture::new(transaction, stroke, pointer))
    }

    /// Paints a handle's vertices on the shown shape, which becomes the rest shape, and lets them follow a line there;
    /// `reach` is that of the handle.
    pub fn take_with_line(
        &mut self,
        workspace: &mut Workspace,
        vertices: Vec<SurfaceVertex>,
        line: HandleLine,
        reach: Reach,
    ) {
        // An outline across the plane of symmetry is of one view: seen from the other side, it is another one.
        let is_sketch = line.sketch().is_some();
        let other_side = self.other_side.take();
        self.other_side = other_side.filter(|other| !is_sketch || other.is_beyond(workspace, &vertices));
        workspace.document.apply_shape();
        let members = vertices.clone();
        self.take(workspace, vertices);
        if let Paint::Handle(id) = self.paint {
            workspace.document.unsettle();
            // A handle that its line has moved away keeps the pivot that it has.
            let positions: Vec<DVec3> = members.iter().map(|&vertex| workspace.position(vertex)).collect();
            let pivot = positions.iter().sum::<DVec3>() / positions.len().max(1) as f64;
            workspace.document.change_handle(id, |handle| {
                handle.pivot = pivot;
                handle.line = Some(line);
                handle.reach = reach;
            });
        }
    }

    /// Paints those of the vertices that are not painted like that yet, and their partners on the other side.
    pub fn take_new(&mut self, workspace: &mut Workspace, mut met: Vec<SurfaceVertex>) {
        let paint = workspace.document.paint();
        met.retain(|vertex| paint[vertex.index()] != self.paint);
        self.take(workspace, met);
    }

    /// Paints vertices, and their partners on the other side.
    pub fn take(&mut self, workspace: &mut Workspace, mut vertices: Vec<SurfaceVertex>) {
        if let Some(other_side) = &mut self.other_side {
            vertices.sort_unstable();
            vertices.dedup();
            for (vertices, paint) in other_side.of_painted(workspace, self.paint, &vertices) {
                lay(workspace, vertices, paint);
            }
        } else {
            lay(workspace, vertices, self.paint);
        }
    }
}

impl Stroke for PaintStroke {
    fn doing(&self, workspace: &Workspace) -> String {
        match self.paint {
            Paint::Bare => "Erasing".to_owned(),
            Paint::Fixed => "Painting the fixed part".to_owned(),
            Paint::Free => "Painting the region".to_owned(),
            Paint::Handle(id) => {
                let handle = workspace.document.handle(id);
                format!("Painting {}", handle.map_or("a handle", |handle| handle.name.as_str()))
            }
        }
    }

    fn dab(&mut self, context: &mut Context<'_>, _: &Document, way_px: [DVec2; 2]) {
        let mut met = Vec::new();
        meet(context, way_px, |vertex, _| met.push(vertex));
        self.take_new(context.workspace, met);
    }

    fn finish(&mut self, workspace: &mut Workspace, before: &Document) {
        if let Some(other_side) = &self.other_side {
            other_side.drop_uncertain(workspace, self.paint, before);
            other_side.smooth(workspace, self.paint, before);
            other_side.drop_scraps(workspace, self.paint, before);
        }
        tidy_handles(workspace, before);
        if let Some(other_side) = &self.other_side {
            other_side.finish(workspace, self.paint);
        }
        if let Paint::Handle(id) = self.paint
            && workspace.document.handle(id).is_some()
        {
            workspace.selection.put(Some(id));
            workspace.selection.wants_new_handle = false;
        }
    }
}

/// Paints vertices; vertices of locked handles and hidden or locked ones keep their paint.
pub(super) fn lay(workspace: &mut Workspace, mut vertices: Vec<SurfaceVertex>, laid: Paint) {
    let document = &workspace.document;
    vertices.retain(|vertex| document.paint[vertex.index()] != laid);
    let access = &workspace.vertex_access;
    if !access.opens_all() {
        let has_locked = vertices.iter().any(|vertex| access.is_locked(vertex.index()));
        vertices.retain(|vertex| access.may_be_painted(vertex.index()));
        if has_locked && vertices.is_empty() {
            workspace.refuse(LOCKED_OBJECT);
            return;
        }
    }
    if document.handles().iter().any(|handle| handle.locked) {
        let is_locked = |paint: Paint| match paint {
            Paint::Handle(id) => document.handle(id).is_some_and(|handle| handle.locked),
            _ => false,
        };
        vertices.retain(|vertex| !is_locked(document.paint[vertex.index()]));
    }
    if !vertices.is_empty() {
        let document = &mut workspace.document;
        document.keep_shape();
        document.paint_vertices(vertices.into_iter().map(|vertex| (vertex, laid)));
    }
}

/// The selected handle, or a new one if a new one is wanted or none is selected.
fn handle_to_paint(workspace: &mut Workspace) -> HandleId {
    match workspace.selected() {
        Some(handle) if !workspace.selection.wants_new_handle => handle.id,
        _ => workspace.document.add_handle(),
    }
}
