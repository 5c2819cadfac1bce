//! Live views of each method's result for the present edit, all small or one large, from the main view's camera, with
//! names and figures beneath. A click takes a method.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

use eframe::egui::text::{LayoutJob, TextWrapping};
use eframe::egui::{self, Color32, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, UiBuilder, pos2, vec2};
use glam::{BVec3, DVec2, DVec3};
use pliant_editor::{Alternative, Camera, Command, Comparison, Editor, Look, SceneView, Shading};
use pliant_mesh::Bounds;
use pliant_render::RenderError;

use super::side_view::SideView;
use super::{Smoothness, Viewport};
use crate::window::threads::workers::PoseSource;
use crate::window::widgets::icon::{Icon, toggle};
use crate::window::widgets::theme;
use pliant_engine::report::finite_or;
use pliant_picture::sheet;

/// The height of a caption of two lines, in points.
const CAPTION: f32 = 36.0;
/// The margin around a picture, in points.
const GAP: f32 = 3.0;

/// A view for each method that is compared.
#[derive(Default)]
pub struct MethodViews {
    views: Vec<SideView>,
}

/// The result of showing the views.
pub struct Shown {
    /// True if a second drawing is worth it when nothing has changed for a while.
    pub again: bool,
    /// The command that was clicked.
    pub command: Option<Command>,
}

impl MethodViews {
    /// Returns true if every view shows its method's result for the present edit.
    pub fn are_settled(&self, comparison: &Comparison) -> bool {
        let alternatives = comparison.alternatives();
        let mut pairs = self.views.iter().zip(alternatives);
        self.views.len() == alternatives.len()
            && comparison.is_current()
            && pairs.all(|(view, alternative)| view.shows(&alternative.shape))
    }

    /// The time that drawing them has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        self.views.iter().map(|view| view.viewport.drawing_time()).sum()
    }

    /// Takes over the shapes of the comparison, and the results of other threads. The file is uploaded for one view
    /// after the other.
    pub fn follow(&mut self, context: &egui::Context, comparison: &Comparison, first: &Viewport, source: &PoseSource) {
        let alternatives = comparison.alternatives();
        self.views.truncate(alternatives.len());
        while self.views.len() < alternatives.len() {
            self.views.push(SideView::beside(context, first));
        }
        for (view, alternative) in self.views.iter_mut().zip(alternatives) {
            while let Some(message) = view.receive() {
                view.take(message, &alternative.shape, source);
            }
        }
        let mut is_uploading = false;
        for (view, alternative) in self.views.iter_mut().zip(alternatives) {
            if !is_uploading || view.viewport.shows(&source.drawing) {
                view.follow(&alternative.shape, first, source);
            }
            is_uploading |= view.is_uploading();
        }
    }

    /// Shows the views in `rect`, which has the main view's camera.
    ///
    /// # Errors
    /// As [`Viewport::paint`].
    pub fn show(&mut self, ui: &mut Ui, rect: Rect, editor: &Editor, smooth: Smoothness) -> Result<Shown, RenderError> {
        let mut shown = Shown {
            again: false,
            command: None,
        };
        let Some(comparison) = editor.comparison() else {
            return Ok(shown);
        };
        ui.painter().rect_filled(rect, 0.0, ui.visuals().panel_fill);
        let line = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
        ui.painter().hline(rect.x_range(), rect.top(), line);
        let shown_count = if comparison.large().is_some() {
            1
        } else {
            self.views.len()
        };
        let columns = sheet::columns(shown_count as u32, rect.size().into(), CAPTION) as usize;
        let rows = shown_count.div_ceil(columns);
        let size = vec2(rect.width() / columns as f32, rect.height() / rows as f32);
        let main = editor.view();
        let share = share_in_sight(&main, comparison);
        let moving = box_of_moving(comparison);
        let pairs = self.views.iter_mut().zip(comparison.alternatives()).enumerate();
        let is_shown = |number: usize| comparison.large().is_none_or(|large| large == number);
        for (place, (number, (view, alternative))) in pairs.filter(|(number, _)| is_shown(*number)).enumerate() {
            let corner = rect.min + vec2((place % columns) as f32 * size.x, (place / columns) as f32 * size.y);
            let cell = Rect::from_min_size(corner, size).shrink(GAP);
            let picture = Rect::from_min_max(cell.min, cell.max - vec2(0.0, CAPTION));
            if picture.width() < 1.0 || picture.height() < 1.0 {
                continue;
            }
            if alternative.refusal.is_none() {
                shown.again |= draw(ui, picture, view, (share, moving), editor, smooth)?;
            }
            let is_own = *editor.document().method() == alternative.method;
            caption(ui, cell, picture, alternative, view.problem.as_deref(), is_own);
            if button(ui, cell, number, (alternative, view.problem.as_deref()), is_own) && !is_own {
                shown.command = Some(Command::SetMethod(alternative.method.clone()));
            }
            let is_large = comparison.large() == Some(number);
            if enlarge_button(ui, cell, alternative, is_large) {
                shown.command = Some(Command::EnlargeMethod((!is_large).then_some(number)));
            }
        }
        Ok(shown)
    }
}

/// Draws a method's shape from the main view's direction, without the marks of the pointer there: near enough to fill
/// the picture with what moves, or with this share of the main view's width and height if the person is nearer.
fn draw(
    ui: &Ui,
    rect: Rect,
    view: &mut SideView,
    (share, moving): (DVec2, Option<Bounds>),
    editor: &Editor,
    smooth: Smoothness,
) -> Result<bool, RenderError> {
    let main = editor.view();
    // Only the shape: it is small enough. Weights belong to the document's own method.
    let look = Look {
        shading: match main.look.shading {
            Shading::Weights => Shading::Clay,
            shading => shading,
        },
        regions: false,
        outlines: false,
        grid: false,
        shadow: false,
        ..main.look
    };
    let viewport_px = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
    let near = moving.map(|moving| framing(main.camera, moving, viewport_px));
    let near = near.filter(|near| near.distance < main.camera.distance);
    let camera = near.unwrap_or_else(|| as_wide(main.camera, main.viewport_px, share, viewport_px));
    let scene = SceneView {
        camera_revision: revision_of(&camera, main.camera_revision),
        camera: &camera,
        viewport_px,
        look,
        brush_ring: &[],
        gizmo: &[],
        controls: &[],
        shapes: &[],
        overlay_revision: 0,
        ..main
    };
    view.viewport.paint(ui, rect, &scene, editor, smooth)
}

/// A number that differs for other cameras.
fn revision_of(camera: &Camera, main: u64) -> u64 {
    let mut hasher = DefaultHasher::new();
    let numbers = [
        camera.target.x,
        camera.target.y,
        camera.target.z,
        camera.distance,
        camera.fov_y_rad,
    ];
    (main, numbers.map(f64::to_bits)).hash(&mut hasher);
    hasher.finish()
}

/// The box around everything that some method moves. Methods that have thrown it far away do not count.
fn box_of_moving(comparison: &Comparison) -> Option<Bounds> {
    let figures = comparison.alternatives().iter();
    let boxes: Vec<Bounds> = figures.filter_map(|alternative| alternative.figures?.moved).collect();
    let sizes = boxes.iter().map(Bounds::diagonal);
    let least = sizes.fold(f64::INFINITY, f64::min);
    let near = boxes.iter().filter(|moved| moved.diagonal() <= FARTHEST * least);
    near.copied().reduce(|a, b| a.union(&b))
}

/// The camera in the same direction that shows a box with some room around it.
fn framing(camera: &Camera, shown: Bounds, size_px: DVec2) -> Camera {
    let mut near = *camera;
    near.frame(&corners(shown).collect::<Vec<_>>(), size_px);
    near.distance *= ROOM;
    near
}

/// The corners of a box.
fn corners(bounds: Bounds) -> impl Iterator<Item = DVec3> {
    (0..8).map(move |number: u32| {
        let is_high = [0, 1, 2].map(|axis| number >> axis & 1 == 1);
        DVec3::select(BVec3::from_array(is_high), bounds.max, bounds.min)
    })
}

/// The camera that shows in `to` at least the middle `share` of the width and height of `camera`'s picture in `from`,
/// in the same perspective.
fn as_wide(camera: &Camera, from: DVec2, share: DVec2, to: DVec2) -> Camera {
    let wider = ((share.x * from.x / from.y) / (to.x / to.y)).max(share.y);
    Camera {
        fov_y_rad: 2.0 * ((0.5 * camera.fov_y_rad).tan() * wider).atan(),
        ..*camera
    }
}

/// The share of the main view's width and height, about its middle, that the small views show: at least all of its
/// height, and in width every method's shape. If the person sees all of the model, that is more than the main view's if
/// a method has bent its shape beyond it; if the person has come nearer, the main view's is the most.
fn share_in_sight(main: &SceneView<'_>, comparison: &Comparison) -> DVec2 {
    let bounds = main.model.and_then(|model| model.bounds());
    let figures = comparison
        .alternatives()
        .iter()
        .filter_map(|alternative| alternative.figures);
    let bent = figures.filter_map(|figures| figures.bounds);
    let at_rest = reach(main.camera, main.viewport_px, bounds);
    let most = if at_rest.max_element() <= 1.0 { FARTHEST } else { 1.0 };
    let all = reach(main.camera, main.viewport_px, bounds.into_iter().chain(bent));
    // With a little room at the sides, and above and below for parts that the main view does not show.
    let height = if all.y > 1.0 { ROOM * all.y } else { 1.0 };
    DVec2::new((ROOM * all.x).clamp(0.2, most), height.min(most))
}

/// The room around a shape, as a factor of its size.
const ROOM: f64 = 1.1;

/// A small view shows at most this many times the main view's content: a shape that some method has thrown far away
/// does not turn all the others into dots.
const FARTHEST: f64 = 3.0;

/// The extent of boxes from the middle of a view towards its edges, which are at 1; 1 if a corner is behind the eye.
fn reach(camera: &Camera, size_px: DVec2, boxes: impl IntoIterator<Item = Bounds>) -> DVec2 {
    let reached = boxes.into_iter().flat_map(corners).map(|corner| {
        let seen = camera.project(corner, size_px);
        seen.map_or(DVec2::ONE, |at_px| (2.0 * at_px / size_px - DVec2::ONE).abs())
    });
    reached.fold(DVec2::ZERO, DVec2::max)
}

/// Writes a method's name and a figure beneath its picture, or the reason why there is none in the picture's place.
fn caption(ui: &Ui, cell: Rect, picture: Rect, alternative: &Alternative, problem: Option<&str>, is_own: bool) {
    let painter = ui.painter().with_clip_rect(cell);
    let visuals = ui.visuals();
    let (strong, weak) = (visuals.strong_text_color(), visuals.weak_text_color());
    let write = |at: Pos2, text: &str, (size, rows): (f32, usize), colour: Color32| {
        let mut lines = LayoutJob::simple(text.to_owned(), FontId::proportional(size), colour, 0.0);
        lines.wrap = TextWrapping {
            max_width: picture.width() - 8.0,
            max_rows: rows,
            ..TextWrapping::default()
        };
        painter.galley(at, painter.layout_job(lines), colour);
    };
    let at = picture.left_bottom() + vec2(4.0, 1.0);
    let title = alternative.method.declaration().title;
    let title_colour = if is_own { theme::ACCENT } else { strong };
    write(at, title, (13.0, 1), title_colour);
    let below = at + vec2(0.0, 17.0);
    if let Some(sentence) = alternative.refusal.as_deref().or(problem) {
        let rows = ((picture.height() - 12.0) / REFUSAL_LINE) as usize;
        write(
            picture.left_top() + vec2(4.0, 8.0),
            sentence,
            (12.0, rows.max(1)),
            strong,
        );
    } else if let Some(figures) = &alternative.figures {
        let colour = if alternative.is_current { strong } else { weak };
        write(below, &stretch(figures.edge_stretch_mean), (11.0, 1), colour);
    } else {
        write(below, "binding …", (11.0, 1), weak);
    }
}

/// The height of a line of a refusal, in points.
const REFUSAL_LINE: f32 = 15.0;

/// The mean stretch of the edges in percent.
fn stretch(mean: f64) -> String {
    match 100.0 * (finite_or(mean, f64::MAX) - 1.0) {
        percent @ ..1000.0 => format!("stretch {percent:.1}%"),
        _ => "stretch above 1000%".to_owned(),
    }
}

/// Everything about a method's result, for the pointer that rests on its cell.
fn details(alternative: &Alternative, problem: Option<&str>) -> String {
    let declaration = alternative.method.declaration();
    let mut text = format!("{}: {}", declaration.title, declaration.when_to_use);
    if let Some(sentence) = alternative.refusal.as_deref().or(problem) {
        text = format!("{text}\n{sentence}");
    } else if let Some(figures) = &alternative.figures {
        let ratios = [figures.edge_stretch_mean, figures.edge_stretch_max].map(|ratio| finite_or(ratio, f64::MAX));
        let times = sheet::times(figures.bind_ms, figures.frame_ms);
        text = format!("{text}\n{times}\n{}", sheet::stretch(ratios));
    }
    text
}

/// The cell as a button; whether it was clicked.
fn button(
    ui: &Ui,
    cell: Rect,
    number: usize,
    (alternative, problem): (&Alternative, Option<&str>),
    is_own: bool,
) -> bool {
    let declaration = alternative.method.declaration();
    let response = ui.interact(cell, ui.scope_id().with(("method view", number)), Sense::click());
    response.widget_info(|| {
        let label = format!("Use {}", declaration.title);
        egui::WidgetInfo::selected(egui::Role::Button, true, is_own, label)
    });
    let stroke = match (is_own, response.hovered() || response.has_focus()) {
        (true, _) => Stroke::new(2.0, theme::ACCENT),
        (false, true) => Stroke::new(1.5, ui.visuals().strong_text_color()),
        (false, false) => Stroke::NONE,
    };
    ui.painter().rect_stroke(cell, 4.0, stroke, StrokeKind::Inside);
    response.on_hover_text(details(alternative, problem)).clicked()
}

/// The toggle in the cell's corner that shows the method large; whether it was clicked.
fn enlarge_button(ui: &mut Ui, cell: Rect, alternative: &Alternative, is_large: bool) -> bool {
    let title = alternative.method.declaration().title;
    let (name, hover) = if is_large {
        ("Show all methods".to_owned(), "Shows the results of all methods again.")
    } else {
        (
            format!("Enlarge {title}"),
            "Shows this method's result large, beside the view.",
        )
    };
    let place = Rect::from_min_size(pos2(cell.right() - 24.0, cell.top() + 6.0), vec2(18.0, 18.0));
    let toggled = ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        toggle(ui, Icon::Large, is_large, &name, hover)
    });
    toggled.inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_view_shows_the_middle_of_a_wide_one() {
        let camera = Camera::default();
        let (main, cell) = (DVec2::new(1200.0, 700.0), DVec2::new(150.0, 200.0));
        let width = |camera: &Camera, size: DVec2| (0.5 * camera.fov_y_rad).tan() * size.x / size.y;
        for share in [0.5, 1.0] {
            let share = DVec2::new(share, 1.0);
            let narrow = as_wide(&camera, main, share, cell);
            assert!((width(&narrow, cell) - share.x * width(&camera, main)).abs() < 1e-12);
            assert_eq!(as_wide(&camera, cell, share, main).fov_y_rad, camera.fov_y_rad);
        }
    }

    #[test]
    fn what_moves_fills_its_picture_and_nothing_of_it_is_cut() {
        let camera = Camera::default();
        let middle = camera.target + DVec3::new(0.3, 0.1, 0.0);
        let half = DVec3::new(0.02, 0.05, 0.03) * camera.distance;
        let moving = Bounds {
            min: middle - half,
            max: middle + half,
        };
        for cell in [DVec2::new(150.0, 200.0), DVec2::new(400.0, 120.0)] {
            let near = framing(&camera, moving, cell);
            let extent = reach(&near, cell, [moving]).max_element();
            assert!((0.4..=1.0).contains(&extent), "{extent}");
            assert_eq!((near.yaw_rad, near.pitch_rad), (camera.yaw_rad, camera.pitch_rad));
            assert_ne!(revision_of(&near, 1), revision_of(&camera, 1));
        }
    }

    #[test]
    fn a_box_that_reaches_beyond_the_view_is_in_sight_of_a_camera_with_its_share() {
        let camera = Camera::default();
        let size_px = DVec2::new(1200.0, 700.0);
        let middle = camera.target;
        let half = DVec3::new(2.0, 0.1, 0.1) * camera.distance;
        let far = Bounds {
            min: middle - half,
            max: middle + half,
        };
        let before = reach(&camera, size_px, [far]);
        assert!(before.x > 1.0, "{before}");
        let share = before * ROOM;
        for cell in [DVec2::new(150.0, 200.0), DVec2::new(400.0, 120.0)] {
            let after = reach(&as_wide(&camera, size_px, share, cell), cell, [far]);
            assert!(after.max_element() <= 1.0, "{after}");
        }
    }
}
