//! A sheet of pictures side by side, each with a name and figures beneath.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Vec2, pos2, vec2};
use pliant_render::{Image, RenderError, Renderer};

use crate::painting;
use pliant_engine::report::Report;

/// The height of a caption in points.
const CAPTION: f32 = 76.0;

/// The layout of pictures on a sheet.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Layout {
    /// The sheet's size in pixels.
    pub sheet_px: [u32; 2],
    /// The number of cells in a row, and the number of rows.
    pub grid: [u32; 2],
    /// A cell's size in pixels, its caption included.
    pub cell_px: [u32; 2],
    /// A picture's size in pixels.
    pub view_px: [u32; 2],
    /// The size of a point of text.
    pub pixels_per_point: f32,
}

/// A picture and the text beneath it.
#[derive(Clone, Debug)]
pub struct Cell {
    /// `None` if there is nothing to show.
    pub picture: Option<Image>,
    /// The text.
    pub caption: Caption,
}

/// The text beneath a picture.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Caption {
    title: String,
    lines: Vec<String>,
    /// The reason why there is no picture.
    refusal: Option<String>,
}

impl Layout {
    /// The layout of so many cells on a sheet of this size that makes the pictures' shorter side longest.
    pub fn of(count: usize, sheet_px: [u32; 2]) -> Self {
        let [width, height] = sheet_px;
        let count = count.max(1) as u32;
        let pixels_per_point = (height as f32 / 900.0).min(width as f32 / 1100.0).clamp(0.4, 8.0);
        let caption = (CAPTION * pixels_per_point).ceil() as u32;
        let columns = columns(count, [width as f32, height as f32], caption as f32);
        let rows = count.div_ceil(columns);
        let cell_px = [(width / columns).max(1), (height / rows).max(1)];
        Self {
            sheet_px,
            grid: [columns, rows],
            cell_px,
            view_px: [cell_px[0], cell_px[1].saturating_sub(caption).max(1)],
            pixels_per_point,
        }
    }

    /// The upper left corner of a cell. Pixels that the grid does not divide by are spread between the cells.
    fn corner_px(&self, cell: usize) -> [u32; 2] {
        let [columns, rows] = self.grid;
        let place = [cell as u32 % columns, cell as u32 / columns];
        [
            place[0] * self.sheet_px[0] / columns,
            place[1] * self.sheet_px[1] / rows,
        ]
    }
}

/// The number of columns that makes the shorter side of so many pictures longest in an area of this size, with a
/// caption of this height beneath each; the fewest of equals.
pub fn columns(count: u32, [width, height]: [f32; 2], caption: f32) -> u32 {
    let side = |columns: u32| {
        let rows = count.div_ceil(columns);
        (width / columns as f32).min(height / rows as f32 - caption)
    };
    (2..=count).fold(
        1,
        |best, columns| if side(columns) > side(best) { columns } else { best },
    )
}

/// The times of binding and of a frame.
pub fn times(bind_ms: f64, frame_ms: f64) -> String {
    format!("bind {}   frame {}", time(bind_ms), time(frame_ms))
}

/// The mean and the largest stretch of the edges.
pub fn stretch([mean, largest]: [f64; 2]) -> String {
    format!("stretch {mean:.3}, at most {largest:.2}")
}

impl Caption {
    /// A method's name and figures. `detail` is its detail error over that of the best.
    pub fn bent(title: &str, report: &Report, detail: Option<f64>) -> Self {
        let (frames, shape) = (&report.frames, &report.distortion);
        let mut last = format!("volume × {:.3}", shape.volume_ratio);
        if let Some(detail) = detail {
            last += &format!("   detail's error {detail:.2} × the best");
        }
        match shape.flipped_faces {
            0 => {}
            1 => last += "   1 face flipped",
            count => last += &format!("   {count} faces flipped"),
        }
        Self {
            title: title.to_owned(),
            lines: vec![
                times(report.bind_ms, frames.median_ms),
                stretch([shape.edge_stretch_mean, shape.edge_stretch_max]),
                last,
            ],
            refusal: None,
        }
    }

    /// A method's name, and the sentence by which it refused.
    pub fn refused(title: &str, sentence: &str) -> Self {
        Self {
            title: title.to_owned(),
            lines: Vec::new(),
            refusal: Some(sentence.to_owned()),
        }
    }
}

/// Milliseconds in words.
fn time(ms: f64) -> String {
    match ms {
        ms if ms < 10.0 => format!("{ms:.2} ms"),
        ms if ms < 1000.0 => format!("{ms:.0} ms"),
        ms => format!("{:.1} s", ms / 1000.0),
    }
}

/// The whole sheet.
///
/// # Errors
/// Out of memory, or the device does not respond.
pub fn compose(renderer: &Renderer, layout: &Layout, cells: &[Cell]) -> Result<Image, RenderError> {
    let [width, height] = layout.sheet_px;
    let mut sheet = Image {
        width,
        height,
        rgba: PAPER.repeat(width as usize * height as usize),
    };
    for (number, cell) in cells.iter().enumerate() {
        let corner = layout.corner_px(number);
        if let Some(picture) = &cell.picture {
            painting::composite(&mut sheet, picture, corner);
        }
        let size = vec2(layout.cell_px[0] as f32, layout.cell_px[1] as f32) / layout.pixels_per_point;
        let view = layout.view_px[1] as f32 / layout.pixels_per_point;
        let text = painting::picture(renderer, size, layout.pixels_per_point, |painter| {
            write(painter, size, view, &cell.caption);
        })?;
        painting::composite(&mut sheet, &text, corner);
    }
    Ok(sheet)
}

/// The background of captions.
const PAPER: [u8; 4] = [30, 32, 36, 255];

/// Writes a cell's text: beneath a picture of this height, or a refusal in the picture's place.
fn write(painter: &Painter, size: Vec2, view: f32, caption: &Caption) {
    let (bright, dim) = (Color32::from_gray(235), Color32::from_gray(190));
    let margin = 12.0;
    painter.rect_filled(
        Rect::from_min_size(pos2(0.0, view), vec2(size.x, size.y - view)),
        0.0,
        Color32::from_rgb(PAPER[0], PAPER[1], PAPER[2]),
    );
    let mut at: Pos2 = pos2(margin, view + 14.0);
    painter.text(
        at,
        Align2::LEFT_CENTER,
        &caption.title,
        FontId::proportional(15.0),
        bright,
    );
    for line in &caption.lines {
        at.y += 17.0;
        painter.text(at, Align2::LEFT_CENTER, line, FontId::proportional(12.0), dim);
    }
    if let Some(refusal) = &caption.refusal {
        let galley = painter.layout(
            refusal.clone(),
            FontId::proportional(13.0),
            bright,
            size.x - 2.0 * margin,
        );
        let top = (0.5 * (view - galley.size().y)).max(margin);
        painter.galley(pos2(margin, top), galley, bright);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_lie_within_the_sheet_and_apart() {
        for count in 1..14 {
            for sheet in [[1600, 1000], [300, 2000], [2000, 300], [40, 40]] {
                let layout = Layout::of(count, sheet);
                let corners: Vec<[u32; 2]> = (0..count).map(|cell| layout.corner_px(cell)).collect();
                for (number, corner) in corners.iter().enumerate() {
                    assert!(corner[0] + layout.cell_px[0] <= sheet[0] && corner[1] + layout.cell_px[1] <= sheet[1]);
                    assert!(!corners[..number].contains(corner), "{count} {sheet:?}");
                }
                assert!(layout.view_px[0] <= layout.cell_px[0] && layout.view_px[1] <= layout.cell_px[1]);
            }
        }
        assert_eq!(Layout::of(6, [1600, 1000]).grid, [3, 2]);
    }
}
