//! The outlines of regions as lines on the surface: each handle's in its own colour, and a pale one between the free
//! and the fixed region. Every line has a wider, dark casing, so that it is visible on any shading.

use pliant_editor::{Editor, Rim};
use pliant_mesh::{ContourLine, Model};
use pliant_render::{EdgePoint, SurfaceLine};

const HELD_COLOUR: [u8; 4] = [238, 238, 232, 255];
const CASING_COLOUR: [u8; 4] = [24, 25, 28, 255];

/// Widths in points.
const HANDLE_WIDTH: f32 = 2.2;
const SELECTED_WIDTH: f32 = 3.4;
const HELD_WIDTH: f32 = 1.4;
/// Width of the casing on each side of a line.
const CASING_WIDTH: f32 = 1.1;

/// The outlines of the editor's regions on `model`, in draw order: casings, the held region, handles, the selected
/// handle.
pub fn outlines(editor: &Editor, model: &Model) -> Vec<SurfaceLine> {
    let view = editor.view();
    let mut lines: Vec<(f32, SurfaceLine)> = Vec::new();
    for (line, rim) in editor.rims() {
        let (width_points, colour) = match rim {
            Rim::Held => (HELD_WIDTH, HELD_COLOUR),
            Rim::Handle(id) => {
                let colour = editor.document().handle(id).map_or(HELD_COLOUR, |handle| handle.colour);
                let is_selected = view.selected == Some(id);
                (if is_selected { SELECTED_WIDTH } else { HANDLE_WIDTH }, colour)
            }
        };
        if let Some(ends) = drawn_ends(line, model) {
            let line = SurfaceLine {
                ends,
                colour,
                width_points,
            };
            lines.push((width_points, line));
        }
    }
    lines.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let casings = lines.iter().map(|(_, line)| SurfaceLine {
        colour: CASING_COLOUR,
        width_points: line.width_points + 2.0 * CASING_WIDTH,
        ..*line
    });
    casings.chain(lines.iter().map(|&(_, line)| line)).collect()
}

/// A line's ends on the edges of the drawn triangle of its surface triangle.
fn drawn_ends(line: &ContourLine, model: &Model) -> Option<[EdgePoint; 2]> {
    let triangle = line.triangle as usize;
    let corners = (triangle < model.surface.triangles.len()).then(|| model.drawn_corners(triangle))?;
    Some(line.ends.map(|end| EdgePoint {
        vertices: end.corners.map(|corner| corners[usize::from(corner)].0),
        share: end.share,
    }))
}
