//! The surface in the device's buffers: its colours and lines follow the editor, its shape the poses that jobs make.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Editor, SceneView, UpAxis};
use pliant_mesh::{Model, SurfaceVertex};
use pliant_render::{Grid, Materials, RenderError, Renderer, Surface};

use super::gpu::Gpu;
use pliant_picture::drawing::{self, Drawing, Field, Scale};

/// The surface in GPU buffers and its present contents.
pub struct Shown {
    pub surface: Surface,
    pub drawing: Arc<Drawing>,
    pub displacements: Arc<Vec<DVec3>>,
    /// The height of the file's lowest point along each axis, in world units.
    pub lowest: DVec3,
    pub colours: Colours,
    /// One for each drawn vertex, if they are regions.
    pub drawn_colours: Vec<[u8; 4]>,
    /// The editor's rims that it has.
    pub rims: Option<u64>,
    pub scale: Option<Arc<Scale>>,
    /// True if its images are still to come.
    pub awaits_images: bool,
    /// Its materials with their images, once there are any.
    pub materials: Option<Materials>,
    /// The weights that its colours show, kept so that others have another address.
    pub weights: Option<Arc<Vec<f64>>>,
    /// The number of changes of its materials.
    pub materials_revision: u64,
    /// The drawn triangles.
    pub shown: Option<Arc<Vec<bool>>>,
    /// The source of its shadow.
    pub shadow: Option<ShadowKey>,
}

/// The source of a shadow: the addresses of a shape and of the drawn triangles, and the axis that points up.
pub type ShadowKey = (usize, usize, UpAxis);

impl Shown {
    /// A drawing of a model in GPU buffers, with these displacements of the surface's vertices.
    pub fn new(drawing: Arc<Drawing>, surface: Surface, displacements: Arc<Vec<DVec3>>, model: &Model) -> Self {
        Self {
            awaits_images: drawing.materials.has_images(),
            surface,
            drawing,
            displacements,
            lowest: model.bounds().map_or(DVec3::ZERO, |bounds| bounds.min),
            colours: Colours::None,
            drawn_colours: Vec::new(),
            rims: None,
            scale: None,
            materials: None,
            weights: None,
            materials_revision: 0,
            shown: None,
            shadow: None,
        }
    }

    /// It once more, after another one was shown: the editor's regions and their rims may be others.
    pub fn anew(self) -> Self {
        Self {
            colours: Colours::None,
            rims: None,
            ..self
        }
    }

    /// The grid under the file's lowest point.
    pub fn ground(&self, view: &SceneView<'_>) -> Grid {
        self.floor().grid(view)
    }

    /// The place of that grid.
    pub fn floor(&self) -> Floor {
        Floor {
            lowest: self.lowest,
            centre: self.drawing.centre(),
        }
    }

    /// The shadow that belongs to the present picture.
    pub fn wanted_shadow(&self, view: &SceneView<'_>) -> Option<ShadowKey> {
        let shape = Arc::as_ptr(&self.displacements) as usize;
        let key = (shape, address(self.shown.as_ref()), view.camera.up);
        view.look.shadow.then_some(key)
    }

    /// Makes the shadow `wanted`.
    ///
    /// # Errors
    /// As [`Renderer::update_shadow`].
    pub fn update_shadow(
        &mut self,
        renderer: &mut Renderer,
        view: &SceneView<'_>,
        wanted: Option<ShadowKey>,
    ) -> Result<(), RenderError> {
        if self.shadow != wanted {
            if wanted.is_some() {
                let ground = self.ground(view);
                renderer.update_shadow(&mut self.surface, &ground)?;
            }
            self.shadow = wanted;
        }
        Ok(())
    }

    /// Updates the colours and the shown triangles to the editor's present ones.
    ///
    /// # Errors
    /// As [`Surface::update_regions`].
    pub fn update_regions(&mut self, editor: &Editor, gpu: &Gpu) -> Result<(), RenderError> {
        let view = editor.view();
        let Some(model) = view.model else { return Ok(()) };
        let wanted_triangles = editor.shown_triangles();
        if address(self.shown.as_ref()) != address(wanted_triangles) {
            let wanted_triangles = wanted_triangles.cloned();
            self.surface.show(gpu.read().gpu(), wanted_triangles.clone())?;
            self.shown = wanted_triangles;
        }
        let stiffness = editor.document().stiffness();
        let wanted = match drawing::field(view.look.shading) {
            None => Colours::Regions(view.regions_revision),
            Some(Field::Stiffness) => Colours::Stiffness(view.regions_revision),
            Some(Field::Weight) => match view.weights {
                Some(weights) => Colours::Weights(Arc::as_ptr(weights) as usize),
                None => Colours::Regions(view.regions_revision),
            },
            // These come with the shape that they belong to.
            Some(_) => return Ok(()),
        };
        if self.colours == wanted {
            return Ok(());
        }
        let renderer = gpu.read();
        let recoloured = match (self.colours, wanted) {
            (Colours::Regions(known), Colours::Regions(_)) | (Colours::Stiffness(known), Colours::Stiffness(_)) => {
                editor.recoloured_since(known)
            }
            _ => None,
        };
        // A vertex by itself costs several times as much as among all.
        let recoloured = recoloured.filter(|vertices| vertices.len() < model.surface.positions.len() / 4);
        if let Some(vertices) = recoloured {
            let of_region = editor.region_colour();
            let colour = |vertex: SurfaceVertex| match (wanted, &self.scale) {
                (Colours::Stiffness(_), Some(scale)) => {
                    scale.colour(stiffness.map_or(1.0, |field| field[vertex.index()]))
                }
                _ => of_region(vertex),
            };
            let ranges = drawing::recolour(model, vertices, colour, &mut self.drawn_colours);
            let colours = &self.drawn_colours;
            self.surface.update_some_regions(renderer.gpu(), colours, &ranges)?;
        } else {
            let mut colours = Vec::new();
            let values = match wanted {
                Colours::Stiffness(_) => Some((Field::Stiffness, stiffness)),
                Colours::Weights(_) => Some((Field::Weight, view.weights.map(|weights| weights.as_slice()))),
                _ => None,
            };
            if let Some((field, values)) = values {
                let scale = Arc::new(Scale::of(field, model));
                colours = drawing::colours(field, &scale, model, &self.displacements, values);
                self.scale = Some(scale);
            } else {
                editor.region_colours(&mut colours);
            }
            self.drawn_colours = drawing::drawn_colours(model, &colours);
            self.surface.update_regions(renderer.gpu(), &self.drawn_colours)?;
        }
        let wires = drawing::wires(model, &self.drawn_colours);
        self.surface.update_wires(renderer.gpu(), &wires)?;
        self.weights = view.weights.filter(|_| matches!(wanted, Colours::Weights(_))).cloned();
        self.colours = wanted;
        Ok(())
    }

    /// Updates the outlines to the editor's present ones, if they are shown.
    ///
    /// # Errors
    /// As [`Surface::update_lines`].
    pub fn update_rims(&mut self, editor: &Editor, gpu: &Gpu) -> Result<(), RenderError> {
        let view = editor.view();
        let Some(model) = view.model else { return Ok(()) };
        if self.rims != Some(view.rims_revision) && view.look.outlines {
            let lines = drawing::outlines(editor, model);
            self.surface.update_lines(gpu.read().gpu(), &lines)?;
            self.rims = Some(view.rims_revision);
        }
        Ok(())
    }
}

/// The place of the ground's grid.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Floor {
    /// The height of the file's lowest point along each axis, in world units.
    pub lowest: DVec3,
    /// The centre of the file's drawing.
    pub centre: DVec3,
}

impl Floor {
    /// The grid, which stays in the world: the view is that of the shown frame, which its path may have carried there.
    pub fn grid(&self, view: &SceneView<'_>) -> Grid {
        let height = match view.camera.up {
            UpAxis::Y => self.lowest.y,
            UpAxis::Z => self.lowest.z,
        };
        let grid = drawing::ground(view.world_camera, view.viewport_px, height, self.centre);
        let body = &view.body_motion;
        if !body.moves() {
            return grid;
        }
        let seen = |world: DVec3| body.before(world) - self.centre;
        let middle = DVec3::from(grid.middle.map(f64::from)) + self.centre;
        let along = grid.along.map(|direction| {
            let ahead = seen(middle + DVec3::from(direction.map(f64::from)));
            (ahead - seen(middle)).as_vec3().to_array()
        });
        Grid {
            middle: seen(middle).as_vec3().to_array(),
            along,
            ..grid
        }
    }
}

/// The present meaning of the surface's region colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Colours {
    /// Not set.
    None,
    /// The editor's regions.
    Regions(u64),
    /// Numbers of the shape.
    Field(Field),
    /// The stiffness, as of a revision of the editor's regions.
    Stiffness(u64),
    /// A handle's weights, by their address.
    Weights(usize),
}

/// The identity of a list of triangles; 0 for all of them.
pub fn address(shown: Option<&Arc<Vec<bool>>>) -> usize {
    shown.map_or(0, |shown| Arc::as_ptr(shown) as usize)
}
