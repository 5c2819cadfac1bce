//! Dye over a file's own colours.

use std::path::Path;

use pliant_editor::Dye;
use pliant_io::Format;
use pliant_mesh::{DrawnVertex, Model};

use crate::coloured;
use crate::loading::Loaded;

const MOST: f64 = u16::MAX as f64;

/// A file's colours with a dye for each surface vertex over them, linear and from 0 to 65535, one for each drawn vertex;
/// `None` if nothing is dyed.
fn dyed(loaded: &Loaded, dyes: &[Dye]) -> Option<Vec<[u16; 4]>> {
    let dyes: Vec<[f64; 4]> = dyes.iter().map(|dye| dye.map(f64::from)).collect();
    Colours::of(loaded).with(&dyes, &loaded.model)
}

/// Vertex colours to save, if there are some, or a sentence that says why the file can't have them.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct ColoursToSave {
    /// Linear, from 0 to 65535, one for each drawn vertex.
    pub colours: Option<Vec<[u16; 4]>>,
    /// The sentence.
    pub lost: Option<String>,
}

/// The colours of a save of a file with dye that was kept over its own: `output` gives the format.
pub fn with_dye(loaded: &Loaded, dyes: &[Dye], output: &Path, as_morph: bool) -> ColoursToSave {
    let scene = &loaded.scene;
    let holds = Format::of_name(&output.to_string_lossy()).is_ok_and(|format| match as_morph {
        true => coloured::targets_take_colours(scene),
        false => scene.takes_colours(format),
    });
    match dyed(loaded, dyes) {
        Some(_) if !holds => ColoursToSave {
            colours: None,
            lost: Some(WITHOUT_COLOURS.to_owned()),
        },
        colours => ColoursToSave { colours, lost: None },
    }
}

/// The sentence about colours that are not saved.
const WITHOUT_COLOURS: &str =
    "This kind of file takes no new vertex colours, so the kept dye is not in it: save as GLB, PLY or OBJ, too.";

/// `sha256:` and the digest of a file's own colours.
pub fn colour_hash(loaded: &Loaded) -> String {
    let colours = loaded.scene.appearance().colours.unwrap_or_default();
    let bytes = colours.iter().flatten().flat_map(|channel| channel.to_le_bytes());
    pliant_editor::digest(&bytes.collect::<Vec<u8>>())
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
