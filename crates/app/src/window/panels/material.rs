//! The slider of a method's declaration, on a logarithmic scale.

use eframe::egui::{self, Slider, SliderClamping};
use pliant_deform::OptionValue;
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the slider, if the method has one and its option has an effect.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    let Some(scale) = method.declaration().slider else {
        return;
    };
    let mut options = method.declaration().options.iter();
    let option = options.find(|option| option.name == scale.option);
    if option.is_none_or(|option| option.idle_because(|other| method.value(other)).is_some()) {
        return;
    }
    let Some(OptionValue::Number(mut value)) = method.value(scale.option) else {
        return;
    };
    let ([least, most], [first, last]) = (scale.range, scale.ends);
    ui.horizontal(|ui| {
        let label = row_label(ui, first);
        let slider = Slider::new(&mut value, least..=most)
            .logarithmic(true)
            .show_value(false);
        // A value beyond the ends stays until somebody moves it.
        let slider = slider.clamping(SliderClamping::Never);
        let slider = ui.add(slider).labelled_by(label.id).on_hover_text(scale.help);
        ui.label(last);
        commands.adjust(&slider, || {
            let set = method.with([(scale.option, OptionValue::Number(value))]);
            Command::SetMethod(set.unwrap_or_else(|_| method.clone()))
        });
    });
}
