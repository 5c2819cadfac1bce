//! Materials as `UsdPreviewSurface`, with the nodes that phones know.

use std::fmt::Write as _;

use super::texture::{Texture, push_texture};
use crate::appearance::{AlphaMode, Map, Material, UvSet, Wrap};
use crate::convert::NewMesh;

/// The materials that triangles use, and the images that they can have.
pub(super) struct Materials {
    /// Numbers of materials, ascending.
    pub used: Vec<usize>,
    /// The path in the archive of each image that phones read.
    pub images: Vec<Option<String>>,
    /// True if a map has texture coordinates of its own, which are left out.
    pub has_moved_maps: bool,
}

impl Materials {
    /// Those of a mesh.
    pub fn of(mesh: &NewMesh<'_>) -> Self {
        let look = &mesh.appearance;
        let groups = look.groups.iter().filter(|group| !group.triangles.is_empty());
        let mut used: Vec<usize> = groups.map(|group| group.material).collect();
        used.sort_unstable();
        used.dedup();
        let images = look.images.iter().enumerate();
        let images = images.map(|(number, image)| Some(format!("textures/{number}.{}", image.common_extension()?)));
        let maps = used.iter().flat_map(|&number| {
            let material = &look.materials[number];
            [
                material.metallic_roughness_map,
                material.normal_map,
                material.occlusion_map,
                material.emissive_map,
            ]
        });
        Self {
            has_moved_maps: maps.flatten().any(|map| !is_plain(&map)),
            images: images.collect(),
            used,
        }
    }

    fn image(&self, mesh: &NewMesh<'_>, image: Option<usize>) -> Option<&str> {
        let path = self.images.get(image?)?.as_deref();
        path.filter(|_| mesh.appearance.uvs.is_some())
    }
}

/// Returns true if a map lies on the surface like the base colour.
fn is_plain(map: &Map) -> bool {
    map.set == UvSet::Base && map.transform == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
}

/// Appends a material.
pub(super) fn push_material(out: &mut Vec<u8>, number: usize, mesh: &NewMesh<'_>, materials: &Materials) {
    let material = &mesh.appearance.materials[number];
    let own = format!("/Model/Materials/Material_{number}");
    let mut surface = String::new();
    let mut nodes = String::new();
    base_colour(&mut surface, &mut nodes, &own, material, mesh, materials);
    let mut map = |map: Option<Map>, texture: Texture<'_>, inputs: &[(&str, &str)]| {
        let plain = map.filter(is_plain);
        let Some((map, path)) = plain.and_then(|map| Some((map, materials.image(mesh, Some(map.image))?))) else {
            return false;
        };
        push_texture(
            &mut nodes,
            &own,
            &Texture {
                path,
                wrap: map.wrap,
                ..texture
            },
        );
        for (input, output) in inputs {
            let _ = writeln!(
                surface,
                "                {input}.connect = <{own}/{}.outputs:{output}>",
                texture.name
            );
        }
        true
    };
    let texture = |name, space, scale, bias| Texture {
        name,
        path: "",
        wrap: [Wrap::Repeat; 2],
        space,
        scale,
        bias,
    };
    let (metallic, roughness) = (material.metallic, material.roughness);
    let rough = texture("Rough", "raw", [1.0, roughness, metallic, 1.0], [0.0; 4]);
    let inputs = [("float inputs:roughness", "g"), ("float inputs:metallic", "b")];
    let has_rough = map(material.metallic_roughness_map, rough, &inputs);
    let scale = material.normal_scale;
    let normal = texture(
        "Normal",
        "raw",
        [2.0 * scale, 2.0 * scale, 2.0, 1.0],
        [-scale, -scale, -1.0, 0.0],
    );
    map(material.normal_map, normal, &[("normal3f inputs:normal", "rgb")]);
    let strength = material.occlusion_strength;
    let occlusion = texture("Occlusion", "raw", [strength; 4], [1.0 - strength; 4]);
    map(material.occlusion_map, occlusion, &[("float inputs:occlusion", "r")]);
    let [red, green, blue] = material.emissive;
    let light = texture("Light", "sRGB", [red, green, blue, 1.0], [0.0; 4]);
    let has_light = map(material.emissive_map, light, &[("color3f inputs:emissiveColor", "rgb")]);
    if !has_rough {
        let _ = writeln!(surface, "                float inputs:metallic = {metallic}");
        let _ = writeln!(surface, "                float inputs:roughness = {roughness}");
    }
    if !has_light && material.emissive != [0.0; 3] {
        let _ = writeln!(
            surface,
            "                color3f inputs:emissiveColor = ({red}, {green}, {blue})"
        );
    }
    let name: String = material.name.chars().filter(|letter| !letter.is_control()).collect();
    let name = name.replace('\\', "\\\\").replace('"', "\\\"");
    let text = format!(
        "        def Material \"Material_{number}\" (\n            displayName = \"{name}\"\n        )\n        {{\n            \
         token outputs:surface.connect = <{own}/Surface.outputs:surface>\n\n            \
         def Shader \"Surface\"\n            {{\n                uniform token info:id = \"UsdPreviewSurface\"\n{surface}                \
         token outputs:surface\n            }}\n{nodes}        }}\n"
    );
    out.extend_from_slice(text.as_bytes());
}

/// The base colour and the opacity: of an image, of the vertices, or the material's own.
fn base_colour(
    surface: &mut String,
    nodes: &mut String,
    own: &str,
    material: &Material,
    mesh: &NewMesh<'_>,
    materials: &Materials,
) {
    let [red, green, blue, alpha] = material.base_colour;
    let image = materials.image(mesh, material.base_colour_image);
    if let Some(path) = image {
        push_texture(
            nodes,
            own,
            &Texture {
                name: "Colour",
                path,
                wrap: material.wrap,
                space: "sRGB",
                scale: [red, green, blue, alpha],
                bias: [0.0; 4],
            },
        );
        let _ = writeln!(
            surface,
            "                color3f inputs:diffuseColor.connect = <{own}/Colour.outputs:rgb>"
        );
    } else if mesh.appearance.colours.is_some() {
        let _ = writeln!(
            surface,
            "                color3f inputs:diffuseColor.connect = <{own}/Painted.outputs:result>"
        );
        let _ = write!(
            nodes,
            "\n            def Shader \"Painted\"\n            {{\n                \
             uniform token info:id = \"UsdPrimvarReader_float3\"\n                \
             string inputs:varname = \"displayColor\"\n                float3 outputs:result\n            }}\n"
        );
    } else {
        let _ = writeln!(
            surface,
            "                color3f inputs:diffuseColor = ({red}, {green}, {blue})"
        );
    }
    match (material.alpha, image.is_some()) {
        (AlphaMode::Opaque, _) => {}
        (_, true) => {
            let _ = writeln!(
                surface,
                "                float inputs:opacity.connect = <{own}/Colour.outputs:a>"
            );
        }
        (_, false) => {
            let _ = writeln!(surface, "                float inputs:opacity = {alpha}");
        }
    }
    if let AlphaMode::Mask(cut_off) = material.alpha {
        let _ = writeln!(surface, "                float inputs:opacityThreshold = {cut_off}");
    }
    if nodes.contains("UsdUVTexture") || has_maps(material) {
        let _ = write!(
            nodes,
            "\n            def Shader \"Coordinates\"\n            {{\n                \
             uniform token info:id = \"UsdPrimvarReader_float2\"\n                \
             string inputs:varname = \"st\"\n                float2 outputs:result\n            }}\n"
        );
    }
}

fn has_maps(material: &Material) -> bool {
    material.metallic_roughness_map.is_some()
        || material.normal_map.is_some()
        || material.occlusion_map.is_some()
        || material.emissive_map.is_some()
}
