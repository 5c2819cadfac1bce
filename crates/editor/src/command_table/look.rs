//! How the surface is shown.

use super::{Listed, character, listed};
use crate::{Command, Shading};

pub(super) const LISTED: &[Listed] = &[
    listed(
        Command::SetShading(Shading::Clay),
        "Clay",
        "Shades the surface like clay.",
        "matcap shading",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Material),
        "Material",
        "Shades the surface with the file's materials.",
        "texture colour color pbr",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Stretch),
        "Edge stretch",
        "Colours the surface by how much longer or shorter its edges are than at rest.",
        "strain distortion",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Area),
        "Area change",
        "Colours the surface by how much larger or smaller it is than at rest.",
        "distortion",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Stiffness),
        "Stiffness",
        "Colours the surface by how stiff it was painted.",
        "",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Curvature),
        "Curvature",
        "Colours the surface by its mean curvature: red bulges, blue is hollow.",
        "bulge",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Zebra),
        "Zebra stripes",
        "Mirrors stripes in the surface: they break at creases and kink where curvature jumps.",
        "reflection",
        &[],
    ),
    listed(
        Command::SetShading(Shading::Normals),
        "Normals",
        "Colours the surface by the direction in which it faces.",
        "",
        &[],
    ),
    listed(
        Command::ToggleFlat,
        "Flat faces",
        "Shows each triangle flat, or normals interpolated.",
        "facets smooth shading",
        &[],
    ),
    listed(
        Command::ToggleBorders,
        "Borders",
        "Marks edges where the surface ends, and those that more than two triangles share.",
        "boundary holes edges",
        &[],
    ),
    listed(
        Command::ToggleOutlines,
        "Outlines",
        "Shows or hides the outlines of handles, and the line where the region meets what is held.",
        "contours",
        &[],
    ),
    listed(
        Command::ToggleGrid,
        "Ground grid",
        "Shows or hides the ground's grid.",
        "floor",
        &[],
    ),
    listed(
        Command::ToggleRegions,
        "Show regions",
        "Shows or hides the regions' colours.",
        "colours colors overlay",
        &[],
    ),
    listed(
        Command::ToggleWireframe,
        "Wireframe",
        "Shows or hides the triangles' edges.",
        "edges triangles mesh",
        &[character('w')],
    ),
];
