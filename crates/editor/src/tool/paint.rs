//! A stroke of the brush: handle, region, fixed or nothing, from button down to button up.
//!
//! No stroke moves a drawn vertex: the first vertex that changes while something is displaced makes the present shape
//! the rest shape, within the same step.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex};

use super::{Tool, ToolMode};
use crate::document::Transaction;
use crate::document::{Document, HandleId, Paint, PivotPlace};
use crate::editor::Editor;
use crate::jobs::Activity;
use crate::{Button, Pointer};

/// What is said where paint does not take.
const LOCKED_OBJECT: &str = "This object is locked: unlock it in the list of objects to paint on it.";

/// A stroke that goes on.
#[derive(Debug)]
pub(crate) struct PaintStroke {
    transaction: Transaction,
    paint: Paint,
    last_px: DVec2,
}

impl PaintStroke {
    /// Begins a stroke with a first dab under the pointer. What was being bound is not wanted any more. `None`, with a
    /// sentence, where the handle is locked.
    pub(crate) fn begin(editor: &mut Editor, pointer: Pointer) -> Option<Self> {
        let mut stroke = Self::begin_without_dab(editor, pointer)?;
        stroke.dab(editor, pointer.position_px);
        Some(stroke)
    }

    /// The same without a dab.
    pub(crate) fn begin_without_dab(editor: &mut Editor, pointer: Pointer) -> Option<Self> {
        debug_assert_eq!(editor.tool.activity(), Activity::Still);
        let is_erasing = pointer.modifiers.ctrl || matches!(editor.mode, ToolMode::Erase | ToolMode::Select);
        if !is_erasing
            && editor.mode == ToolMode::PaintHandle
            && !editor.wants_new_handle
            && let Some(handle) = editor.selected.and_then(|id| editor.document.handle(id))
            && handle.locked
        {
            let name = &handle.name;
            editor.problem = Some(format!(
                "{name} is locked: unlock it in the list, or press N for a new handle."
            ));
            return None;
        }
        editor.engine.stop_binding();
        editor.engine.drop_solves();
        let transaction = editor.begin("Paint");
        let (paint, name) = match editor.mode {
            _ if is_erasing => (Paint::Bare, "Erase".to_owned()),
            ToolMode::PaintFree => (Paint::Free, "Paint region".to_owned()),
            ToolMode::PaintFixed => (Paint::Fixed, "Paint fixed".to_owned()),
            _ => {
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
        Some(stroke)
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
        self.finish(editor);
        Tool::Idle
    }

    /// Paints these vertices and ends.
    pub(crate) fn finish_with(mut self, editor: &mut Editor, vertices: Vec<SurfaceVertex>) {
        let changed = vertices
            .into_iter()
            .filter(|vertex| editor.document.paint[vertex.index()] != self.paint)
            .collect();
        self.take(editor, changed);
        self.finish(editor);
    }

    fn finish(self, editor: &mut Editor) {
        let Self { transaction, paint, .. } = self;
        tidy_handles(editor, transaction.before());
        if let Paint::Handle(id) = paint
            && editor.document.handle(id).is_some()
        {
            editor.selected = Some(id);
            editor.wants_new_handle = false;
        }
        transaction.commit(&editor.document, &mut editor.history);
        editor.has_filed_paint = true;
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
            let visit = |vertex: SurfaceVertex, _| {
                if paint[vertex.index()] != self.paint {
                    changed.push(vertex);
                }
            };
            brush.stroke(&picking, self.last_px, to_px, &editor.brush_size(), visit);
        }
        editor.brush = brush;
        self.last_px = to_px;
        self.take(editor, changed);
    }

    /// Gives vertices the stroke's paint; those of locked handles keep theirs.
    fn take(&mut self, editor: &mut Editor, mut changed: Vec<SurfaceVertex>) {
        if !editor.masks.are_open() {
            let masks = &editor.masks;
            let has_locked = changed.iter().any(|vertex| masks.is_locked(vertex.index()));
            changed.retain(|vertex| masks.may_be_painted(vertex.index()));
            if has_locked && changed.is_empty() {
                editor.problem = Some(LOCKED_OBJECT.to_owned());
            }
        }
        let document = &mut editor.document;
        if document.handles.iter().any(|handle| handle.locked) {
            let is_locked = |paint: Paint| match paint {
                Paint::Handle(id) => document.handle(id).is_some_and(|handle| handle.locked),
                _ => false,
            };
            changed.retain(|vertex| !is_locked(document.paint[vertex.index()]));
        }
        if changed.is_empty() {
            return;
        }
        document.apply_shape();
        let painted = Arc::make_mut(&mut document.paint);
        for vertex in &changed {
            painted[vertex.index()] = self.paint;
        }
        editor.recolouring.add(&changed);
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
    editor.document.add_handle()
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
    let mut sums = vec![(DVec3::ZERO, 0.0, false); largest];
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
    let (paint, rest) = (Arc::clone(&document.paint), Arc::clone(&document.rest));
    let positions_of_rest = |vertex: usize| model.surface.positions[vertex] + rest[vertex];
    document.handles.retain_mut(|handle| {
        let (sum, count, changed) = sums[usize::from(handle.id.0)];
        if changed && count > 0.0 {
            handle.pivot = match handle.pivot_place {
                PivotPlace::Centroid => sum / count,
                PivotPlace::Border => {
                    border_middle(handle.id, &paint, &model, &positions_of_rest).unwrap_or(sum / count)
                }
                PivotPlace::Picked => handle.pivot,
            };
        }
        count > 0.0
    });
    let left: Vec<HandleId> = document.handles.iter().map(|handle| handle.id).collect();
    for handle in &mut document.handles {
        handle.twin = handle.twin.filter(|twin| left.contains(&twin.handle));
    }
}

/// The mean of a handle's vertices that stand beside others; `None` where it covers whole parts.
pub(crate) fn border_middle(
    id: HandleId,
    paint: &[Paint],
    model: &Model,
    position: &impl Fn(usize) -> DVec3,
) -> Option<DVec3> {
    let own = Paint::Handle(id);
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for vertex in (0..paint.len()).filter(|&vertex| paint[vertex] == own) {
        let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32));
        if neighbours.iter().any(|neighbour| paint[neighbour.index()] != own) {
            sum += position(vertex);
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}
