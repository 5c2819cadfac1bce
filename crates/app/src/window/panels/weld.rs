//! The vertices of the file that are welded: by the mesh itself, only equal ones, or those within a distance.

use eframe::egui;
use pliant_editor::Editor;
use pliant_mesh::{Model, WeldOptions};

use crate::window::input::file_command::FileCommand;
use crate::window::widgets::command_button::choices;
use crate::window::widgets::number_field::{LENGTHS, dragged, number_field};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

#[derive(Clone, Copy, PartialEq)]
enum Joined {
    ByMesh,
    Equal,
    Within,
}

const CHOICES: [(Joined, &str, &str); 3] = [
    (
        Joined::ByMesh,
        "by mesh",
        "Welds vertices that are close compared with the triangles beside them, or that the file rounded apart.",
    ),
    (Joined::Equal, "equal", "Welds only vertices at equal positions."),
    (
        Joined::Within,
        "within",
        "Welds vertices within a distance, for borders that should meet but don't. Near small triangles the limit is \
         half their size.",
    ),
];

/// The suggested distance, as a share of the mean edge.
const FIRST_DISTANCE: f64 = 0.1;

/// The number of triangles from which the mean edge is computed.
const SAMPLED: usize = 4096;

/// Shows the choice, and the distance if one is chosen.
pub fn show(ui: &mut egui::Ui, editor: &Editor, model: &Model, commands: &mut Outbox) {
    let joined = match model.weld.distance {
        None => Joined::ByMesh,
        Some(0.0) => Joined::Equal,
        Some(_) => Joined::Within,
    };
    let join = |distance| FileCommand::Weld(WeldOptions { distance });
    ui.horizontal_wrapped(|ui| {
        row_label(ui, "Weld").on_hover_text(
            "Chooses the vertices that count as one. Another choice reads the mesh again: your work stays, but undo \
             starts over.",
        );
        match choices(ui, joined, &CHOICES) {
            Some(Joined::ByMesh) => commands.push_file(join(None)),
            Some(Joined::Equal) => commands.push_file(join(Some(0.0))),
            Some(Joined::Within) if joined != Joined::Within => {
                commands.push_file(join(Some(rounded(FIRST_DISTANCE * mean_edge(model)))));
            }
            Some(Joined::Within) | None => {}
        }
    });
    let Some(distance) = model.weld.distance.filter(|distance| *distance > 0.0) else {
        return;
    };
    ui.horizontal(|ui| {
        let label = row_label(ui, "Distance");
        // The value is kept here during a drag: the mesh is read again only at its end.
        let id = ui.scope_id().with("weld distance");
        let mut value = ui.data(|data| data.get_temp(id)).unwrap_or(distance);
        let field = number_field(ui, &mut value, |ui, value| {
            let field = dragged(ui, value, LENGTHS)
                .range(f64::MIN_POSITIVE..=f64::MAX)
                .speed(0.01 * distance);
            ui.add_enabled(!editor.is_acting(), field).labelled_by(label.id)
        });
        let field = field.on_hover_text(
            "Sets the distance in the file's unit, like `weld` in an edit and `--weld` on the command line.",
        );
        if field.dragged() {
            ui.data_mut(|data| data.insert_temp(id, value));
        } else {
            ui.data_mut(|data| data.remove::<f64>(id));
        }
        if field.drag_stopped() || (field.changed() && !field.dragged()) {
            commands.push_file(join(Some(value)));
        }
    });
}

/// A length by its first digit.
fn rounded(length: f64) -> f64 {
    let unit = 10.0_f64.powf(length.log10().floor());
    let rounded = (length / unit).round() * unit;
    if rounded.is_normal() { rounded } else { length }
}

/// The mean length of the edges of some triangles.
fn mean_edge(model: &Model) -> f64 {
    let surface = &model.surface;
    let step = (surface.triangles.len() / SAMPLED).max(1);
    let corners = (0..surface.triangles.len())
        .step_by(step)
        .map(|triangle| surface.corners(triangle));
    let (mut sum, mut count) = (0.0, 0.0);
    for [a, b, c] in corners {
        sum += a.distance(b) + b.distance(c) + c.distance(a);
        count += 3.0;
    }
    if count > 0.0 { sum / count } else { 1.0 }
}
