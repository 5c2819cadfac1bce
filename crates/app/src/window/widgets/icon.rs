//! Icons, of one font and one weight everywhere: Lucide's.

use eframe::egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use eframe::egui::{self, FontData, FontFamily, FontId, RichText, Sense};
pub use lucide_icons::Icon as Glyph;
use lucide_icons::LUCIDE_FONT_BYTES;

/// The family that contains only the icons' font: its signs share their numbers with those of other fonts.
const FAMILY: &str = "icons";

/// The font of icons of this size.
pub fn font(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name(FAMILY.into()))
}

/// Adds the icons' font to the context.
pub fn install(context: &egui::Context) {
    let family = InsertFontFamily {
        family: FontFamily::Name(FAMILY.into()),
        priority: FontPriority::Highest,
    };
    context.add_font(FontInsert::new(
        "lucide",
        FontData::from_static(LUCIDE_FONT_BYTES),
        vec![family],
    ));
}

/// An icon as text.
pub fn text(glyph: Glyph, size: f32) -> RichText {
    RichText::new(glyph.unicode()).font(font(size))
}

/// A small toggle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Icon {
    /// An eye, crossed out while off.
    Eye,
    /// A padlock, open while off.
    Lock,
    /// A ring, with a dot in it while on.
    Alone,
    /// Arrows apart, or towards each other while on.
    Large,
}

impl Icon {
    fn glyph(self, is_on: bool) -> Glyph {
        match (self, is_on) {
            (Self::Eye, true) => Glyph::Eye,
            (Self::Eye, false) => Glyph::EyeOff,
            (Self::Lock, true) => Glyph::Lock,
            (Self::Lock, false) => Glyph::LockOpen,
            (Self::Alone, true) => Glyph::CircleDot,
            (Self::Alone, false) => Glyph::Circle,
            (Self::Large, true) => Glyph::Minimize2,
            (Self::Large, false) => Glyph::Maximize2,
        }
    }
}

/// A toggle with a name for screen readers; true when it is clicked.
pub fn toggle(ui: &mut egui::Ui, icon: Icon, is_on: bool, name: &str, hover: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_on, name));
    let visuals = ui.visuals();
    let colour = match (response.hovered(), is_on) {
        (true, _) => visuals.strong_text_color(),
        (false, true) => visuals.text_color(),
        (false, false) => visuals.weak_text_color(),
    };
    let sign = icon.glyph(is_on).unicode();
    let painter = ui.painter();
    painter.text(rect.center(), egui::Align2::CENTER_CENTER, sign, font(15.0), colour);
    response.on_hover_text(hover).clicked()
}
