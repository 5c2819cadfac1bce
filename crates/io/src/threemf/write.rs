//! A new 3MF file from a mesh of any other format: one object, with its colours, materials and base textures.
//!
//! A triangle names one group of properties: texture coordinates if its material has an image, or else colours, or
//! else its material's colour.

use std::collections::HashMap;
use std::fmt::Write as _;

use pliant_mesh::DrawnVertex;

use super::resources::text_of;
use crate::appearance::colour::{SrgbBytes, byte, srgb_of_linear};
use crate::appearance::{Appearance, Material};
use crate::archive::{Packing, archive_of, with_parts};
use crate::convert::NewMesh;
use crate::convert::faces::{lost, lost_where, merged};
use crate::save::Saved;
use crate::save::course::Course;
use crate::text::push_f64;
use crate::{Format, SaveError};

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
 <Default Extension="png" ContentType="image/png"/>
 <Default Extension="jpg" ContentType="image/jpeg"/>
</Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Id="model" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

const MODEL: &str = "3D/3dmodel.model";
const MODEL_RELATIONS: &str = "3D/_rels/3dmodel.model.rels";

/// The numbers of the groups of resources; textures come after them.
const BASES: u32 = 1;
const COLOURS: u32 = 2;
const TEXTURES: u32 = 3;

/// The property group of a material's triangles.
#[derive(Clone, Copy)]
enum Dress {
    Nothing,
    Base(u32),
    Colours,
    /// The number of its group of texture coordinates.
    Texture(u32),
}

/// Writes a mesh's triangles as 3MF.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let look = &mesh.appearance;
    let images = image_paths(look);
    let dresses = dresses(look, &images);
    let mut model = Vec::new();
    push(
        &mut model,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n <resources>\n",
    );
    push_materials(&mut model, look, &dresses);
    let palette = Palette::of(mesh, &dresses);
    palette.push(&mut model);
    push_textures(&mut model, mesh, &images, &dresses);
    let object = TEXTURES + 2 * look.materials.len() as u32;
    push(
        &mut model,
        &format!("  <object id=\"{object}\" type=\"model\">\n   <mesh>\n"),
    );
    push_mesh(&mut model, mesh, &dresses, &palette, course)?;
    push(
        &mut model,
        &format!(
            "   </mesh>\n  </object>\n </resources>\n <build>\n  <item objectid=\"{object}\"/>\n </build>\n</model>\n"
        ),
    );
    let relations = image_relations(&images);
    let mut parts: Vec<(&str, &[u8])> = vec![
        ("[Content_Types].xml", CONTENT_TYPES.as_bytes()),
        ("_rels/.rels", RELATIONS.as_bytes()),
        (MODEL, &model),
    ];
    if images.iter().any(Option::is_some) {
        parts.push((MODEL_RELATIONS, relations.as_bytes()));
    }
    for (image, path) in look.images.iter().zip(&images) {
        if let Some(path) = path {
            parts.push((path.trim_start_matches('/'), &image.encoded));
        }
    }
    let unwritable = |what: String| SaveError::CannotHold {
        what: format!("this file, because {what},"),
        format: Format::Threemf,
        remedy: "save in another format".to_owned(),
    };
    let archive = archive_of(&parts, Packing::Deflated).map_err(unwritable)?;
    // Copied once, so that the other parts' headers are those of every later save.
    let bytes = with_parts(&archive, &[(2, model.clone())], Packing::Deflated).map_err(unwritable)?;
    Ok(Saved::alone(mesh.name, bytes, left_out(mesh, &dresses)))
}

fn push(out: &mut Vec<u8>, text: &str) {
    out.extend_from_slice(text.as_bytes());
}

/// The path in the archive of each image that 3MF can hold.
fn image_paths(look: &Appearance) -> Vec<Option<String>> {
    let images = look.images.iter().enumerate();
    images
        .map(|(number, image)| {
            image
                .common_extension()
                .map(|kind| format!("/3D/Textures/{number}.{kind}"))
        })
        .collect()
}

fn image_relations(images: &[Option<String>]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships \
                    xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
        .to_owned();
    for (number, path) in images.iter().enumerate() {
        if let Some(path) = path {
            // Writing to a String can't fail.
            let _ = writeln!(
                text,
                " <Relationship Id=\"texture{number}\" Target=\"{path}\" \
                 Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture\"/>"
            );
        }
    }
    text + "</Relationships>\n"
}

/// The properties of each material's triangles.
fn dresses(look: &Appearance, images: &[Option<String>]) -> Vec<Dress> {
    let mut bases = 0;
    let each = look.materials.iter().enumerate().map(|(number, material)| {
        let image = material
            .base_colour_image
            .and_then(|image| images.get(image))
            .and_then(Option::as_ref);
        if look.uvs.is_some() && image.is_some() {
            Dress::Texture(TEXTURES + 2 * number as u32 + 1)
        } else if look.colours.is_some() {
            Dress::Colours
        } else if is_plain(material) {
            Dress::Nothing
        } else {
            bases += 1;
            Dress::Base(bases - 1)
        }
    });
    each.collect()
}

fn is_plain(material: &Material) -> bool {
    material.base_colour == [1.0; 4] && material.name.is_empty()
}

fn push_materials(out: &mut Vec<u8>, look: &Appearance, dresses: &[Dress]) {
    let named = look.materials.iter().zip(dresses);
    let mut named = named.filter(|(_, dress)| matches!(dress, Dress::Base(_))).peekable();
    if named.peek().is_none() {
        return;
    }
    push(out, &format!("  <basematerials id=\"{BASES}\">\n"));
    for (material, _) in named {
        let [red, green, blue, alpha] = material.base_colour;
        let [red, green, blue] = [red, green, blue].map(|light| byte(srgb_of_linear(light)));
        let colour = text_of([red, green, blue, byte(alpha.clamp(0.0, 1.0))]);
        let name: String = material.name.chars().filter(|letter| !letter.is_control()).collect();
        let name = quick_xml::escape::escape(&name);
        push(out, &format!("   <base name=\"{name}\" displaycolor=\"{colour}\"/>\n"));
    }
    push(out, "  </basematerials>\n");
}

/// The colours of the vertices, each once.
struct Palette {
    colours: Vec<[u8; 4]>,
    /// The place of each drawn vertex's colour.
    of_vertex: Vec<u32>,
}

impl Palette {
    fn of(mesh: &NewMesh<'_>, dresses: &[Dress]) -> Self {
        let mut palette = Self {
            colours: Vec::new(),
            of_vertex: Vec::new(),
        };
        let is_used = dresses.iter().any(|dress| matches!(dress, Dress::Colours));
        let Some(colours) = mesh.appearance.colours.as_ref().filter(|_| is_used) else {
            return palette;
        };
        let srgb = SrgbBytes::new();
        let mut known: HashMap<[u8; 4], u32> = HashMap::new();
        for &colour in colours {
            let colour = srgb.of_linear(colour);
            let next = palette.colours.len() as u32;
            let place = *known.entry(colour).or_insert(next);
            if place == next {
                palette.colours.push(colour);
            }
            palette.of_vertex.push(place);
        }
        palette
    }

    fn push(&self, out: &mut Vec<u8>) {
        if self.colours.is_empty() {
            return;
        }
        push(out, &format!("  <m:colorgroup id=\"{COLOURS}\">\n"));
        for &colour in &self.colours {
            push(out, &format!("   <m:color color=\"{}\"/>\n", text_of(colour)));
        }
        push(out, "  </m:colorgroup>\n");
    }
}

/// Each textured material's image, and a coordinate for each drawn vertex.
fn push_textures(out: &mut Vec<u8>, mesh: &NewMesh<'_>, images: &[Option<String>], dresses: &[Dress]) {
    let look = &mesh.appearance;
    for (material, dress) in look.materials.iter().zip(dresses) {
        let Dress::Texture(group) = *dress else { continue };
        let path = material.base_colour_image.and_then(|image| images[image].as_ref());
        let (Some(path), Some(uvs)) = (path, &look.uvs) else {
            continue;
        };
        let texture = group - 1;
        let kind = if path.ends_with("png") { "png" } else { "jpeg" };
        let line = format!("  <m:texture2d id=\"{texture}\" path=\"{path}\" contenttype=\"image/{kind}\"/>\n");
        push(out, &line);
        push(
            out,
            &format!("  <m:texture2dgroup id=\"{group}\" texid=\"{texture}\">\n"),
        );
        for &[u, v] in uvs {
            push(out, "   <m:tex2coord u=\"");
            crate::text::push_f32(out, u);
            push(out, "\" v=\"");
            crate::text::push_f32(out, 1.0 - v);
            push(out, "\"/>\n");
        }
        push(out, "  </m:texture2dgroup>\n");
    }
}

fn push_mesh(
    out: &mut Vec<u8>,
    mesh: &NewMesh<'_>,
    dresses: &[Dress],
    palette: &Palette,
    course: &Course<'_>,
) -> Result<(), SaveError> {
    let (of_vertices, of_triangles) = course.split(0.5);
    let (vertices, number) = merged(mesh);
    push(out, "    <vertices>\n");
    for (place, vertex) in vertices.iter().enumerate() {
        of_vertices.pass(place, vertices.len())?;
        let position = mesh.positions[vertex.index()].to_array();
        push(out, "     <vertex");
        for (name, coordinate) in ["x", "y", "z"].into_iter().zip(position) {
            push(out, &format!(" {name}=\""));
            push_f64(out, coordinate);
            push(out, "\"");
        }
        push(out, "/>\n");
    }
    push(out, "    </vertices>\n    <triangles>\n");
    let mut groups = mesh.appearance.groups.iter().peekable();
    let mut dress = Dress::Nothing;
    for (place, triangle) in mesh.triangles.iter().enumerate() {
        of_triangles.pass(place, mesh.triangles.len())?;
        while let Some(group) = groups.next_if(|group| group.triangles.start as usize <= place) {
            if !group.triangles.is_empty() {
                dress = dresses[group.material];
            }
        }
        let [a, b, c] = triangle.map(|corner| number[corner.index()]);
        push(out, &format!("     <triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\""));
        let (group, [p1, p2, p3]) = match dress {
            Dress::Nothing => {
                push(out, "/>\n");
                continue;
            }
            Dress::Base(base) => (BASES, [base; 3]),
            Dress::Colours => (
                COLOURS,
                triangle.map(|corner: DrawnVertex| palette.of_vertex[corner.index()]),
            ),
            Dress::Texture(group) => (group, triangle.map(|corner| corner.0)),
        };
        push(
            out,
            &format!(" pid=\"{group}\" p1=\"{p1}\" p2=\"{p2}\" p3=\"{p3}\"/>\n"),
        );
    }
    push(out, "    </triangles>\n");
    Ok(())
}

/// Warnings about data that 3MF can't hold.
fn left_out(mesh: &NewMesh<'_>, dresses: &[Dress]) -> Vec<String> {
    let look = &mesh.appearance;
    let has = |wanted: fn(&Dress) -> bool| dresses.iter().any(wanted);
    let textured = has(|dress| matches!(dress, Dress::Texture(_)));
    let coloured = has(|dress| matches!(dress, Dress::Colours));
    let maps = |material: &Material| {
        material.metallic_roughness_map.is_some()
            || material.normal_map.is_some()
            || material.occlusion_map.is_some()
            || material.emissive_map.is_some()
    };
    let lost_materials = look
        .materials
        .iter()
        .zip(dresses)
        .any(|(material, dress)| maps(material) || (!is_plain(material) && !matches!(dress, Dress::Base(_))));
    let mut warnings: Vec<String> = lost(
        "3MF",
        &[
            ("normals", lost_where(look.normals.is_some())),
            ("colours", lost_where(look.colours.is_some() && !coloured)),
            ("texture coordinates", lost_where(look.uvs.is_some() && !textured)),
            ("materials", lost_where(lost_materials)),
            ("textures", lost_where(!look.images.is_empty() && !textured)),
        ],
    )
    .into_iter()
    .collect();
    if mesh.polygons.is_some() {
        warnings.push("3MF holds only triangles, so polygons were cut: save as .obj to keep them.".to_owned());
    }
    warnings
}
