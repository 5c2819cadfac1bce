//! Parts of a PLY file that are kept, but neither shown nor carried over to another format.

use super::header::Element;
use super::records::{Columns, TEXTURE_NUMBER, UV_LIST, corner_list};
use crate::quote::{listed, quoted};

/// The parts of a file that aren't read, in words: properties by their element, then further elements.
pub(super) fn parts(elements: &[Element], vertex_element: Option<usize>, columns: &Columns) -> Vec<String> {
    let mut parts = Vec::new();
    let mut others = Vec::new();
    for (number, element) in elements.iter().enumerate().filter(|(_, element)| element.count > 0) {
        let is_read = |property: usize| match element.name.as_str() {
            _ if Some(number) == vertex_element => columns.contains(&Some(property)),
            "face" | "tristrips" => {
                let name = &element.properties[property].name;
                let is_look = [UV_LIST, TEXTURE_NUMBER]
                    .iter()
                    .any(|own| name.eq_ignore_ascii_case(own));
                corner_list(element) == Some(property) || (is_look && element.name == "face")
            }
            _ => true,
        };
        let unread: Vec<&str> = (element.properties.iter().enumerate())
            .filter(|&(property, _)| !is_read(property))
            .map(|(_, property)| property.name.as_str())
            .collect();
        if !unread.is_empty() {
            parts.push(format!("{} of each '{}'", listed(&unread), quoted(&element.name)));
        }
        if Some(number) != vertex_element && !matches!(element.name.as_str(), "face" | "tristrips") {
            others.push(element.name.as_str());
        }
    }
    if !others.is_empty() {
        let elements = if others.len() == 1 { "element" } else { "elements" };
        parts.push(format!("the {elements} {}", listed(&others)));
    }
    parts
}

/// Notes on parts that users expect an edit or a viewer to heed.
pub(super) fn notes(elements: &[Element], vertex_element: Option<usize>) -> Vec<String> {
    let mut notes = Vec::new();
    let has_all = |element: &Element, names: &[&str]| names.iter().all(|name| element.property(&[name]).is_some());
    if let Some(vertex) = vertex_element.map(|number| &elements[number]) {
        if has_all(vertex, &["rot_0", "scale_0", "opacity"]) {
            notes.push(
                "The vertices are Gaussian splats: an edit moves their centres but keeps their rotations, scales and \
                 harmonics, so a bent scan turns into needles."
                    .to_owned(),
            );
        }
        for [x, y, z] in DIRECTIONS.iter().filter(|names| has_all(vertex, &names[..])) {
            notes.push(format!(
                "The directions {x}, {y}, {z} of the vertices don't turn with an edit."
            ));
        }
    }
    let is_coloured = |element: &&Element| element.name == "face" && has_all(element, &["red", "green", "blue"]);
    if elements
        .iter()
        .filter(|element| element.count > 0)
        .any(|element| is_coloured(&element))
    {
        notes.push("The colours of its faces are kept but not shown.".to_owned());
    }
    notes
}

/// Names of directions other than normals.
const DIRECTIONS: [[&str; 3]; 6] = [
    ["tx", "ty", "tz"],
    ["tangent_x", "tangent_y", "tangent_z"],
    ["bx", "by", "bz"],
    ["binormal_x", "binormal_y", "binormal_z"],
    ["vx", "vy", "vz"],
    ["velocity_x", "velocity_y", "velocity_z"],
];
