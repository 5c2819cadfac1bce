//! A sheet of pictures side by side, each with a name and figures beneath.

use std::sync::Arc;

use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Vec2, pos2, vec2};
use pliant_render::{Image, RenderError, Renderer};

use crate::painting;
use pliant_engine::report::Report;

/// The height of a caption in points: two lines for the title, and one for each figure.
const CAPTION: f32 = 105.0;

/// The least width of a cell in points, if the sheet allows it: narrower ones would need small print.
const NARROWEST: f32 = 140.0;

/// The distance of a text from its cell's border, in points.
const MARGIN: f32 = 10.0;

/// The layout of pictures on a sheet: rows of equal height, each filled by its cells.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Layout {
    sheet_px: [u32; 2],
    count: u32,
    rows: u32,
    /// The height of a caption in pixels.
    caption_px: u32,
    /// The size of a point of text.
    pub pixels_per_point: f32,
}

/// A cell's place on its sheet.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Place {
    /// The upper left corner in pixels.
    pub corner_px: [u32; 2],
    /// The cell's size in pixels, its caption included.
    pub cell_px: [u32; 2],
    /// The picture's size in pixels.
    pub view_px: [u32; 2],
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
    /// The layout of `count` cells on a sheet of this size in which a figure, whose width is `aspect` times its height,
    /// is largest.
    pub fn of(count: usize, sheet_px: [u32; 2], aspect: f32) -> Self {
        let [width, height] = sheet_px.map(|side| side as f32);
        let count = count.max(1) as u32;
        let pixels_per_point = (height / 900.0).min(width / 1100.0).clamp(0.7, 8.0);
        let caption = (CAPTION * pixels_per_point).ceil();
        // The height of the figure; cells that are too narrow for their text come last.
        let figure = |rows: u32| {
            let cell = width / count.div_ceil(rows) as f32;
            let is_legible = cell >= NARROWEST * pixels_per_point;
            (is_legible, (cell / aspect).min(height / rows as f32 - caption))
        };
        let better = |best: u32, rows: u32| if figure(rows) > figure(best) { rows } else { best };
        Self {
            sheet_px,
            count,
            rows: (2..=count).fold(1, better),
            caption_px: caption as u32,
            pixels_per_point,
        }
    }

    /// The number of cells in a row: the upper rows take those that are left over.
    fn columns(&self, row: u32) -> u32 {
        self.count / self.rows + u32::from(row < self.count % self.rows)
    }

    /// The place of a cell, counted row by row. Pixels that the grid does not divide by are spread between the cells.
    pub fn place(&self, cell: usize) -> Place {
        let (mut row, mut column) = (0, cell as u32);
        while column >= self.columns(row) && row + 1 < self.rows {
            column -= self.columns(row);
            row += 1;
        }
        let columns = self.columns(row).max(1);
        let [width, height] = self.sheet_px;
        let corner_px = [column * width / columns, row * height / self.rows];
        let end_px = [(column + 1) * width / columns, (row + 1) * height / self.rows];
        let cell_px = [0, 1].map(|k| (end_px[k] - corner_px[k]).max(1));
        Place {
            corner_px,
            cell_px,
            view_px: [cell_px[0], cell_px[1].saturating_sub(self.caption_px).max(1)],
        }
    }

    /// The size of the narrowest picture in pixels.
    pub fn least_view_px(&self) -> [u32; 2] {
        let places = (0..self.count as usize).map(|cell| self.place(cell).view_px);
        places.fold([u32::MAX; 2], |least, own| [least[0].min(own[0]), least[1].min(own[1])])
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
    /// A method's name and figures, without times: a picture is looked at long after its machine was busy or idle.
    /// `detail` is its detail error over that of the best.
    pub fn bent(title: &str, report: &Report, detail: Option<f64>) -> Self {
        let shape = &report.distortion;
        let mut lines = vec![
            stretch([shape.edge_stretch_mean, shape.edge_stretch_max]),
            format!("volume × {:.3}", shape.volume_ratio),
        ];
        lines.extend(detail.map(|detail| format!("detail's error × {detail:.2}")));
        match shape.flipped_faces {
            0 => {}
            1 => lines.push("1 face flipped".to_owned()),
            count => lines.push(format!("{count} faces flipped")),
        }
        Self {
            title: title.to_owned(),
            lines,
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
        let place = layout.place(number);
        if let Some(picture) = &cell.picture {
            painting::composite(&mut sheet, picture, place.corner_px);
        }
        let size = vec2(place.cell_px[0] as f32, place.cell_px[1] as f32) / layout.pixels_per_point;
        let view = place.view_px[1] as f32 / layout.pixels_per_point;
        let text = painting::picture(renderer, size, layout.pixels_per_point, |painter| {
            write(painter, size, view, &cell.caption);
        })?;
        painting::composite(&mut sheet, &text, place.corner_px);
    }
    Ok(sheet)
}

/// The background of captions.
const PAPER: [u8; 4] = [30, 32, 36, 255];

/// Writes a cell's text: beneath a picture of this height, or a refusal in the picture's place.
fn write(painter: &Painter, size: Vec2, view: f32, caption: &Caption) {
    let (bright, dim) = (Color32::from_gray(235), Color32::from_gray(190));
    painter.rect_filled(
        Rect::from_min_size(pos2(0.0, view), vec2(size.x, size.y - view)),
        0.0,
        Color32::from_rgb(PAPER[0], PAPER[1], PAPER[2]),
    );
    let width = (size.x - 2.0 * MARGIN).max(1.0);
    let mut at: Pos2 = pos2(MARGIN, view + 6.0);
    let title = fitting(painter, &caption.title, 15.0, bright, [width, 2.0]);
    let title_height = title.size().y;
    painter.galley(at, title, bright);
    at.y += title_height + 2.0;
    for line in &caption.lines {
        painter.galley(at, fitting(painter, line, 12.0, dim, [width, 1.0]), dim);
        at.y += 15.0;
    }
    if let Some(refusal) = &caption.refusal {
        let galley = painter.layout(refusal.clone(), FontId::proportional(13.0), bright, width);
        let top = (0.5 * (view - galley.size().y)).max(MARGIN);
        painter.galley(pos2(MARGIN, top), galley, bright);
    }
}

/// A text of at most this size in points, smaller if it would not fit into this width and number of rows.
fn fitting(painter: &Painter, text: &str, mut points: f32, colour: Color32, [width, rows]: [f32; 2]) -> Arc<Galley> {
    loop {
        let galley = painter.layout(text.to_owned(), FontId::proportional(points), colour, width);
        if galley.rows.len() as f32 <= rows || points <= SMALLEST {
            return galley;
        }
        points -= 0.5;
    }
}

/// The size of the smallest print in points.
const SMALLEST: f32 = 6.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_the_sheet_and_lie_apart() {
        for count in 1..18 {
            for (sheet, aspect) in [
                ([1600, 1000], 1.0),
                ([300, 2000], 0.3),
                ([2000, 300], 2.0),
                ([40, 40], 1.0),
            ] {
                let layout = Layout::of(count, sheet, aspect);
                let places: Vec<Place> = (0..count).map(|cell| layout.place(cell)).collect();
                let ends = |place: &Place| [0, 1].map(|k| place.corner_px[k] + place.cell_px[k]);
                for (number, place) in places.iter().enumerate() {
                    let apart = |other: &Place| {
                        (0..2).any(|k| ends(place)[k] <= other.corner_px[k] || ends(other)[k] <= place.corner_px[k])
                    };
                    assert!(places[..number].iter().all(apart), "{count} {sheet:?}");
                    assert!((0..2).all(|k| ends(place)[k] <= sheet[k] && place.view_px[k] <= place.cell_px[k]));
                }
                let area: u32 = places.iter().map(|place| place.cell_px[0] * place.cell_px[1]).sum();
                assert_eq!(area, sheet[0] * sheet[1], "{count} {sheet:?}: no cell is empty");
            }
        }
    }

    #[test]
    fn tall_figures_stand_side_by_side_and_wide_ones_above_each_other() {
        let rows = |aspect| Layout::of(8, [1600, 1000], aspect).rows;
        assert!(rows(0.25) < rows(1.0) && rows(1.0) < rows(4.0));
    }
}
