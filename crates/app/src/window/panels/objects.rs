//! The list of the file's nodes and materials: shown, shown alone, or fixed.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use eframe::egui::{self, Align, Layout, RichText, ScrollArea};
use pliant_editor::{Access, Command, Editor, ObjectAction, SmallParts, object_name, thousands};
use pliant_mesh::{Model, Object};

use crate::window::widgets::command_button::command_button;
use crate::window::widgets::icon::{Icon, toggle};
use crate::window::widgets::number_field::{dragged, number_field};
use crate::window::widgets::outbox::Outbox;

/// The number of rows that are visible at a time.
const ROWS: f32 = 7.0;

/// A line of the list: objects of one node, or of one material.
struct Row {
    name: String,
    objects: Vec<u32>,
    triangles: usize,
}

/// Both lists of a model.
struct Rows {
    of: Arc<Model>,
    nodes: Vec<Row>,
    materials: Vec<Row>,
    /// The number of objects.
    count: usize,
    /// True if some connected part is smaller than another.
    has_parts: bool,
}

impl Rows {
    fn of(model: &Arc<Model>) -> Self {
        let objects = model.all_objects();
        let materials = grouped(&objects, |object| &object.material, |_| "no material".to_owned());
        Self {
            of: Arc::clone(model),
            nodes: grouped(&objects, |object| &object.name, |number| object_name("", number)),
            // A single material adds nothing to the nodes.
            materials: if materials.len() > 1 { materials } else { Vec::new() },
            count: objects.len(),
            has_parts: model.small_parts(1.0).contains(&true),
        }
    }
}

/// Objects of one name are one row, in the file's order; those without a name are one each, except equal ones of
/// `unnamed`.
fn grouped<'a>(
    objects: &'a [Object],
    name_of: impl Fn(&'a Object) -> &'a String,
    unnamed: impl Fn(u32) -> String,
) -> Vec<Row> {
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut rows: Vec<Row> = Vec::new();
    for (number, object) in (0..).zip(objects) {
        let name = match name_of(object).as_str() {
            "" => unnamed(number),
            name => name.to_owned(),
        };
        let place = *places.entry(name.clone()).or_insert(rows.len());
        if place == rows.len() {
            rows.push(Row {
                name,
                objects: Vec::new(),
                triangles: 0,
            });
        }
        rows[place].objects.push(number);
        rows[place].triangles += object.triangles.iter().map(ExactSizeIterator::len).sum::<usize>();
    }
    rows
}

/// Shows the lists.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let Some(model) = editor.view().model else {
        ui.label(RichText::new("Nothing is open.").weak());
        return;
    };
    // Made once a file: a scene may have thousands.
    let id = egui::Id::unique("rows of objects");
    let kept: Option<Arc<Rows>> = ui.data(|data| data.get_temp(id));
    let rows = kept.filter(|rows| Arc::ptr_eq(&rows.of, model)).unwrap_or_else(|| {
        let rows = Arc::new(Rows::of(model));
        ui.data_mut(|data| data.insert_temp(id, Arc::clone(&rows)));
        rows
    });
    let access = editor.document().access();
    list(ui, "nodes", &rows.nodes, rows.count, access, commands);
    if !rows.materials.is_empty() {
        ui.label(RichText::new("Materials").weak().small());
        list(ui, "materials", &rows.materials, rows.count, access, commands);
    }
    if rows.has_parts {
        small_parts(ui, model, access, commands);
    }
    if let Some(part) = access.isolated {
        let count = model.topology.components()[part as usize].vertex_count;
        let text = format!("Part {} alone ({} vertices)", part + 1, thousands(count));
        ui.label(RichText::new(text).weak().small());
    }
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Isolate, Command::ShowEverything] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}

/// The small parts, and whether they are shown and fixed.
fn small_parts(ui: &mut egui::Ui, model: &Model, access: &Access, commands: &mut Outbox) {
    let small = access.small;
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let hover = "Locked small parts stay fixed, whatever is painted on them.";
            if toggle(ui, Icon::Lock, small.locked, "Lock small parts", hover) {
                commands.push(Command::ToggleSmallLocked);
            }
            let hover = "Hidden small parts can't be picked or painted, but still follow the surface.";
            if toggle(ui, Icon::Eye, !small.hidden, "Show small parts", hover) {
                commands.push(Command::ToggleSmallShown);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let label = ui.add(egui::Label::new("Small parts").truncate());
                let mut percent = 100.0 * small.share;
                let field = number_field(ui, &mut percent, |ui, percent| {
                    let field = dragged(ui, percent, &[("%", 1.0)])
                        .range(0.0..=100.0)
                        .speed(0.05)
                        .suffix(" %");
                    ui.add(field).labelled_by(label.id)
                });
                let field = field.on_hover_ui(|ui| {
                    let count = model.small_parts(small.share).iter().filter(|small| **small).count();
                    let noun = if count == 1 { "part has" } else { "parts have" };
                    ui.label(format!(
                        "{} {noun} fewer vertices than this share of the largest part's.",
                        thousands(count)
                    ));
                });
                let share = percent / 100.0;
                commands.adjust(&field, || Command::SetSmallParts(SmallParts { share, ..small }));
            });
        });
    });
}

fn list(ui: &mut egui::Ui, salt: &str, rows: &[Row], count: usize, access: &Access, commands: &mut Outbox) {
    let height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt(salt)
        .max_height(ROWS * (height + ui.spacing().item_spacing.y))
        .auto_shrink([false, true])
        .show_rows(ui, height, rows.len(), |ui, seen| {
            for number in seen {
                row(ui, &rows[number], count, access, commands);
            }
        });
}

fn row(ui: &mut egui::Ui, row: &Row, count: usize, access: &Access, commands: &mut Outbox) {
    let all = |set: &BTreeSet<u32>| row.objects.iter().all(|object| set.contains(object));
    let (is_hidden, is_locked) = (all(&access.hidden), all(&access.locked));
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let hover = "A locked object stays fixed, whatever is painted on it.";
            if toggle(ui, Icon::Lock, is_locked, &format!("Lock {}", row.name), hover) {
                let action = if is_locked {
                    ObjectAction::Unlock
                } else {
                    ObjectAction::Lock
                };
                commands.push(Command::Objects(action, row.objects.clone()));
            }
            let hover = "A hidden object can't be picked or painted, but still follows the surface.";
            if toggle(ui, Icon::Eye, !is_hidden, &format!("Show {}", row.name), hover) {
                let action = if is_hidden {
                    ObjectAction::Show
                } else {
                    ObjectAction::Hide
                };
                commands.push(Command::Objects(action, row.objects.clone()));
            }
            if row.objects.len() < count {
                let is_alone = !is_hidden && access.hidden.len() + row.objects.len() == count;
                let hover = "Hides all other objects, or shows everything again.";
                if toggle(ui, Icon::Alone, is_alone, &format!("Show only {}", row.name), hover) {
                    commands.push(Command::Objects(ObjectAction::Solo, row.objects.clone()));
                }
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let text = RichText::new(&row.name);
                let text = if is_hidden { text.weak() } else { text };
                ui.add(egui::Label::new(text).truncate())
                    .on_hover_text(format!("{} triangles", thousands(row.triangles)));
            });
        });
    });
}
