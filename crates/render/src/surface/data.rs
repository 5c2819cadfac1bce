//! What a surface is made of: slices, checked before anything is uploaded.

use std::sync::Arc;

use crate::{Chunks, Material, MaterialGroup, RenderError, TextureData};

/// The slices a [`crate::Surface`] is made of. All per-vertex slices have one entry a vertex.
#[derive(Debug, Clone, Copy, Default)]
pub struct SurfaceData<'a> {
    /// Positions relative to the caller's centre.
    pub positions: &'a [[f32; 3]],
    /// Unit normals (zero where there is none: such a vertex seems to face the eye).
    pub normals: &'a [[f32; 3]],
    /// Vertex numbers, counterclockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Texture coordinates, v downwards as in glTF.
    pub uvs: Option<&'a [[f32; 2]]>,
    /// A second set of them, for maps that ask for it.
    pub second_uvs: Option<&'a [[f32; 2]]>,
    /// The file's vertex colours (red, green, blue, alpha).
    pub colours: Option<&'a [[u8; 4]]>,
    /// How the vertex colours are encoded.
    pub colour_space: ColourSpace,
    /// Region colours, as for [`crate::Surface::update_regions`]; none shows clay everywhere.
    pub regions: Option<&'a [[u8; 4]]>,
    /// Which triangles have which material, without overlap; the others have the default one.
    pub groups: &'a [MaterialGroup],
    /// The materials that groups name.
    pub materials: &'a [Material],
    /// For each vertex the lowest vertex at the same place: what lies between such welded is a seam, no border. None
    /// means that no two vertices are welded.
    pub welded: Option<&'a [u32]>,
    /// How the triangles are cut into chunks; made of the slices above where none is given.
    pub chunks: Option<&'a Arc<Chunks>>,
    /// The textures that materials name.
    pub textures: &'a [TextureData<'a>],
}

/// How a file encodes its vertex colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColourSpace {
    /// As screens do (PLY and OBJ files).
    #[default]
    Srgb,
    /// In proportion to light (glTF's `COLOR_0`).
    Linear,
}

/// Refuses slices that contradict each other and numbers out of range.
pub(crate) fn checked(data: &SurfaceData<'_>) -> Result<(), RenderError> {
    let vertices = data.positions.len();
    for (what, length) in [
        ("normals", Some(data.normals.len())),
        ("texture coordinates", data.uvs.map(<[_]>::len)),
        ("second texture coordinates", data.second_uvs.map(<[_]>::len)),
        ("welded", data.welded.map(<[_]>::len)),
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
    // Drawings count indices in 32 bits.
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

/// Refuses materials that name a texture which does not exist.
pub(crate) fn textures_exist(materials: &[Material], texture_count: usize) -> Result<(), RenderError> {
    for map in materials.iter().flat_map(|material| material.maps()).flatten() {
        in_range("texture", map.texture, texture_count)?;
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
            Some("material 0 does not exist, there are 0")
        );
    }
}
