//! The ghosts of other moments behind the present shape: further pictures from the same eye, coloured and faded.
//!
//! They need no common depth: the surroundings are drawn first, without a surface, then the ghosts, and the present shape
//! over them without its surroundings.

use eframe::egui::{self, Color32, Rect, UiBuilder};
use pliant_editor::{Clay, Editor, Look, SceneView, Shading, Skin, Skins};
use pliant_render::RenderError;

use super::side_view::SideView;
use super::{Smoothness, Viewport};
use crate::window::threads::workers::PoseSource;

/// The opacity of the ghosts next to the shown moment.
const NEAREST: f32 = 0.6;

/// The opacity of a ghost as a share of that of its neighbour nearer to the shown moment.
const FADE: f32 = 0.7;

/// The pictures of other moments.
#[derive(Default)]
pub struct SkinViews {
    /// The surroundings under all of them, while there are some.
    stage: Option<Viewport>,
    ghosts: Vec<Ghost>,
}

/// The picture of another moment.
struct Ghost {
    view: SideView,
    /// The place of the moment that it shows, which stays until another one is ready; `None` before the first.
    place: Option<i8>,
}

impl SkinViews {
    /// Returns true if every picture shows its moment.
    pub fn are_settled(&self, skins: &[Skin]) -> bool {
        self.ghosts.len() == skins.len()
            && self
                .ghosts
                .iter()
                .zip(skins)
                .all(|(ghost, skin)| ghost.view.shows(&skin.from_file))
    }

    /// Takes over the first view's state and the editor's moments, and the results of other threads.
    pub fn follow(&mut self, context: &egui::Context, skins: &[Skin], first: &Viewport, source: &PoseSource) {
        // Their data on the device is dropped with those that are no longer needed.
        self.ghosts.truncate(skins.len());
        if skins.is_empty() {
            self.stage = None;
        }
        while self.ghosts.len() < skins.len() {
            self.ghosts.push(Ghost {
                view: SideView::beside(context, first),
                place: None,
            });
        }
        // Ghosts need no colours of numbers on the surface.
        let source = PoseSource {
            field: None,
            ..source.clone()
        };
        for (ghost, skin) in self.ghosts.iter_mut().zip(skins) {
            let view = &mut ghost.view;
            view.workers.set_pose_source(source.clone());
            while let Some(message) = view.receive() {
                view.take(message, &skin.from_file, &source);
            }
            view.follow(&skin.from_file, first, &source);
            if view.shows(&skin.from_file) {
                ghost.place = Some(skin.place);
            } else if !view.viewport.shows(&source.drawing) {
                ghost.place = None;
            }
        }
    }

    /// Draws the surroundings of the first view's surface and the ghosts into `rect`, the farthest ones first. Returns whether they are worth a
    /// second drawing when nothing has changed for a while.
    ///
    /// # Errors
    /// As [`Viewport::paint`].
    pub fn show(
        &mut self,
        ui: &mut egui::Ui,
        rect: Rect,
        first: &Viewport,
        editor: &Editor,
        smooth: Smoothness,
    ) -> Result<bool, RenderError> {
        let shown = editor.view();
        let view = SceneView {
            brush_ring: &[],
            gizmo: &[],
            controls: &[],
            shapes: &[],
            overlay_revision: 0,
            look: Look {
                shading: Shading::Clay,
                clay: Clay::Plaster,
                regions: false,
                wireframe: false,
                ..shown.look
            },
            ..editor.view()
        };
        let stage = self.stage.get_or_insert_with(|| first.beside());
        stage.set_surroundings_of(first);
        stage.paint(ui, rect, &view, editor, smooth)?;
        if !self.are_settled(shown.skins) {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(10));
        }
        let ready = self.ghosts.iter_mut();
        let mut ready: Vec<(i8, &mut SideView)> = ready
            .filter_map(|ghost| Some((ghost.place?, &mut ghost.view)))
            .collect();
        ready.sort_by_key(|(place, _)| std::cmp::Reverse(place.unsigned_abs()));
        let mut is_worth_more = false;
        for (place, side) in ready {
            side.viewport.set_opacity(opacity(place));
            side.viewport.set_tint(colour(shown.look.skins, place));
            let painted = ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
                ui.set_clip_rect(rect);
                side.viewport.paint(ui, rect, &view, editor, smooth)
            });
            is_worth_more |= painted.inner?;
        }
        Ok(is_worth_more)
    }
}

fn opacity(place: i8) -> f32 {
    NEAREST * FADE.powi(i32::from(place.unsigned_abs()) - 1)
}

fn colour(skins: Skins, place: i8) -> Color32 {
    let [red, green, blue] = skins.colours[usize::from(place > 0)];
    Color32::from_rgb(red, green, blue)
}
