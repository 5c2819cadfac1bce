//! A stroke of the brush: handle, region, fixed or nothing, from button down to button up.
//!
//! No stroke moves a drawn vertex: the first vertex that changes while something is displaced makes the present shape
//! the rest shape, within the same step.

use std::sync::Arc;

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::{Tool, ToolMode};
use crate::document::{Document, Handle, HandleId, Paint};
use crate::editor::Editor;
use crate::engine::Activity;
use crate::transaction::Transaction;
use crate::{Button, Pointer};

/// The colours that handles get in turn: gold first, as in the survey's figures.
const COLOURS: [[u8; 4]; 8] = [
    [232, 184, 48, 255],
    [222, 96, 72, 255],
    [120, 190, 88, 255],
    [176, 112, 214, 255],
    [64, 190, 190, 255],
    [236, 132, 176, 255],
    [150, 128, 84, 255],
    [244, 222, 120, 255],
];

/// A stroke that goes on.
#[derive(Debug)]
pub(crate) struct PaintStroke {
    transaction: Transaction,
    paint: Paint,
    last_px: DVec2,
}

impl PaintStroke {
    /// Begins a stroke with a first dab under the pointer. What was being bound is not wanted any more.
    pub(crate) fn begin(editor: &mut Editor, pointer: Pointer) -> Self {
        debug_assert_eq!(editor.tool.activity(), Activity::Still);
        editor.engine.stop_binding();
        editor.engine.drop_solves();
        let transaction = editor.begin("Paint");
        let (paint, name) = match editor.mode {
            _ if pointer.modifiers.ctrl => (Paint::Bare, "Erase".to_owned()),
            ToolMode::Erase | ToolMode::Select => (Paint::Bare, "Erase".to_owned()),
            ToolMode::PaintFree => (Paint::Free, "Paint region".to_owned()),
            ToolMode::PaintFixed => (Paint::Fixed, "Paint fixed".to_owned()),
            ToolMode::PaintHandle => {
                let id = handle_to_paint(editor);
                let name = editor
                    .document
                    .handle(id)
                    .map_or("handle", |handle| handle.name.as_str());
                (Paint::Handle(id), format!("Paint {name}"))
            }
        };
        let mut stroke = Self {
            transaction,
            paint,
            last_px: pointer.position_px,
        };
        stroke.transaction.rename(name);
        stroke.dab(editor, pointer.position_px);
        stroke
    }

    pub(crate) fn moved(mut self: Box<Self>, editor: &mut Editor, pointer: Pointer) -> Tool {
        self.dab(editor, pointer.position_px);
        Tool::Paint(self)
    }

    pub(crate) fn released(mut self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        if button != Button::Primary {
            return Tool::Paint(self);
        }
        if pointer.position_px != self.last_px {
            self.dab(editor, pointer.position_px);
        }
        let Self { transaction, paint, .. } = *self;
        tidy_handles(editor, transaction.before());
        if let Paint::Handle(id) = paint
            && editor.document.handle(id).is_some()
        {
            editor.selected = Some(id);
            editor.wants_new_handle = false;
        }
        transaction.commit(&editor.document, &mut editor.history);
        Tool::Idle
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.transaction.abort(&mut editor.document);
        editor.repainted = true;
    }

    /// What is painted, for the status line.
    pub(crate) fn paint(&self) -> Paint {
        self.paint
    }

    fn dab(&mut self, editor: &mut Editor, to_px: DVec2) {
        let mut brush = std::mem::take(&mut editor.brush);
        let mut changed = Vec::new();
        if let Some(picking) = editor.picking() {
            let paint = editor.document.paint();
            let visit = |vertex: SurfaceVertex| {
                if paint[vertex.index()] != self.paint {
                    changed.push(vertex);
                }
            };
            brush.stroke(&picking, self.last_px, to_px, editor.brush_radius_px, visit);
        }
        editor.brush = brush;
        self.last_px = to_px;
        if changed.is_empty() {
            return;
        }
        editor.document.apply_shape();
        editor.repainted = true;
        let painted = Arc::make_mut(&mut editor.document.paint);
        for vertex in changed {
            painted[vertex.index()] = self.paint;
        }
    }
}

/// The selected handle, or a new one where a new one is wanted or none is selected.
fn handle_to_paint(editor: &mut Editor) -> HandleId {
    if let Some(id) = editor.selected
        && !editor.wants_new_handle
        && editor.document.handle(id).is_some()
    {
        return id;
    }
    let document = &mut editor.document;
    let id = HandleId(document.next_handle);
    document.next_handle = document.next_handle.saturating_add(1);
    document
        .handles
        .push(Handle::new(id, format!("handle {}", u32::from(id.0) + 1)));
    id
}

/// The colour that a handle gets when it is made.
pub(crate) fn handle_colour(id: HandleId) -> [u8; 4] {
    COLOURS[usize::from(id.0) % COLOURS.len()]
}

/// After regions have changed: handles without a vertex go, and the pivot of each handle whose vertices are others
/// than before is their mean.
pub(crate) fn tidy_handles(editor: &mut Editor, before: &Document) {
    let Some(model) = editor.engine.model.clone() else {
        return;
    };
    let document = &mut editor.document;
    if Arc::ptr_eq(&before.paint, &document.paint) {
        document.handles.retain(|handle| before.handle(handle.id).is_some());
        document.next_handle = before.next_handle;
        return;
    }
    let largest = document
        .handles
        .iter()
        .map(|handle| usize::from(handle.id.0) + 1)
        .max()
        .unwrap_or(0);
    let mut sums = vec![(glam::DVec3::ZERO, 0.0, false); largest];
    for (vertex, (&paint, &former)) in document.paint.iter().zip(before.paint.iter()).enumerate() {
        if let Paint::Handle(HandleId(id)) = paint {
            let (sum, count, _) = &mut sums[usize::from(id)];
            *sum += model.surface.positions[vertex] + document.rest[vertex];
            *count += 1.0;
        }
        if paint != former {
            for touched in [paint, former] {
                if let Paint::Handle(HandleId(id)) = touched
                    && let Some((_, _, changed)) = sums.get_mut(usize::from(id))
                {
                    *changed = true;
                }
            }
        }
    }
    document.handles.retain_mut(|handle| {
        let (sum, count, changed) = sums[usize::from(handle.id.0)];
        if changed && count > 0.0 {
            handle.pivot = sum / count;
        }
        count > 0.0
    });
}
