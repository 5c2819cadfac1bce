//! The views beside the main one: of the file's shape, and of each method's result.

use super::before::{OriginalView, Split};
use super::method_views::MethodViews;
use super::skins::SkinViews;

/// The views that are shown along with the main one.
#[derive(Default)]
pub struct ViewsBeside {
    /// The shape of the file, while it is shown along with the present one.
    pub original: Option<OriginalView>,
    /// The position of the line between both.
    pub split: Split,
    /// The ghosts of other moments.
    pub skins: SkinViews,
    /// The small views of each method's result, while methods are compared.
    pub methods: MethodViews,
}

impl ViewsBeside {
    /// Lets the views go, whose device was lost.
    pub fn let_go(&mut self) {
        self.original = None;
        self.skins = SkinViews::default();
        self.methods = MethodViews::default();
    }
}
