//! One edit by several methods, in one picture and as data.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_deform::Method;
use pliant_editor::{Beginning, Camera, Look};
use pliant_engine::report::{Report, detail_error};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, Solved};
use pliant_mesh::{Model, SurfaceVertex};
use pliant_render::{Background, Frame, Headless, Image, Samples};
use serde::Serialize;

use crate::camera::looking;
use crate::drawing::{self, Drawing};
use crate::options::{LookOptions, PictureSize, Shading};
use crate::shape::{Posed, Shape};
use crate::sheet::{self, Caption, Cell, Layout};
use crate::subject::resolved;
use crate::uploaded::{Uploaded, refuse, upload};
use crate::{legend, painting, picture_file};

/// The input of [`compare`].
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The file to bend.
    pub loaded: &'a Loaded,
    /// The edit, as it was read.
    pub edit: &'a Beginning,
    /// The edit's file, or its name in messages.
    pub edit_place: &'a Path,
    /// The methods.
    pub methods: &'a [Asked],
    /// Replays the edit as a drag of this many frames; `None` is one solve to the target.
    pub frames: Option<usize>,
    /// The sheet's size in pixels.
    pub size: PictureSize,
    /// The view and the colours.
    pub look: LookOptions,
}

/// A method as requested.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The words of the request: `arap`, or `arap:energy=smooth`.
    pub name: String,
    /// The method.
    pub method: Method,
}

impl Asked {
    /// Its name for a person, with the options that are set.
    fn title(&self) -> String {
        let title = self.method.declaration().paper_title();
        match self.name.split_once(':') {
            Some((_, options)) => format!("{title} ({})", options.replace(':', ", ").replace('=', " ")),
            None => title,
        }
    }
}

/// The output of [`compare`].
#[derive(Clone, Debug)]
pub struct Compared {
    /// The picture as PNG.
    pub sheet: Vec<u8>,
    /// The report as JSON.
    pub report: String,
    /// The figures as a table for a person.
    pub table: String,
    /// Notes for a person on each method's shape, as sentences that begin with its name.
    pub warnings: Vec<String>,
}

/// The result of one method.
#[derive(Serialize)]
#[serde(untagged)]
enum Outcome {
    Bent {
        #[serde(flatten)]
        report: Box<Report>,
        /// See [`detail_error`].
        detail_error: f64,
        /// The same over the best method's, at least 1; `None` if the best has none.
        detail_error_ratio: Option<f64>,
        #[serde(skip)]
        surface_positions: Vec<DVec3>,
    },
    Refused {
        /// The sentence.
        refused: String,
    },
}

#[derive(Serialize)]
struct SheetReport<'a> {
    methods: BTreeMap<&'a str, &'a Outcome>,
}

/// Bends a file with one edit by each of the methods, and draws the results side by side.
///
/// # Errors
/// The edit does not fit the file, every method refuses it, or it can't be drawn.
pub fn compare(job: &Comparison<'_>, watch: &Watch) -> Result<Compared, EngineError> {
    let Comparison { methods, .. } = *job;
    let edit = resolved(job.edit, job.edit_place, job.loaded, watch)?.edit;
    let mut outcomes = Vec::with_capacity(methods.len());
    for method in methods {
        outcomes.push(outcome(job, method, watch)?);
    }
    if let Some(refusal) = outcomes.iter().find_map(|outcome| match outcome {
        Outcome::Refused { refused } => Some(refused),
        Outcome::Bent { .. } => None,
    }) && outcomes
        .iter()
        .all(|outcome| matches!(outcome, Outcome::Refused { .. }))
    {
        return Err(EngineError::System(format!("every method refuses the edit: {refusal}")));
    }
    rank_details(&mut outcomes);
    let image = draw(job, edit, &outcomes, watch)?;
    let report = SheetReport {
        methods: methods.iter().map(|asked| asked.name.as_str()).zip(&outcomes).collect(),
    };
    Ok(Compared {
        sheet: picture_file::png(image)?,
        table: table(methods, &outcomes),
        warnings: warnings(methods, &outcomes),
        // Structs of numbers, strings and lists always serialise.
        report: serde_json::to_string_pretty(&report).unwrap_or_default() + "\n",
    })
}

/// The result of a method for the edit: a refusal is a result as well.
///
/// # Errors
/// It was interrupted, or a file that the edit names can't be read a second time.
fn outcome(job: &Comparison<'_>, asked: &Asked, watch: &Watch) -> Result<Outcome, EngineError> {
    let mut edit = job.edit.clone();
    if edit.method_name() != asked.name {
        edit.set_method(asked.method.clone());
    }
    let fitting = resolved(&edit, job.edit_place, job.loaded, watch)?;
    let (file, model) = (&job.loaded.path, &job.loaded.model);
    match pliant_engine::solved(file, &fitting.edit, job.frames, job.loaded, &fitting.setup, watch) {
        Ok(Solved {
            surface_positions,
            report,
            ..
        }) => Ok(Outcome::Bent {
            detail_error: detail_error(model, &surface_positions),
            report: Box::new(report),
            detail_error_ratio: None,
            surface_positions,
        }),
        Err(_) if watch.cancel.is_cancelled() => Err(EngineError::Interrupted),
        Err(refused) => Ok(Outcome::Refused {
            refused: refused.to_string(),
        }),
    }
}

fn warnings(methods: &[Asked], outcomes: &[Outcome]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (asked, outcome) in methods.iter().zip(outcomes) {
        if let Outcome::Bent { report, .. } = outcome {
            let worded = report
                .warnings
                .iter()
                .map(|warning| format!("{}: {warning}", asked.name));
            warnings.extend(worded);
        }
    }
    warnings
}

/// A line for each method: its times, its stretch, and how well it keeps volume and details.
fn table(methods: &[Asked], outcomes: &[Outcome]) -> String {
    let mut rows = vec![
        [
            "method",
            "bind ms",
            "frame ms",
            "stretch",
            "largest",
            "flipped",
            "volume",
            "detail's error",
        ]
        .map(str::to_owned),
    ];
    let mut refusals = String::new();
    for (asked, outcome) in methods.iter().zip(outcomes) {
        match outcome {
            Outcome::Bent {
                report,
                detail_error_ratio,
                ..
            } => {
                let shape = &report.distortion;
                rows.push([
                    asked.name.clone(),
                    format!("{:.1}", report.bind_ms),
                    format!("{:.2}", report.frames.median_ms),
                    format!("{:.3}", shape.edge_stretch_mean),
                    format!("{:.2}", shape.edge_stretch_max),
                    shape.flipped_faces.to_string(),
                    format!("{:.3}", shape.volume_ratio),
                    detail_error_ratio.map_or_else(|| "-".to_owned(), |error| format!("{error:.2}")),
                ]);
            }
            Outcome::Refused { refused } => refusals += &format!("{}: {refused}\n", asked.name),
        }
    }
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    let line = |row: &[String; 8]| {
        let cells = row
            .iter()
            .zip(&widths)
            .enumerate()
            .map(|(column, (cell, &width))| match column {
                0 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            });
        cells.collect::<Vec<_>>().join("  ") + "\n"
    };
    rows.iter().map(line).collect::<String>() + &refusals
}

/// Divides each method's detail error by the least of them.
fn rank_details(outcomes: &mut [Outcome]) {
    let error = |outcome: &Outcome| match outcome {
        Outcome::Bent { detail_error, .. } => Some(*detail_error),
        Outcome::Refused { .. } => None,
    };
    let Some(least) = outcomes.iter().filter_map(error).min_by(f64::total_cmp) else {
        return;
    };
    for outcome in outcomes {
        if let Outcome::Bent {
            detail_error,
            detail_error_ratio,
            ..
        } = outcome
            && least > 0.0
        {
            *detail_error_ratio = Some(*detail_error / least);
        }
    }
}

/// The sheet: each method's shape from the same side, with its name and figures beneath.
fn draw(job: &Comparison<'_>, edit: Beginning, outcomes: &[Outcome], watch: &Watch) -> Result<Image, EngineError> {
    let Comparison { loaded, methods, .. } = *job;
    let model = &loaded.model;
    let mut shape = Shape::of(loaded, Some(edit), Posed::AtRest, watch)?;
    let progress = watch.begin("drawing");
    let drawing = Drawing::new(model, loaded.scene.appearance(), Arc::default());
    let mut renderer = Headless::new().map_err(refuse)?.renderer;
    let (camera, layout) = camera_and_layout(job, model, outcomes);
    let regions = job.look.shading == Shading::Regions;
    let look = Look {
        shading: job.look.shading.of_editor(),
        regions,
        outlines: regions,
        ..Look::default()
    };
    let mut style = drawing::style(&look, layout.pixels_per_point);
    style.background = Background::default();
    let mut cells = Vec::with_capacity(methods.len());
    for (number, (asked, outcome)) in methods.iter().zip(outcomes).enumerate() {
        if watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let title = &asked.title();
        let view_px = layout.place(number).view_px;
        let view = drawing::view(&camera, in_pixels(view_px), drawing.centre());
        cells.push(match outcome {
            Outcome::Refused { refused } => Cell {
                picture: None,
                caption: Caption::refused(title, refused),
            },
            Outcome::Bent {
                report,
                detail_error_ratio,
                surface_positions,
                ..
            } => {
                let rest = model.surface.positions.iter();
                let displacements = surface_positions.iter().zip(rest).map(|(bent, rest)| *bent - *rest);
                shape.displacements = Arc::new(displacements.collect());
                let pose = drawing.pose(model, &shape.displacements);
                let Uploaded { surface, scale, .. } =
                    upload(&renderer, &drawing, &pose, model, &shape, &look, &watch.cancel)?;
                let frame = Frame {
                    view: &view,
                    style: &style,
                    surfaces: &[&surface],
                    grid: None,
                    overlays: &[],
                };
                let mut picture = renderer.draw_to_image(view_px, Samples::Four, &frame).map_err(refuse)?;
                if let Some(scale) = scale.filter(|_| number == 0) {
                    let legend = legend::picture(&renderer, &scale, layout.pixels_per_point);
                    painting::composite(&mut picture, &legend.map_err(refuse)?, [8; 2]);
                }
                Cell {
                    picture: Some(picture),
                    caption: Caption::bent(title, report, *detail_error_ratio),
                }
            }
        });
        progress.set((number + 1) as f32 / methods.len() as f32);
    }
    sheet::compose(&renderer, &layout, &cells).map_err(refuse)
}

/// If a shape is more than this many times as large as the rest shape, only its part in view is shown.
const TOO_FAR: f64 = 3.0;

fn in_pixels(size_px: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]))
}

/// A camera that sees every shape that is not far larger than the rest shape, and the layout in which it sees them
/// largest. If there is none, it sees the rest shape.
fn camera_and_layout(job: &Comparison<'_>, model: &Model, outcomes: &[Outcome]) -> (Camera, Layout) {
    let diagonal = |positions: &[DVec3]| pliant_mesh::bounding_box(positions).map_or(0.0, |bounds| bounds.diagonal());
    let vertices: Vec<usize> = model.vertices_without_specks().map(SurfaceVertex::index).collect();
    let seen_of = |positions: &[DVec3]| -> Vec<DVec3> { vertices.iter().map(|&v| positions[v]).collect() };
    let rest = seen_of(&model.surface.positions);
    let own = diagonal(&rest);
    let bent = outcomes.iter().filter_map(|outcome| match outcome {
        Outcome::Bent { surface_positions, .. } => Some(seen_of(surface_positions)),
        Outcome::Refused { .. } => None,
    });
    let mut seen: Vec<DVec3> = bent.filter(|shape| diagonal(shape) < TOO_FAR * own).flatten().collect();
    if seen.is_empty() {
        seen = rest;
    }
    let mut camera = looking(job.look, model, own);
    let seen_from = camera.axes().transpose();
    let extent = pliant_mesh::bounding_box(&seen.iter().map(|p| seen_from * *p).collect::<Vec<_>>())
        .map_or(DVec3::ONE, |bounds| bounds.extent());
    // Even a figure that is a line leaves room for its neighbours.
    let aspect = (extent.x / extent.y).clamp(0.1, 10.0);
    let PictureSize { width, height } = job.size;
    let layout = Layout::of(outcomes.len(), [width, height], aspect as f32);
    camera.frame(&seen, in_pixels(layout.least_view_px()));
    (camera, layout)
}
