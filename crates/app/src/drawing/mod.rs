//! From a file's geometry and appearance to what the renderer takes: shared by the window and `pliant render`.
//!
//! A [`Drawing`] is what stays the same while the shape moves: triangles, texture coordinates, materials, and which
//! drawn vertices share a normal. A [`Pose`] is one shape in the renderer's f32, relative to the drawing's centre;
//! making one is pure computation, so the window does it away from its own thread.

mod normals;
mod pose;
mod stage;
mod textures;

use glam::DVec3;
use pliant_io::Appearance;
use pliant_mesh::{Model, bounding_box};
use pliant_render::{AlphaMode, ColourSpace, Material, MaterialGroup, RenderError, Renderer, Surface, SurfaceData};

pub use pose::Pose;
pub use stage::{overlays, style, view};

use normals::NormalGroups;
use textures::Textures;

/// What stays the same while the shape moves.
#[derive(Debug)]
pub struct Drawing {
    /// The f64 point that GPU positions are relative to: the centre of the file's bounding box.
    pub centre: DVec3,
    triangles: Vec<[u32; 3]>,
    normals: NormalGroups,
    uvs: Option<Vec<[f32; 2]>>,
    colours: Option<Vec<[u8; 4]>>,
    groups: Vec<MaterialGroup>,
    materials: Vec<Material>,
    textures: Textures,
}

impl Drawing {
    /// Prepares a file for drawing, decoding its base-colour images. What can't be shown (an image that doesn't
    /// decode) is left out and told in a sentence each.
    pub fn new(model: &Model, appearance: Appearance) -> (Self, Vec<String>) {
        let centre = bounding_box(&model.surface.positions).map_or(DVec3::ZERO, |bounds| bounds.centre());
        let (textures, notes) = Textures::decode(&appearance);
        let materials = appearance
            .materials
            .iter()
            .enumerate()
            .map(|(number, material)| Material {
                base_colour: material.base_colour,
                base_colour_texture: textures.of_material(number),
                alpha: match material.alpha {
                    pliant_io::AlphaMode::Opaque => AlphaMode::Opaque,
                    pliant_io::AlphaMode::Mask(cutoff) => AlphaMode::Mask { cutoff },
                    pliant_io::AlphaMode::Blend => AlphaMode::Blend,
                },
                double_sided: material.double_sided,
            })
            .collect();
        let groups = appearance
            .groups
            .iter()
            .map(|group| MaterialGroup {
                triangles: group.triangles.clone(),
                material: group.material,
            })
            .collect();
        let drawing = Self {
            centre,
            triangles: model
                .drawn
                .triangles
                .iter()
                .map(|corners| corners.map(|vertex| vertex.0))
                .collect(),
            normals: NormalGroups::of(model, appearance.normals),
            uvs: appearance.uvs,
            colours: appearance.colours,
            groups,
            materials,
            textures,
        };
        (drawing, notes)
    }

    /// The shape that `displacements` (one a surface vertex, from the file's shape) give, ready for the renderer.
    pub fn pose(&self, model: &Model, displacements: &[DVec3]) -> Pose {
        Pose::of(model, displacements, self.centre, &self.normals)
    }

    /// Uploads everything, in the shape of `pose`.
    ///
    /// # Errors
    /// What the device refuses: see [`Surface::new`].
    pub fn upload(&self, renderer: &Renderer, pose: &Pose) -> Result<Surface, RenderError> {
        let textures = self.textures.data();
        Surface::new(
            renderer,
            &SurfaceData {
                positions: &pose.positions,
                normals: &pose.normals,
                triangles: &self.triangles,
                uvs: self.uvs.as_deref(),
                colours: self.colours.as_deref(),
                colour_space: ColourSpace::Linear,
                regions: None,
                groups: &self.groups,
                materials: &self.materials,
                textures: &textures,
            },
        )
    }
}

/// Colours of surface vertices, handed down to the drawn vertices; drawn vertices that belong to no kept triangle get
/// a transparent one.
pub fn drawn_colours(model: &Model, surface_colours: &[[u8; 4]]) -> Vec<[u8; 4]> {
    model
        .surface_of_drawn
        .iter()
        .map(|vertex| {
            vertex
                .and_then(|vertex| surface_colours.get(vertex.index()).copied())
                .unwrap_or_default()
        })
        .collect()
}
