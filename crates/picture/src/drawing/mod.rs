//! Converts a file's geometry and appearance for the renderer. Shared by the window and `pliant render`.
//!
//! A [`Drawing`] has the parts that stay the same while the shape changes: triangles, texture coordinates, materials,
//! and the groups of drawn vertices that share a normal. A [`Pose`] is one shape in f32, relative to the drawing's
//! centre. Computing one needs no device, so the window does it on another thread.

mod drawn_colours;
mod field;
mod ground;
mod materials;
mod normals;
mod outlines;
mod pose;
mod relative;
mod scene_view;
mod wires;

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_io::Appearance;
use pliant_mesh::{DrawnVertex, Model};
use pliant_render::{Chunks, ColourSpace, MaterialGroup, RenderError, Renderer, Surface, SurfaceData};

pub use drawn_colours::{drawn_colours, recolour};
pub use field::{Field, Scale, Tick, colour_at, colours};
pub use ground::ground;
pub use materials::{DecodedMaterials, EncodedMaterials};
pub use outlines::outlines;
pub use pose::Pose;
pub use scene_view::{faded_style, field, overlays, style, view};
pub use wires::wires;

use normals::NormalGroups;
use pose::Poser;
use relative::Relative;

/// The parts that stay the same while the shape changes.
#[derive(Debug)]
pub struct Drawing {
    /// The file's materials and their encoded images.
    pub materials: EncodedMaterials,
    /// The connected parts that are shown turned inside out, by their numbers.
    pub inside_out: Arc<BTreeSet<u32>>,
    triangles: Vec<[u32; 3]>,
    welded: Vec<u32>,
    poser: Poser,
    uvs: Option<Vec<[f32; 2]>>,
    second_uvs: Option<Vec<[f32; 2]>>,
    colours: Option<Vec<[u8; 4]>>,
    groups: Vec<MaterialGroup>,
}

impl Drawing {
    /// Prepares a file for drawing, with the connected parts `inside_out` turned inside out. Its images are decoded
    /// separately: see [`EncodedMaterials::decode`].
    pub fn new(model: &Model, mut appearance: Appearance, inside_out: Arc<BTreeSet<u32>>) -> Self {
        materials::dim_bare(&mut appearance, model.drawn.triangle_count() as u32);
        let relative = Relative::of(model);
        let colours = appearance.srgb_colours();
        let materials = EncodedMaterials::new(&mut appearance);
        let groups: Vec<MaterialGroup> = appearance
            .groups
            .iter()
            .map(|group| MaterialGroup {
                triangles: group.triangles.clone(),
                material: group.material,
            })
            .collect();
        let triangles = model.drawn_triangles().into_iter();
        let turned = model.drawn_vertices_of(&inside_out);
        let is_turned = |vertex: DrawnVertex| turned.get(vertex.index()).is_some_and(|is_turned| *is_turned);
        let wound = |[a, b, c]: [DrawnVertex; 3]| if is_turned(a) { [a, c, b] } else { [a, b, c] };
        let triangles: Vec<[u32; 3]> = triangles.map(|corners| wound(corners).map(|vertex| vertex.0)).collect();
        let at_rest = model.rest_positions().into_iter();
        let positions: Vec<[f32; 3]> = at_rest
            .map(|position| pose::finite(position - relative.centre))
            .collect();
        let chunks = Chunks::new(&positions, &triangles, &groups, &materials.without_images());
        let normals = NormalGroups::of(model, &relative, &triangles, appearance.normals, turned);
        Self {
            materials,
            welded: welded(model),
            poser: Poser::new(Arc::new(chunks), relative, normals.with_flat(appearance.flat)),
            inside_out,
            uvs: appearance.uvs,
            second_uvs: appearance.second_uvs,
            colours,
            groups,
            triangles,
        }
    }

    /// Returns true if the file's vertices have different colours.
    pub fn has_vertex_colours(&self) -> bool {
        let colours = self.colours.as_deref().unwrap_or_default();
        colours.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The f64 point that GPU positions are relative to: the centre of the file's bounding box.
    pub fn centre(&self) -> DVec3 {
        self.poser.relative.centre
    }

    /// The shape given by `displacements` (one per surface vertex, from the file's shape) for the renderer.
    pub fn pose(&self, model: &Model, displacements: &[DVec3]) -> Pose {
        self.poser.pose(model, displacements, None)
    }

    /// As [`Drawing::pose`], for a shape from the method's own map: normals turn by the inverse transpose of I + J,
    /// with J the map's Jacobian at each surface vertex ([`pliant_deform::Bound::jacobians`]).
    pub fn pose_turned(&self, model: &Model, displacements: &[DVec3], jacobians: &[Mat3]) -> Pose {
        self.poser.pose(model, displacements, Some(jacobians))
    }

    /// Takes back a pose whose numbers were uploaded, so that the next one reuses its memory.
    pub fn put_back(&self, pose: Pose) {
        self.poser.put_back(pose);
    }

    /// Uploads everything except the images, in the shape of `pose`.
    ///
    /// # Errors
    /// See [`Surface::new`].
    pub fn upload(&self, renderer: &Renderer, pose: &Pose) -> Result<Surface, RenderError> {
        Surface::new(
            renderer.gpu(),
            &SurfaceData {
                positions: &pose.positions,
                normals: &pose.normals,
                triangles: &self.triangles,
                uvs: self.uvs.as_deref(),
                second_uvs: self.second_uvs.as_deref(),
                colours: self.colours.as_deref(),
                colour_space: ColourSpace::Srgb,
                regions: None,
                groups: &self.groups,
                materials: &self.materials.without_images(),
                textures: &[],
                welded: Some(&self.welded),
                chunks: Some(&self.poser.chunks),
            },
        )
    }
}

/// For each drawn vertex, the first drawn vertex that it is welded to.
fn welded(model: &Model) -> Vec<u32> {
    let mut first = vec![u32::MAX; model.surface.positions.len()];
    let of_drawn = model.drawn.surface_vertices().enumerate();
    of_drawn
        .map(|(drawn, surface)| match surface {
            Some(surface) => {
                let first = &mut first[surface.index()];
                *first = (*first).min(drawn as u32);
                *first
            }
            None => drawn as u32,
        })
        .collect()
}
