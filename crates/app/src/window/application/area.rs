//! The 3D view's part of the window: its input, its pictures and the marks painted over them.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, FontId, Sense, vec2};
use glam::DVec2;
use pliant_editor::{Before, Cursor, Event, ToolMode};

use crate::files::names::file_name;
use crate::window::application::{Application, REST};
use crate::window::bars::{hints, work_pose};
use crate::window::files::desktop::Elsewhere;
use crate::window::files::settings::PanelPage;
use crate::window::input::Attention;
use crate::window::input::event_queue::EventQueue;
use crate::window::input::file_command::FileCommand;
use crate::window::panels::handles;
use crate::window::panels::notes::Note;
use crate::window::viewport::before::OriginalView;
use crate::window::viewport::method_views::MethodViews;
use crate::window::viewport::{Smoothness, axis_ball, context_menu, stiffness_legend};
use crate::window::widgets::number_field;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::theme;
use pliant_picture::legend;

impl Application {
    /// While the pointer is over the view and the view has the keyboard, Tab belongs to the view: it selects the next
    /// handle. Elsewhere it goes from one widget to the next.
    fn keep_tab(ui: &egui::Ui, is_over_view: bool, typing: bool) {
        let focused = ui.memory(egui::Memory::focused);
        let is_tab = ui.input(|input| input.key_pressed(egui::Key::Tab));
        if let Some(widget) = focused.filter(|_| is_tab && is_over_view && !typing) {
            ui.memory_mut(|memory| memory.surrender_focus(widget));
        }
    }

    /// The 3D view: input first, then the picture, then the layers over it.
    pub(in crate::window) fn view(&mut self, ui: &mut egui::Ui) -> Result<(), pliant_render::RenderError> {
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let (rect, compared) = match self.editor.comparison() {
            None => (whole, None),
            Some(comparison) => {
                let (rect, compared) = match comparison.large() {
                    None => whole.split_top_bottom_at_fraction(0.62),
                    Some(_) => whole.split_left_right_at_fraction(0.5),
                };
                (rect, Some(compared))
            }
        };
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return Ok(());
        }
        self.layout.view_rect = rect;
        let size_px = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
        if self.editor.view().viewport_px != size_px {
            self.editor.handle(Event::Viewport { size_px });
        }
        self.hear(ui, rect, &response);
        let mut commands = Outbox::default();
        work_pose::show(ui.ctx(), rect, &self.editor, &mut commands);
        let renamed = context_menu::show(&response, &self.editor, &mut commands);
        if let Some(handle) = renamed.and_then(|id| self.editor.document().handle(id)) {
            handles::rename(ui.ctx(), handle);
            self.layout.is_panel_hidden = false;
            self.settings.change(|settings| settings.page = PanelPage::Handles);
            ui.ctx().request_repaint();
        }
        for event in commands.take() {
            self.editor.handle(event);
            ui.ctx().request_repaint();
        }
        self.follow_mesh();
        self.request_drawing();
        self.request_pose();
        self.request_images();
        ui.ctx().set_cursor_icon(match self.editor.view().cursor {
            _ if !response.contains_pointer() => egui::CursorIcon::Default,
            Cursor::Arrow => egui::CursorIcon::Default,
            Cursor::Brush => egui::CursorIcon::Crosshair,
            Cursor::Grab => egui::CursorIcon::Grab,
            Cursor::Grabbing => egui::CursorIcon::Grabbing,
            Cursor::Move => egui::CursorIcon::Move,
        });
        self.picture(ui, rect)?;
        self.method_views(ui, compared)?;
        self.marks(ui, rect);
        self.invitation(ui, rect);
        self.words(ui, rect);
        Ok(())
    }

    /// Gives the editor the pointer's and keys' events over the view.
    fn hear(&mut self, ui: &egui::Ui, rect: egui::Rect, response: &egui::Response) {
        if response.is_pointer_button_down_on() {
            ui.memory_mut(|memory| {
                if let Some(focused) = memory.focused() {
                    memory.surrender_focus(focused);
                }
            });
        }
        let typing = EventQueue::is_typing(ui.ctx());
        Self::keep_tab(ui, response.contains_pointer(), typing);
        let pointer = ui.input(|input| input.pointer.latest_pos());
        let is_asked = self.dialogs.question.is_some() || self.dialogs.palette.is_some();
        let attention = Attention {
            rect,
            pointer: pointer.unwrap_or(rect.center()),
            pointer_over: response.contains_pointer()
                && pointer.is_some_and(|at| rect.contains(at))
                && !is_asked
                && !egui::Popup::is_any_open(ui.ctx())
                && !axis_ball::contains(rect, pointer)
                && !self.beside.split.takes(rect, pointer, self.editor.view().look.before),
            follows_pointer: self.editor.view().cursor == Cursor::Move,
            keys: !is_asked && !self.dialogs.keys.takes_keys() && !typing && !ui.ctx().egui_wants_keyboard_input(),
            more_to_come: EventQueue::has_more(ui.ctx()),
        };
        let events = self.input.events(ui.ctx(), attention);
        if !events.is_empty() {
            self.last_change = Instant::now();
        }
        for event in events {
            self.editor.handle(event);
        }
    }

    /// Whether anything has moved recently.
    fn smoothness(&self) -> Smoothness {
        let is_resting = self.last_change.elapsed() >= REST && self.editor.view().settled;
        if is_resting {
            Smoothness::Resting
        } else {
            Smoothness::Moving
        }
    }

    /// Draws the views of the methods into `place` while they are compared.
    fn method_views(&mut self, ui: &mut egui::Ui, place: Option<egui::Rect>) -> Result<(), pliant_render::RenderError> {
        let (Some(place), Some(comparison), Some(source)) =
            (place, self.editor.comparison(), self.workers.pose_source())
        else {
            // Their data on the device is dropped with them.
            self.beside.methods = MethodViews::default();
            return Ok(());
        };
        self.beside
            .methods
            .follow(ui.ctx(), comparison, &self.viewport, &source);
        let are_settled = self.beside.methods.are_settled(comparison);
        let smooth = if are_settled {
            self.smoothness()
        } else {
            Smoothness::Moving
        };
        let shown = self.beside.methods.show(ui, place, &self.editor, smooth)?;
        if shown.again {
            ui.ctx().request_repaint_after(REST);
        }
        if let Some(command) = shown.command {
            self.command(command);
            ui.ctx().request_repaint();
        }
        Ok(())
    }

    /// Draws the view.
    fn picture(&mut self, ui: &mut egui::Ui, rect: egui::Rect) -> Result<(), pliant_render::RenderError> {
        let smooth = self.smoothness();
        self.skins(ui, rect, smooth)?;
        let view = self.editor.view();
        if self.viewport.paint(ui, rect, &view, &self.editor, smooth)? {
            ui.ctx().request_repaint_after(
                REST.saturating_sub(self.last_change.elapsed())
                    .max(Duration::from_millis(10)),
            );
        }
        self.original(ui, rect, smooth)
    }

    /// Draws the ghosts of other moments and the surroundings, if there are ghosts: the picture then goes over them.
    fn skins(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        smooth: Smoothness,
    ) -> Result<(), pliant_render::RenderError> {
        let Some(source) = self.workers.pose_source() else {
            return Ok(());
        };
        let skins = self.editor.view().skins;
        self.beside.skins.follow(ui.ctx(), skins, &self.viewport, &source);
        self.viewport.set_cut_out(!skins.is_empty());
        if !skins.is_empty() && self.beside.skins.show(ui, rect, &self.viewport, &self.editor, smooth)? {
            ui.ctx().request_repaint_after(REST);
        }
        Ok(())
    }

    /// Lays the shape of the file over the picture, if it is shown along with the present one.
    fn original(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        smooth: Smoothness,
    ) -> Result<(), pliant_render::RenderError> {
        let before = self.editor.view().look.before;
        let (Some(source), true) = (self.workers.pose_source(), before != Before::Off) else {
            // Its data on the device is dropped with it.
            self.beside.original = None;
            return Ok(());
        };
        let new = || OriginalView::beside(ui.ctx(), &self.viewport);
        let original = self.beside.original.get_or_insert_with(new);
        original.follow(&self.editor, &self.viewport, &source);
        if original.show(ui, rect, &self.editor, self.beside.split, smooth)? {
            ui.ctx().request_repaint_after(REST);
        }
        if before == Before::Split {
            self.beside.split.show(ui, rect);
        }
        Ok(())
    }

    /// Paints the layers over the picture: a lasso, the legend, a readout beside the pointer, the axes.
    fn marks(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let shown = self.editor.view();
        if shown.outline_px.len() > 1 {
            let point = |px: &DVec2| rect.min + vec2(px.x as f32, px.y as f32);
            let mut line: Vec<egui::Pos2> = shown.outline_px.iter().map(point).collect();
            line.push(line[0]);
            let shadow = egui::Stroke::new(3.0, egui::Color32::from_black_alpha(120));
            ui.painter().add(egui::Shape::line(line.clone(), shadow));
            ui.painter()
                .add(egui::Shape::line(line, egui::Stroke::new(1.5, theme::ACCENT)));
        }
        if let Some(scale) = self.viewport.scale() {
            legend::paint(ui.painter(), rect.left_top() + vec2(14.0, 14.0), scale);
        } else if shown.tool == ToolMode::PaintStiffness && shown.model.is_some() {
            stiffness_legend::paint(ui, rect.left_top() + vec2(14.0, 14.0));
        }
        for number in &shown.pair_numbers {
            if let Some(at_px) = shown.camera.project(number.at, shown.viewport_px) {
                let at = rect.min + vec2(at_px.x as f32 + 6.0, at_px.y as f32 - 26.0);
                axis_ball::readout(ui.painter(), at, &number.text);
            }
        }
        if let Some(readout) = &shown.readout
            && let Some(at_px) = shown.camera.project(readout.at, shown.viewport_px)
        {
            let at = rect.min + vec2(at_px.x as f32 + 22.0, at_px.y as f32 - 26.0);
            axis_ball::readout(ui.painter(), at, &readout.text);
        }
        if !Arc::ptr_eq(shown.drawn, shown.displacements) {
            let at = rect.center_bottom() + vec2(-90.0, -34.0);
            let shows = if shown.look.original { "Original" } else { "Smooth base" };
            axis_ball::readout(ui.painter(), at, shows);
        }
        drop_target(ui, rect);
        if let Some(command) = axis_ball::show(ui, rect, shown.world_camera) {
            self.command(command);
            ui.ctx().request_repaint();
        }
    }

    /// While nothing is open and nothing is being opened: the ways to open something.
    fn invitation(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        if self.editor.view().model.is_some() || self.session.doing().is_some() {
            return;
        }
        let place = egui::Rect::from_center_size(rect.center(), vec2(150.0, 32.0));
        if ui.put(place, egui::Button::new("Open a mesh…")).clicked() {
            let context = ui.ctx().clone();
            self.file_command(&context, FileCommand::Open);
        }
        ui.painter().text(
            place.center_bottom() + vec2(0.0, 10.0),
            Align2::CENTER_TOP,
            "or drop one here",
            FontId::proportional(14.0),
            ui.visuals().text_color(),
        );
    }

    /// Shows messages and the first steps over the corners of the views, which together are `whole`.
    fn words(&mut self, ui: &egui::Ui, rect: egui::Rect) {
        if let Some(refusal) = number_field::take_refusal(ui.ctx()) {
            self.notes.headline = Some(Note::Failed(refusal));
        }
        let problem = self.editor.view().problem;
        let toast = self.toast.show(ui.ctx(), rect, problem, &mut self.notes.headline);
        if let Some(saved) = self.toast.take_to_show() {
            self.show_elsewhere(Elsewhere::File(saved));
        }
        if self.layout.shows_hints && !self.settings.get().hints_seen && hints::show(ui, rect, toast, &self.editor) {
            self.settings.change(|settings| settings.hints_seen = true);
        }
    }
}

/// While files are held over the window: the effect of dropping them.
fn drop_target(ui: &egui::Ui, rect: egui::Rect) {
    let held = ui.input(|input| input.raw.hovered_files.first().map(|file| file.path.clone()));
    let Some(path) = held else { return };
    let name = path.as_deref().map(file_name);
    let text = name.map_or_else(
        || "Release to open it".to_owned(),
        |name| format!("Release to open {name}"),
    );
    ui.painter().rect_stroke(
        rect.shrink(6.0),
        8.0,
        egui::Stroke::new(2.0, theme::ACCENT),
        egui::StrokeKind::Inside,
    );
    axis_ball::readout(ui.painter(), rect.center_top() + vec2(-60.0, 24.0), &text);
}
