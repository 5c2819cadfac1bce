//! A number that is dragged or typed; Escape restores it.

use std::ops::RangeInclusive;

use eframe::egui::emath::Numeric;
use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::{Context, DragValue, Id, PointerButton, Response, Slider, TextEdit, Ui, response::Flags};

use super::typed_number;
pub use super::typed_number::{DEGREES, LENGTHS, Unit};
use crate::window::input::event_queue::EventQueue;

/// A field for [`number_field`]. People may type sums and one of `units` in it.
pub fn dragged<'a, N: Numeric>(ui: &Ui, value: &'a mut N, units: &[Unit]) -> DragValue<'a> {
    DragValue::new(value)
        .update_while_editing(false)
        .custom_parser(parser(ui, units))
}

/// A slider for [`number_field`], with the same rules for its number.
pub fn slid<'a, N: Numeric>(ui: &Ui, value: &'a mut N, range: RangeInclusive<N>, units: &[Unit]) -> Slider<'a> {
    Slider::new(value, range)
        .update_while_editing(false)
        .custom_parser(parser(ui, units))
}

/// Shows the field or slider that `add` makes for a value, by [`dragged`] or [`slid`]: a typed number counts when
/// Enter or a click elsewhere ends the typing, and never after Escape.
///
/// egui keeps the text of a field for another frame after it has lost the focus, and would accept it then.
pub fn number_field<N: Copy>(ui: &mut Ui, value: &mut N, add: impl FnOnce(&mut Ui, &mut N) -> Response) -> Response {
    let before = *value;
    let mut response = add(ui, value);
    if response.double_clicked() || is_double_clicked(ui, &response) {
        select_all(ui);
    }
    if EventQueue::has_escaped(ui.ctx()) && !response.dragged() {
        *value = before;
        response.flags.remove(Flags::CHANGED);
        let _ = take_refusal(ui.ctx());
    }
    response
}

/// Returns true if the field's text was double-clicked while it is being typed: the response of a slider has another
/// widget in front.
fn is_double_clicked(ui: &Ui, field: &Response) -> bool {
    let is_double = ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
    is_double && field.contains_pointer()
}

/// Selects all of the text that is being typed, so that the next digit replaces it: egui selects a word, which ends at a
/// sign, a point or a unit.
fn select_all(ui: &Ui) {
    let Some(id) = ui.memory(|memory| memory.focused()) else {
        return;
    };
    if let Some(mut state) = TextEdit::load_state(ui.ctx(), id) {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(usize::MAX));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
}

/// The sentence about a text that was typed into a field in this frame and is not a number.
pub fn take_refusal(context: &Context) -> Option<String> {
    context.data_mut(|data| data.remove_temp(refusal()))
}

fn refusal() -> Id {
    Id::unique("refused number")
}

fn parser(ui: &Ui, units: &[Unit]) -> impl Fn(&str) -> Option<f64> + use<> {
    let (context, units) = (ui.ctx().clone(), units.to_vec());
    move |text| match typed_number::parse(text, &units) {
        Ok(number) => Some(number),
        Err(sentence) => {
            context.data_mut(|data| data.insert_temp(refusal(), sentence));
            context.request_repaint();
            None
        }
    }
}
