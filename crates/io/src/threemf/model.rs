//! A model part: its objects, resources and build items.

use glam::{DAffine3, DVec3};
use pliant_mesh::Cancel;

use super::resources::{Base, Resources, colour};
use super::xml::{Element, Step, walk};
use crate::ReadError;
use crate::quote::quoted;

/// Elements between two checks for cancelling.
const ELEMENTS_BETWEEN_LOOKS: usize = 1 << 13;

/// A reason not to read a part.
#[derive(Debug)]
pub(super) enum Fault {
    /// The part is damaged.
    Malformed(String),
    /// The caller cancelled.
    Stopped(ReadError),
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Malformed(reason)
    }
}

/// A triangle of an object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Vertices of the object.
    pub corners: [u32; 3],
    /// The group of its property and the indices at its corners.
    pub property: Option<(u32, [u32; 3])>,
    /// The place of its element in the part.
    pub at: usize,
}

/// A part of an object that is another object.
#[derive(Clone, Debug)]
pub(super) struct Component {
    pub object: u32,
    /// The part that has the object; this one if there is none.
    pub path: Option<String>,
    pub transform: DAffine3,
}

/// An object: a mesh, or other objects.
#[derive(Debug, Default)]
pub(super) struct Object {
    pub id: u32,
    pub name: String,
    pub vertices: Vec<DVec3>,
    /// The place of each vertex's element in the part.
    pub vertex_at: Vec<usize>,
    pub triangles: Vec<Triangle>,
    pub components: Vec<Component>,
    /// The property of triangles that have none.
    property: Option<(u32, u32)>,
}

/// The content of a model part.
#[derive(Debug, Default)]
pub(super) struct Model {
    pub objects: Vec<Object>,
    pub resources: Resources,
    pub items: Vec<Component>,
    /// It has groups that are kept but not drawn.
    pub has_other_groups: bool,
}

/// Reads a part.
pub(super) fn parse(part: &[u8], cancel: &Cancel) -> Result<Model, Fault> {
    let mut model = Model::default();
    let mut seen = 0_usize;
    let mut has_root = false;
    let (mut group, mut is_in_mesh) = (None, false);
    walk(part, |step| {
        seen += 1;
        if seen.is_multiple_of(ELEMENTS_BETWEEN_LOOKS) {
            cancel.check().map_err(|stopped| Fault::Stopped(stopped.into()))?;
        }
        match step {
            Step::Open(element) => {
                let name = element.name();
                has_root |= name == b"model";
                is_in_mesh |= name == b"mesh";
                // The slices of an extension have vertices, too.
                match is_in_mesh {
                    true => corner(&mut model, &element).map_err(Fault::Malformed),
                    false => opened(&mut model, &mut group, &element).map_err(Fault::Malformed),
                }
            }
            Step::Close(name) => {
                is_in_mesh &= name != b"mesh";
                if name == b"object" {
                    model.objects.last().map_or(Ok(()), check)?;
                }
                Ok(())
            }
        }
    })?;
    match has_root {
        true => Ok(model),
        false => Err("it has no `model`".to_owned().into()),
    }
}

/// Takes an element of a mesh into the last object.
fn corner(model: &mut Model, element: &Element<'_>) -> Result<(), String> {
    let Some(object) = model.objects.last_mut() else {
        return Ok(());
    };
    match &element.name()[..] {
        b"vertex" => {
            let [x, y, z] = ["x", "y", "z"].map(|name| element.real(name));
            object.vertices.push(DVec3::new(x?, y?, z?));
            object.vertex_at.push(element.at);
        }
        b"triangle" => object.triangles.push(triangle(element, object.property)?),
        _ => {}
    }
    Ok(())
}

/// Takes an element into the model; `group` is the number of the last group of resources.
fn opened(model: &mut Model, group: &mut Option<u32>, element: &Element<'_>) -> Result<(), String> {
    match &element.name()[..] {
        b"object" => {
            let property = element.index("pid")?.zip(element.index("pindex")?.or(Some(0)));
            model.objects.push(Object {
                id: element.wanted_index("id")?,
                name: element.text("name").unwrap_or_default(),
                property,
                ..Object::default()
            });
        }
        b"component" => {
            let component = component(element)?;
            if let Some(object) = model.objects.last_mut() {
                object.components.push(component);
            }
        }
        b"item" => model.items.push(component(element)?),
        name => resource(model, name, group, element)?,
    }
    Ok(())
}

/// Takes an element of a group of resources into the model.
fn resource(model: &mut Model, name: &[u8], group: &mut Option<u32>, element: &Element<'_>) -> Result<(), String> {
    let resources = &mut model.resources;
    match name {
        b"basematerials" | b"colorgroup" | b"texture2dgroup" => {
            let id = element.wanted_index("id")?;
            *group = Some(id);
            match name {
                b"basematerials" => drop(resources.bases.insert(id, Vec::new())),
                b"colorgroup" => drop(resources.colours.insert(id, Vec::new())),
                _ => {
                    let texture = element.wanted_index("texid")?;
                    resources.coordinates.insert(id, (texture, Vec::new()));
                }
            }
        }
        b"compositematerials" | b"multiproperties" => {
            model.has_other_groups = true;
            *group = None;
        }
        b"base" => {
            if let Some(bases) = group.and_then(|id| resources.bases.get_mut(&id)) {
                bases.push(Base {
                    name: element.text("name").unwrap_or_default(),
                    colour: colour(&element.text("displaycolor").unwrap_or_default()),
                });
            }
        }
        b"color" => {
            if let Some(colours) = group.and_then(|id| resources.colours.get_mut(&id)) {
                colours.push(colour(&element.text("color").unwrap_or_default()));
            }
        }
        b"tex2coord" => {
            if let Some((_, coordinates)) = group.and_then(|id| resources.coordinates.get_mut(&id)) {
                // f32: texture coordinates are only ever drawn and saved as f32.
                coordinates.push([element.real("u")? as f32, element.real("v")? as f32]);
            }
        }
        b"texture2d" => {
            let path = element.text("path").unwrap_or_default();
            resources.textures.insert(element.wanted_index("id")?, path);
        }
        _ => {}
    }
    Ok(())
}

fn triangle(element: &Element<'_>, of_object: Option<(u32, u32)>) -> Result<Triangle, String> {
    let [a, b, c] = ["v1", "v2", "v3"].map(|name| element.wanted_index(name));
    let first = element.index("p1")?;
    let [second, third] = [element.index("p2")?, element.index("p3")?];
    let group = element.index("pid")?.or(of_object.map(|(group, _)| group));
    let property = match (group, first) {
        (Some(group), Some(first)) => Some((group, [first, second.unwrap_or(first), third.unwrap_or(first)])),
        _ => of_object.map(|(group, index)| (group, [index; 3])),
    };
    Ok(Triangle {
        corners: [a?, b?, c?],
        property,
        at: element.at,
    })
}

fn component(element: &Element<'_>) -> Result<Component, String> {
    let transform = match element.text("transform") {
        None => DAffine3::IDENTITY,
        Some(text) => transform(&text)
            .ok_or_else(|| format!("the `transform` at byte {} is no row of twelve numbers", element.at))?,
    };
    Ok(Component {
        object: element.wanted_index("objectid")?,
        path: element.text("path"),
        transform,
    })
}

/// Twelve numbers: the images of the axes, and the translation.
fn transform(text: &str) -> Option<DAffine3> {
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map(|number| number.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect::<Option<_>>()?;
    let columns: [f64; 12] = numbers.try_into().ok()?;
    Some(DAffine3::from_cols_array(&columns))
}

/// Refuses a triangle whose vertices the object does not have.
fn check(object: &Object) -> Result<(), String> {
    let count = object.vertices.len();
    let is_beyond = |triangle: &&Triangle| triangle.corners.iter().any(|&corner| corner as usize >= count);
    match object.triangles.iter().find(is_beyond) {
        None => Ok(()),
        Some(triangle) => Err(format!(
            "the triangle at byte {} names a vertex that object {} ({}) does not have",
            triangle.at,
            object.id,
            quoted(&object.name)
        )),
    }
}
