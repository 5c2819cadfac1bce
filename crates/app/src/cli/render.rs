//! `pliant render`: a picture of a file, at rest or with an edit applied, as the window shows it.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{
    Before, Beginning, Camera, Editor, Event, InlineExecutor, JobKind, Look, NamedView, Projection, Setup, Shading,
    UpAxis,
};
use pliant_mesh::{Cancel, Model, WeldOptions, bounding_box};
use pliant_render::{Background, Frame, Headless, RenderError, Renderer, Samples, Surface, SurfaceLine};

use super::picture_arguments::{self, PictureSize, ProjectionName, RenderArguments, Up, View};
use super::shared_arguments::{ComputeArguments, WeldArguments};
use crate::cli::console::{Console, print};
use crate::cli::threads::on_threads;
use crate::drawing::{self, Drawing, Pose, Scale};
use crate::{legend, painting, picture_file};
use pliant_engine::files::Destination;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, examples, files, read_edit};

pub(super) fn run(arguments: &RenderArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    check_png(&arguments.output)?;
    let watch = &console.watch;
    let paths = paths(arguments);
    let given = [("FILE", &*arguments.file)].into_iter();
    let given = given.chain(arguments.edit.as_deref().map(|edit| ("--edit", edit)));
    for path in &paths {
        files::refuse_shared(("--output", path), given.clone())?;
        // A name that is not a file's is refused before anything is drawn.
        Destination::of(path)?;
    }
    let Pictures { pngs, notes } = on_threads(ComputeArguments::default(), || pictures(arguments, &paths, watch))??;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let files = paths.into_iter().zip(pngs.iter().map(Vec::as_slice));
    console.staging.stage(files)?.commit()?;
    let lines: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
    print(console.out, &lines)
}

/// Refuses a name without a picture's extension.
pub(super) fn check_png(output: &Path) -> Result<(), EngineError> {
    let extension = output.extension();
    if extension.is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        return Ok(());
    }
    let output = files::shown(output);
    Err(EngineError::Arguments(format!(
        "--output {output} is not a .png: give a name that ends with .png"
    )))
}

/// The pictures.
struct Pictures {
    pngs: Vec<Vec<u8>>,
    /// The parts of the file that they don't show, a sentence each.
    notes: Vec<String>,
}

/// The paths of the pictures.
fn paths(arguments: &RenderArguments) -> Vec<PathBuf> {
    let output = &arguments.output;
    let Some(count) = arguments.turntable else {
        return vec![output.clone()];
    };
    let numbered = |number: u32| {
        let mut name = output.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{number:04}.png"));
        output.with_file_name(name)
    };
    (1..=count).map(numbered).collect()
}

/// The look of the surface that the arguments request.
fn look(arguments: &RenderArguments) -> Look {
    Look {
        shading: shading(arguments.look.shading),
        clay: arguments.clay,
        flat: arguments.flat,
        wireframe: arguments.wireframe,
        borders: arguments.borders,
        regions: arguments.look.shading == picture_arguments::Shading::Regions,
        outlines: arguments.outlines || arguments.look.shading == picture_arguments::Shading::Regions,
        grid: arguments.grid,
        shadow: arguments.shadow,
        original: false,
        base: false,
        before: Before::Off,
    }
}

/// The editor's shading for that of the arguments.
pub(super) fn shading(shading: picture_arguments::Shading) -> Shading {
    match shading {
        picture_arguments::Shading::Clay | picture_arguments::Shading::Regions => Shading::Clay,
        picture_arguments::Shading::Material => Shading::Material,
        picture_arguments::Shading::Stiffness => Shading::Stiffness,
        picture_arguments::Shading::Distortion => Shading::Stretch,
        picture_arguments::Shading::Area => Shading::Area,
        picture_arguments::Shading::Curvature => Shading::Curvature,
        picture_arguments::Shading::Zebra => Shading::Zebra,
        picture_arguments::Shading::Normals => Shading::Normals,
    }
}

/// The welding of FILE's vertices: by the arguments, or else by the edit.
pub(super) fn weld_options(
    arguments: WeldArguments,
    edit: Option<&Path>,
    watch: &Watch,
) -> Result<WeldOptions, EngineError> {
    match (arguments.weld, edit) {
        (None, Some(edit)) => Ok(read_edit(edit, watch)?.weld_options()),
        _ => Ok(arguments.options()),
    }
}

/// The pictures that go to `paths`.
fn pictures(arguments: &RenderArguments, paths: &[PathBuf], watch: &Watch) -> Result<Pictures, EngineError> {
    let weld = weld_options(arguments.weld, arguments.edit.as_deref(), watch)?;
    let loaded = pliant_engine::load(&arguments.file, &weld, watch)?;
    let model = &loaded.model;
    let Some(bounds) = model.bounds() else {
        return Err(EngineError::Empty(arguments.file.clone()));
    };
    let mut inside_out = BTreeSet::new();
    let edit = match arguments.edit.as_deref() {
        Some(path) => {
            let (edit, setup) = resolved(path, &loaded, watch)?;
            inside_out.clone_from(&setup.inside_out);
            pliant_engine::check_bends(&arguments.file, model, &setup.method)?;
            Some(edit)
        }
        None => None,
    };
    let outputs: Vec<(&str, &Path)> = paths.iter().map(|path| ("--output", &**path)).collect();
    watch.refuse_outputs(&outputs, None)?;
    let posed = if edit.is_some() { Posed::Bent } else { Posed::AtRest };
    let shape = Shape::of(&arguments.file, &loaded, edit, posed, watch)?;
    let progress = watch.begin("drawing");
    let drawing = Drawing::new(model, loaded.scene.appearance(), Arc::new(inside_out));
    let pose = drawing.pose(model, &shape.displacements);
    progress.set(0.2);

    let mut renderer = Headless::new()
        .map_err(|error| EngineError::System(error.to_string()))?
        .renderer;
    let look = look(arguments);
    let Uploaded {
        mut surface,
        scale,
        notes,
    } = upload(&renderer, &drawing, &pose, model, &shape, &look, &watch.cancel)?;
    progress.set(0.3);

    let PictureSize { width, height } = arguments.size;
    let size_px = DVec2::new(f64::from(width), f64::from(height));
    let camera = camera(arguments, model, size_px);
    // Marks are as large as on a screen of the usual size, and smaller in a small picture.
    let pixels_per_point = (height as f32 / 620.0).clamp(0.7, 8.0);
    let mut style = drawing::style(&look, pixels_per_point);
    if arguments.transparent {
        style.background = Background::Transparent;
    }
    let legend = match &scale {
        Some(scale) => Some(legend::picture(&renderer, scale, pixels_per_point).map_err(refuse)?),
        None => None,
    };
    let low = match camera.up {
        UpAxis::Y => bounds.min.y,
        UpAxis::Z => bounds.min.z,
    };
    if look.shadow {
        let ground = drawing::ground(&camera, size_px, low, drawing.centre());
        renderer.update_shadow(&mut surface, &ground).map_err(refuse)?;
    }
    let count = arguments.turntable.unwrap_or(1);
    let mut pngs = Vec::new();
    for number in 0..count {
        if watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let mut turned = camera;
        turned.yaw_rad += TAU * f64::from(number) / f64::from(count);
        let ground = look
            .grid
            .then(|| drawing::ground(&turned, size_px, low, drawing.centre()));
        let frame = Frame {
            view: &drawing::view(&turned, size_px, drawing.centre()),
            style: &style,
            surfaces: &[&surface],
            grid: ground.as_ref(),
            overlays: &[],
        };
        let mut image = renderer
            .draw_to_image([width, height], Samples::Four, &frame)
            .map_err(refuse)?;
        if let Some(legend) = &legend {
            painting::composite(&mut image, legend, [height / 50; 2]);
        }
        pngs.push(picture_file::png(image)?);
        progress.set(0.3 + 0.7 * (number + 1) as f32 / count as f32);
    }
    Ok(Pictures { pngs, notes })
}

/// The data on the device.
pub(super) struct Uploaded {
    pub surface: Surface,
    /// The meaning of the surface's colours, if they show a field.
    pub scale: Option<Scale>,
    /// The parts of the file's materials that can't be shown, a sentence each.
    pub notes: Vec<String>,
}

/// Uploads the surface with the shape's lines, and with the data that `look` shows on it: regions, a field, or the
/// materials.
pub(super) fn upload(
    renderer: &Renderer,
    drawing: &Drawing,
    pose: &Pose,
    model: &Model,
    shape: &Shape,
    look: &Look,
    cancel: &Cancel,
) -> Result<Uploaded, EngineError> {
    let mut surface = drawing.upload(renderer, pose).map_err(refuse)?;
    let field = drawing::field(look.shading);
    let scale = field.map(|field| Scale::of(field, model));
    let colours = match field.zip(scale.as_ref()) {
        Some((field, scale)) => drawing::colours(field, scale, model, &shape.displacements, shape.stiffness.as_deref()),
        None => shape.region_colours.clone(),
    };
    let colours = drawing::drawn_colours(model, &colours);
    surface.update_regions(renderer.gpu(), &colours).map_err(refuse)?;
    let wires = drawing::wires(model, &colours);
    surface.update_wires(renderer.gpu(), &wires).map_err(refuse)?;
    surface.update_lines(renderer.gpu(), &shape.outlines).map_err(refuse)?;
    let mut notes = Vec::new();
    if look.shading == Shading::Material {
        let decoded = drawing.materials.decode(cancel);
        let decoded = decoded.map_err(|_| EngineError::Interrupted)?;
        let materials = decoded.upload(renderer).map_err(refuse)?;
        surface.set_materials(materials).map_err(refuse)?;
        notes = decoded.notes;
    }
    Ok(Uploaded { surface, scale, notes })
}

pub(super) fn refuse(error: RenderError) -> EngineError {
    EngineError::System(error.to_string())
}

/// The eye of the first picture: it sees all of the rest shape, for any edit, so that pictures before and after can be
/// compared. Specks far away are left out.
fn camera(arguments: &RenderArguments, model: &Model, size_px: DVec2) -> Camera {
    let seen = model
        .vertices_without_specks()
        .map(|v| model.surface.positions[v.index()]);
    let seen: Vec<DVec3> = seen.collect();
    let diagonal = bounding_box(&seen).map_or(0.0, |bounds| bounds.diagonal());
    let mut camera = looking(arguments.look.up, arguments.look.view, diagonal);
    camera.projection = match arguments.projection {
        ProjectionName::Perspective => Projection::Perspective,
        ProjectionName::Orthographic => Projection::Orthographic,
    };
    camera.frame(&seen, size_px);
    camera.distance *= ROOM_FOR_THE_EDIT;
    camera
}

/// A camera that looks from this side at a model with this diagonal.
pub(super) fn looking(up_axis: Up, from: View, diagonal: f64) -> Camera {
    let mut camera = Camera {
        up: up(up_axis),
        scale: diagonal,
        ..Camera::default()
    };
    camera.look_from(view(from));
    camera
}

/// The factor by which the eye is farther away than for the rest shape alone, so that the whole bent shape is visible,
/// too.
const ROOM_FOR_THE_EDIT: f64 = 1.2;

/// Reads an edit that fits the model, with the same refusals as `apply`: the editor itself would accept any edit.
pub(super) fn resolved(path: &Path, loaded: &Loaded, watch: &Watch) -> Result<(Beginning, Setup), EngineError> {
    let mut edit = read_edit(path, watch)?;
    examples::bring(&mut edit, path, loaded, watch)?;
    let setup = edit.resolve(&loaded.model).map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })?;
    Ok((edit, setup))
}

/// The drawn shape.
pub(super) struct Shape {
    pub displacements: Arc<Vec<DVec3>>,
    region_colours: Vec<[u8; 4]>,
    outlines: Vec<SurfaceLine>,
    stiffness: Option<Vec<f64>>,
}

/// The shape of an edit that is requested.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Posed {
    /// The file's, with the edit's regions; nothing is solved.
    AtRest,
    /// The edit's.
    Bent,
}

impl Shape {
    /// The shape and the regions that the window shows after it has opened the file with the edit and come to rest.
    pub fn of(
        file: &Path,
        loaded: &Loaded,
        edit: Option<Beginning>,
        posed: Posed,
        watch: &Watch,
    ) -> Result<Self, EngineError> {
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
                return Err(EngineError::Interrupted);
            }
            let Some(job) = executor.take(kind) else { break };
            // A picture needs no hierarchy for rays, and a shape at rest needs no solver: without an ordering nothing
            // is bound.
            if kind.is_awaited() && (kind != JobKind::Order || posed == Posed::Bent) {
                editor.handle(Event::JobDone(job.run()));
            }
        }
        progress.set(1.0);
        let seen = editor.view();
        if let Some(problem) = seen.problem {
            return Err(EngineError::System(format!("{}: {problem}", files::shown(file))));
        }
        let displacements = Arc::clone(seen.displacements);
        let mut region_colours = Vec::new();
        editor.region_colours(&mut region_colours);
        Ok(Self {
            displacements,
            region_colours,
            outlines: drawing::outlines(&editor, &loaded.model),
            stiffness: editor.document().stiffness().map(<[f64]>::to_vec),
        })
    }
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
