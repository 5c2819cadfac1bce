//! The role of a surface vertex, and that of a component that nothing holds.

/// The role of a surface vertex.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Role {
    /// It keeps its position.
    Fixed,
    /// The method determines its position.
    #[default]
    Free,
    /// It moves with the handle of this number.
    Handle(u16),
}

/// The behaviour of a connected component without a handle and without a fixed vertex.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Loose {
    /// It moves rigidly with the part that it touches: the deformed surface, or a larger part that follows. If it
    /// touches neither, it moves with the nearest part of the deformed surface. This suits eyes, buttons and straps.
    #[default]
    Follow,
    /// It keeps its position.
    Rest,
    /// Each place on it moves with the nearest part of the deformed surface: a strap bends along with the surface below
    /// it.
    Bend,
}
