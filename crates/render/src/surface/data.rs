//! The slices from which a surface is made, validated before anything is uploaded.

use std::sync::Arc;

use crate::materials::textures_exist;
use crate::{Chunks, Material, MaterialGroup, RenderError, TextureData};

/// The slices from which a [`crate::Surface`] is made. All per-vertex slices have one entry per vertex.
#[derive(Debug, Clone, Copy, Default)]
pub struct SurfaceData<'a> {
    /// Positions relative to the caller's centre.
    pub positions: &'a [[f32; 3]],
    /// Unit normals. A zero normal means none; such a vertex is shaded as if it faced the eye.
    pub normals: &'a [[f32; 3]],
    /// Vertex indices, counterclockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Texture coordinates, v downwards as in glTF.
    pub uvs: Option<&'a [[f32; 2]]>,
    /// A second set of texture coordinates, for maps that use it.
    pub second_uvs: Option<&'a [[f32; 2]]>,
    /// The file's vertex colours (red, green, blue, alpha).
    pub colours: Option<&'a [[u8; 4]]>,
    /// The encoding of the vertex colours.
    pub colour_space: ColourSpace,
    /// Region colours, as for [`crate::Surface::update_regions`]; without them, none is shown.
    pub regions: Option<&'a [[u8; 4]]>,
    /// The materials of ranges of triangles, without overlap; other triangles have the default material.
    pub groups: &'a [MaterialGroup],
    /// The materials that `groups` refers to.
    pub materials: &'a [Material],
    /// For each vertex, the lowest vertex at the same position: an edge between welded vertices is a seam, not a
    /// border. `None` if no vertices are welded.
    pub welded: Option<&'a [u32]>,
    /// The chunks of the mesh; built from the slices above if not given.
    pub chunks: Option<&'a Arc<Chunks>>,
    /// The textures that `materials` refers to.
    pub textures: &'a [TextureData<'a>],
}

/// A file's encoding of its vertex colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColourSpace {
    /// sRGB (PLY and OBJ files).
    #[default]
    Srgb,
    /// Linear light (glTF's `COLOR_0`).
    Linear,
}

/// Rejects slices of different lengths and indices out of range.
pub(crate) fn checked(data: &SurfaceData<'_>) -> Result<(), RenderError> {
    let vertices = data.positions.len();
    for (what, length) in [
        ("normals", Some(data.normals.len())),
        ("texture coordinates", data.uvs.map(<[_]>::len)),
        ("second texture coordinates", data.second_uvs.map(<[_]>::len)),
        ("welded vertices", data.welded.map(<[_]>::len)),
        ("vertex colours", data.colours.map(<[_]>::len)),
        ("region colours", data.regions.map(<[_]>::len)),
    ] {
        if let Some(found) = length.filter(|&length| length != vertices) {
            return Err(RenderError::Length {
                what,
                expected: vertices,
                found,
            });
        }
    }
    // Draw calls count indices in 32 bits.
    const MOST_TRIANGLES: usize = u32::MAX as usize / 3;
    if data.triangles.len() > MOST_TRIANGLES {
        let (bytes, limit) = (12 * data.triangles.len() as u64, 12 * MOST_TRIANGLES as u64);
        return Err(RenderError::TooLarge {
            what: "triangles",
            bytes,
            limit,
        });
    }
    for (number, triangle) in data.triangles.iter().enumerate() {
        if let Some(&vertex) = triangle.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(RenderError::NoSuchVertex {
                triangle: number,
                vertex,
                vertices,
            });
        }
    }
    for group in data.groups {
        if !group.triangles.is_empty() {
            in_range("triangle", group.triangles.end as usize - 1, data.triangles.len())?;
        }
        in_range("material", group.material, data.materials.len())?;
    }
    if let Some(&vertex) = data
        .welded
        .unwrap_or_default()
        .iter()
        .find(|&&vertex| vertex as usize >= vertices)
    {
        in_range("welded vertex", vertex as usize, vertices)?;
    }
    textures_exist(data.materials, data.textures.len())?;
    if let Some(chunks) = data.chunks.filter(|chunks| !chunks.fits(data.triangles.len())) {
        return Err(RenderError::Length {
            what: "the chunks' triangles",
            expected: data.triangles.len(),
            found: chunks.all().last().map_or(0, |chunk| chunk.triangles.end as usize),
        });
    }
    Ok(())
}

fn in_range(what: &'static str, number: usize, count: usize) -> Result<(), RenderError> {
    if number < count {
        Ok(())
    } else {
        Err(RenderError::NoSuch { what, number, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contradictions_are_refused_by_name() {
        let good = SurfaceData {
            positions: &[[0.0; 3]; 3],
            normals: &[[0.0; 3]; 3],
            triangles: &[[0, 1, 2]],
            ..Default::default()
        };
        assert_eq!(checked(&good), Ok(()));
        assert_eq!(checked(&SurfaceData::default()), Ok(()));
        let refused = |data: SurfaceData<'_>| checked(&data).err().map(|error| error.to_string());
        assert_eq!(
            refused(SurfaceData {
                uvs: Some(&[[0.0; 2]; 2]),
                ..good
            })
            .as_deref(),
            Some("texture coordinates: 2 entries for 3 vertices; give one entry a vertex")
        );
        assert_eq!(
            refused(SurfaceData {
                triangles: &[[0, 1, 2], [1, 2, 3]],
                ..good
            })
            .as_deref(),
            Some("triangle 1 names vertex 3, but there are only 3 vertices")
        );
        let groups = [MaterialGroup {
            triangles: 0..1,
            material: 0,
        }];
        assert_eq!(
            refused(SurfaceData {
                groups: &groups,
                ..good
            })
            .as_deref(),
            Some("material 0 does not exist: there are 0")
        );
    }
}
