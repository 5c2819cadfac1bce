//! `pliant render`: a picture of a file, at rest or with an edit applied, as the window shows it.

use std::io::Cursor;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{Camera, Editor, Event, InlineExecutor, JobKind, NamedView, UpAxis};
use pliant_mesh::WeldOptions;
use pliant_render::{Frame, Headless, Image, Samples, Shading, Style};

use super::apply::read_edit;
use super::arguments::{self, PictureSize, RenderArguments, Up, View};
use super::{Console, on_threads};
use crate::drawing::{self, Drawing};
use crate::engine::{self, Loaded};
use crate::watch::Watch;
use crate::{AppError, files};

pub(super) fn run(arguments: &RenderArguments, console: &mut Console<'_>) -> Result<(), AppError> {
    let output = &arguments.output;
    if !output
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
    {
        let output = output.display();
        return Err(AppError::Arguments(format!(
            "--output {output} is no .png: pictures are written as PNG"
        )));
    }
    let style = style(arguments.shading)?;
    let watch = &console.watch;
    let png = on_threads(None, || picture(arguments, &style, watch))??;
    if watch.cancel.is_cancelled() {
        return Err(AppError::Interrupted);
    }
    let name = output.file_name().unwrap_or_default().to_string_lossy();
    console
        .staging
        .stage(files::folder_of(output), [(&*name, &*png)])?
        .commit()?;
    Ok(())
}

fn style(shading: arguments::Shading) -> Result<Style, AppError> {
    let missing = |name| {
        Err(AppError::Unsupported(format!(
            "--shading {name} is not drawn yet: use clay, material or regions"
        )))
    };
    let (shading, region_share) = match shading {
        arguments::Shading::Clay => (Shading::Clay, 0.0),
        arguments::Shading::Material => (Shading::Material, 0.0),
        arguments::Shading::Regions => (Shading::Clay, 1.0),
        arguments::Shading::Stiffness => return missing("stiffness"),
        arguments::Shading::Distortion => return missing("distortion"),
    };
    Ok(Style {
        shading,
        region_share,
        ..Style::default()
    })
}

fn picture(arguments: &RenderArguments, style: &Style, watch: &Watch) -> Result<Vec<u8>, AppError> {
    let loaded = engine::load(&arguments.file, &WeldOptions::default(), watch)?;
    let Some(bounds) = loaded
        .model
        .bounds()
        .filter(|_| !loaded.model.surface.triangles.is_empty())
    else {
        return Err(AppError::NoTriangles(arguments.file.clone()));
    };
    let shape = shape(arguments, &loaded, watch)?;
    let progress = watch.begin("drawing");
    let (drawing, _) = Drawing::new(&loaded.model, loaded.scene.appearance());
    let pose = drawing.pose(&loaded.model, &shape.displacements);
    progress.set(0.3);

    let system = |error: String| AppError::System(error);
    let mut renderer = Headless::new().map_err(|error| system(error.to_string()))?.renderer;
    let refuse = |error: pliant_render::RenderError| system(error.to_string());
    let surface = drawing.upload(&renderer, &pose).map_err(refuse)?;
    surface
        .update_regions(&renderer, &drawing::drawn_colours(&loaded.model, &shape.region_colours))
        .map_err(refuse)?;

    let PictureSize { width, height } = arguments.size;
    let size_px = DVec2::new(f64::from(width), f64::from(height));
    let mut camera = Camera {
        up: up(arguments.up),
        scale: bounds.diagonal(),
        ..Camera::default()
    };
    camera.look_from(view(arguments.view));
    // The rest shape is framed, whatever the edit does, so that before and after compare.
    camera.frame(&loaded.model.surface.positions, size_px);
    camera.distance *= ROOM_FOR_THE_EDIT;
    let eye = drawing::view(&camera, size_px, drawing.centre);
    let frame = Frame {
        view: &eye,
        style,
        surfaces: &[&surface],
        overlays: &[],
    };
    let image = renderer
        .draw_to_image([width, height], Samples::Four, &frame)
        .map_err(refuse)?;
    progress.set(0.9);
    png(image)
}

/// How much farther the eye stands than the rest shape alone wants, since the bent one is to be seen whole, too.
const ROOM_FOR_THE_EDIT: f64 = 1.2;

/// What is drawn, per surface vertex.
struct Shape {
    displacements: Arc<Vec<DVec3>>,
    region_colours: Vec<[u8; 4]>,
}

/// The shape and the regions that the window shows when it has opened the file with the edit and come to rest.
fn shape(arguments: &RenderArguments, loaded: &Loaded, watch: &Watch) -> Result<Shape, AppError> {
    let edit = arguments.edit.as_deref().map(read_edit).transpose()?;
    if let (Some(edit), Some(path)) = (&edit, &arguments.edit) {
        // The same refusals as `apply`, before the editor makes the best of it.
        edit.resolve(&loaded.model).map_err(|source| AppError::Edit {
            edit: path.clone(),
            source,
        })?;
    }
    let progress = watch.begin("bending");
    let executor = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(executor.clone()));
    editor.handle(Event::Opened {
        model: Arc::clone(&loaded.model),
        name: String::new(),
        beginning: edit,
    });
    while let Some(kind) = executor.waiting().first().copied() {
        if watch.cancel.is_cancelled() {
            return Err(AppError::Interrupted);
        }
        let Some(job) = executor.take(kind) else { break };
        // Nobody points at a picture.
        if kind != JobKind::Pick {
            editor.handle(Event::JobDone(job.run()));
        }
    }
    progress.set(1.0);
    let seen = editor.view();
    if let Some(problem) = seen.problem {
        return Err(AppError::System(format!("{}: {problem}", arguments.file.display())));
    }
    let displacements = Arc::clone(seen.displacements);
    let mut region_colours = Vec::new();
    editor.region_colours(&mut region_colours);
    Ok(Shape {
        displacements,
        region_colours,
    })
}

fn png(picture: Image) -> Result<Vec<u8>, AppError> {
    let refuse = |reason: String| AppError::System(format!("the picture can't be written as PNG: {reason}"));
    let Image { width, height, rgba } = picture;
    let image = image::RgbaImage::from_raw(width, height, rgba).ok_or_else(|| refuse("it is incomplete".to_owned()))?;
    let mut png = Cursor::new(Vec::new());
    image
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| refuse(error.to_string()))?;
    Ok(png.into_inner())
}

fn up(up: Up) -> UpAxis {
    match up {
        Up::Y => UpAxis::Y,
        Up::Z => UpAxis::Z,
    }
}

fn view(view: View) -> NamedView {
    match view {
        View::Front => NamedView::Front,
        View::Back => NamedView::Back,
        View::Left => NamedView::Left,
        View::Right => NamedView::Right,
        View::Top => NamedView::Top,
        View::Bottom => NamedView::Bottom,
        View::ThreeQuarter => NamedView::ThreeQuarter,
    }
}
