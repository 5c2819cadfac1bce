//! The bending of a method's material as one slider, on a logarithmic scale: discrete shells from paper to rubber,
//! ARAP's smooth energy from rigid to smooth.

use eframe::egui::{self, Slider, SliderClamping};
use pliant_deform::{Arap, ArapEnergy, Method, OptionValue, Shells};
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// A slider of one of a method's options.
struct Scale {
    option: &'static str,
    ends: [&'static str; 2],
    range: [f64; 2],
    help: &'static str,
}

fn scale(method: &Method) -> Option<Scale> {
    if method.options::<Shells>().is_some() {
        return Some(Scale {
            option: "bending",
            ends: ["Paper", "rubber"],
            range: Shells::PAPER_TO_RUBBER,
            help: "Paper keeps its lengths and creases; thick rubber bends evenly and stretches. The slider sets \
                   `bending`.",
        });
    }
    let arap = method.options::<Arap>()?;
    (arap.energy == ArapEnergy::Smooth).then_some(Scale {
        option: "smoothness",
        ends: ["Rigid", "smooth"],
        range: RIGID_TO_SMOOTH,
        help: "Rigid keeps details and bends only where it must; smooth spreads the bend evenly. The slider sets \
               `smoothness`.",
    })
}

/// From a hundredth of the default to a hundred times it: the logarithmic slider begins in its middle.
const RIGID_TO_SMOOTH: [f64; 2] = [3e-5, 0.3];

/// Shows the slider, if the method has one.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    let Some(scale) = scale(method) else { return };
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
