//! The shape of the file along with the present one: on the left of a line that can be dragged, or as a ghost.
//!
//! It is a further picture from the same eye, drawn over the first: clipped at the line, or faded. So the two need no
//! common depth, and nothing is drawn while it is off.

use std::time::Duration;

use eframe::egui::{self, CursorIcon, Pos2, Rect, Sense, UiBuilder};
use pliant_editor::{Before, Editor, SceneView};
use pliant_render::RenderError;

use super::axis_ball::readout;
use super::side_view::SideView;
use super::{Smoothness, Viewport};
use crate::window::threads::workers::PoseSource;

/// The opacity of a ghost.
const GHOST: f32 = 0.45;

/// The distance within which the pointer takes the line, in points.
const GRIP: f32 = 6.0;

/// The share of the view's width to the left of the line at first, and its least distance from the borders.
const MIDDLE: f32 = 0.5;
const LEAST: f32 = 0.03;

/// The position of the line, as a share of the view's width.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Split(f32);

impl Default for Split {
    fn default() -> Self {
        Self(MIDDLE)
    }
}

impl Split {
    /// The place where the pointer takes the line.
    fn grip(self, view: Rect) -> Rect {
        let x = view.left() + self.0 * view.width();
        Rect::from_x_y_ranges(x - GRIP..=x + GRIP, view.y_range())
    }

    /// Returns true if the pointer is on the line, if that is shown.
    pub fn takes(self, view: Rect, position: Option<Pos2>, before: Before) -> bool {
        before == Before::Split && position.is_some_and(|position| self.grip(view).contains(position))
    }

    /// Shows the line, and moves it during a drag.
    pub fn show(&mut self, ui: &egui::Ui, view: Rect) {
        let response = ui.interact(self.grip(view), egui::Id::unique("before and after"), Sense::drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Splitter, true, "Line between before and after"));
        if let Some(pointer) = response.interact_pointer_pos() {
            self.0 = ((pointer.x - view.left()) / view.width()).clamp(LEAST, 1.0 - LEAST);
            ui.ctx().request_repaint();
        }
        if response.hovered() || response.dragged() {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        let x = self.grip(view).center().x;
        let colour = egui::Color32::from_white_alpha(220);
        ui.painter().vline(x, view.y_range(), egui::Stroke::new(1.5, colour));
        let knob = egui::pos2(x, view.center().y);
        ui.painter().circle_filled(knob, 5.0, colour);
        let top = view.top() + 12.0;
        let words = ui.painter().with_clip_rect(view);
        readout(&words, egui::pos2(x - 150.0, top), "Original");
        readout(&words, egui::pos2(x + 12.0, top), "Now");
    }
}

/// The picture of the file's shape.
pub struct OriginalView(SideView);

impl OriginalView {
    /// An empty picture, on the device of another.
    pub fn beside(context: &egui::Context, first: &Viewport) -> Self {
        Self(SideView::beside(context, first))
    }

    /// Returns true if it shows the open file's shape.
    pub fn is_settled(&self, view: &SceneView<'_>) -> bool {
        self.0.shows(view.original)
    }

    /// The time that drawing it has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        self.0.viewport.drawing_time()
    }

    /// Takes over the first view's state, and the results of other threads.
    pub fn follow(&mut self, editor: &Editor, first: &Viewport, source: &PoseSource) {
        let view = editor.view();
        self.0.workers.set_pose_source(source.clone());
        while let Some(message) = self.0.receive() {
            self.0.take(message, view.original, source);
        }
        self.0.follow(view.original, first, source);
    }

    /// Draws it over the first view's picture in `rect`. Returns whether it is worth a second drawing when nothing has
    /// changed for a while.
    ///
    /// # Errors
    /// As [`Viewport::paint`].
    pub fn show(
        &mut self,
        ui: &mut egui::Ui,
        rect: Rect,
        editor: &Editor,
        split: Split,
        smooth: Smoothness,
    ) -> Result<bool, RenderError> {
        // Tools act on the present shape, and mark it there.
        let view = SceneView {
            brush_ring: &[],
            gizmo: &[],
            controls: &[],
            shapes: &[],
            overlay_revision: 0,
            ..editor.view()
        };
        let (opacity, seen) = match view.look.before {
            Before::Off => return Ok(false),
            Before::Ghost => (GHOST, rect),
            Before::Split => (1.0, rect.with_max_x(split.grip(rect).center().x)),
        };
        self.0.viewport.set_opacity(opacity);
        let viewport = &mut self.0.viewport;
        let painted = ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.set_clip_rect(seen);
            viewport.paint(ui, rect, &view, editor, smooth)
        });
        painted.inner
    }
}
