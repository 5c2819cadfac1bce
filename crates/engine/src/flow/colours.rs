//! Dye over a file's own colours.

use pliant_editor::Dye;
use pliant_mesh::{DrawnVertex, Model};

use crate::loading::Loaded;

const MOST: f64 = u16::MAX as f64;

/// A file's colours with a dye for each surface vertex over them, linear and from 0 to 65535, one for each drawn vertex;
/// `None` if nothing is dyed.
pub fn dyed(loaded: &Loaded, dyes: &[Dye]) -> Option<Vec<[u16; 4]>> {
    let dyes: Vec<[f64; 4]> = dyes.iter().map(|dye| dye.map(f64::from)).collect();
    Colours::of(loaded).with(&dyes, &loaded.model)
}

/// The file's own colours, one for each drawn vertex; white if it has none.
pub(super) struct Colours(Vec<[u16; 4]>);

impl Colours {
    pub fn of(loaded: &Loaded) -> Self {
        let own = loaded.scene.appearance().colours;
        let count = loaded.model.drawn.vertex_count();
        Self(own.unwrap_or_else(|| vec![[u16::MAX; 4]; count]))
    }

    /// The colours with a dye for each surface vertex over them (red, green and blue multiplied by the coverage, and the
    /// coverage, from 0 to 1); `None` if nothing is dyed. Vertices without dye keep their colour to the bit.
    pub fn with(&self, dyes: &[[f64; 4]], model: &Model) -> Option<Vec<[u16; 4]>> {
        if dyes.iter().all(|dye| dye[3] == 0.0) {
            return None;
        }
        let colour = |(vertex, own): (u32, &[u16; 4])| {
            let surface = model.drawn.surface_vertex(DrawnVertex(vertex));
            let Some(&[red, green, blue, coverage]) = surface.map(|vertex| &dyes[vertex.index()]) else {
                return *own;
            };
            if coverage == 0.0 {
                return *own;
            }
            // 16 bits, as every kind of file has at most.
            let over = |dye: f64, own: u16| {
                (MOST * dye + (1.0 - coverage) * f64::from(own))
                    .round()
                    .clamp(0.0, MOST) as u16
            };
            [over(red, own[0]), over(green, own[1]), over(blue, own[2]), own[3]]
        };
        Some((0..).zip(&self.0).map(colour).collect())
    }
}
