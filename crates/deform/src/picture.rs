//! The small picture of a method in lists.

/// The elements that a method works on, as its picture shows them along a bent bar.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Picture {
    /// The bar's outline alone.
    Bar,
    /// A sheet from the side, like a spring.
    Plate,
    /// Neighbourhoods that only turn.
    Blocks,
    /// Slabs side by side.
    Prisms,
    /// A strip of triangles.
    Triangles,
    /// A sheet that is wrinkled where it is bent.
    Waves,
    /// Directions that turn along the bar.
    Arrows,
    /// Details on the bar.
    Spikes,
    /// Axes that turn along the bar.
    Frames,
    /// The effect of each handle around it.
    Circles,
    /// Points, and their moves.
    Moves,
    /// Few nodes that carry the others.
    Graph,
    /// A grid of points around the bar.
    Lattice,
    /// A coarse hull around the bar.
    Hull,
    /// Cubes around the bar, joined by their faces.
    Cells,
}
