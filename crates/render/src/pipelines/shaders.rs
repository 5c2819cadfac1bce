//! The embedded source of the shaders: each file of `shaders/` with its includes expanded.
//!
//! There is no preprocessor crate, because a handful of shaders needs only a line `#include "lib/NAME.wgsl"` that a
//! file replaces. The line numbers in naga's messages refer to the expanded source.

/// A shader file in `shaders/`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Shader {
    Surface,
    SurfaceId,
    Material,
    Environment,
    Wireframe,
    SurfaceLine,
    Background,
    Grid,
    Shadow,
    ShadowOcclusion,
    ShadowBlur,
    OverlayTriangle,
    OverlayLine,
    Mipmap,
}

impl Shader {
    /// All of them.
    #[cfg(test)]
    pub(crate) const ALL: [Self; 14] = [
        Self::Surface,
        Self::SurfaceId,
        Self::Material,
        Self::Environment,
        Self::Wireframe,
        Self::SurfaceLine,
        Self::Background,
        Self::Grid,
        Self::Shadow,
        Self::ShadowOcclusion,
        Self::ShadowBlur,
        Self::OverlayTriangle,
        Self::OverlayLine,
        Self::Mipmap,
    ];

    /// The file's name under `shaders/`.
    pub(crate) fn file_name(self) -> &'static str {
        match self {
            Self::Surface => "surface.wgsl",
            Self::SurfaceId => "surface_id.wgsl",
            Self::Material => "material.wgsl",
            Self::Environment => "environment.wgsl",
            Self::Wireframe => "wireframe.wgsl",
            Self::SurfaceLine => "surface_line.wgsl",
            Self::Background => "background.wgsl",
            Self::Grid => "grid.wgsl",
            Self::Shadow => "shadow.wgsl",
            Self::ShadowOcclusion => "shadow_occlusion.wgsl",
            Self::ShadowBlur => "shadow_blur.wgsl",
            Self::OverlayTriangle => "overlay_triangle.wgsl",
            Self::OverlayLine => "overlay_line.wgsl",
            Self::Mipmap => "mipmap.wgsl",
        }
    }

    /// The file's source with its includes expanded.
    pub(crate) fn composed(self) -> String {
        compose(self.text())
    }

    fn text(self) -> &'static str {
        match self {
            Self::Surface => include_str!("../../shaders/surface.wgsl"),
            Self::SurfaceId => include_str!("../../shaders/surface_id.wgsl"),
            Self::Material => include_str!("../../shaders/material.wgsl"),
            Self::Environment => include_str!("../../shaders/environment.wgsl"),
            Self::Wireframe => include_str!("../../shaders/wireframe.wgsl"),
            Self::SurfaceLine => include_str!("../../shaders/surface_line.wgsl"),
            Self::Background => include_str!("../../shaders/background.wgsl"),
            Self::Grid => include_str!("../../shaders/grid.wgsl"),
            Self::Shadow => include_str!("../../shaders/shadow.wgsl"),
            Self::ShadowOcclusion => include_str!("../../shaders/shadow_occlusion.wgsl"),
            Self::ShadowBlur => include_str!("../../shaders/shadow_blur.wgsl"),
            Self::OverlayTriangle => include_str!("../../shaders/overlay_triangle.wgsl"),
            Self::OverlayLine => include_str!("../../shaders/overlay_line.wgsl"),
            Self::Mipmap => include_str!("../../shaders/mipmap.wgsl"),
        }
    }
}

/// The files that can be included.
const LIBRARY: [(&str, &str); 8] = [
    ("lib/frame.wgsl", include_str!("../../shaders/lib/frame.wgsl")),
    ("lib/ground.wgsl", include_str!("../../shaders/lib/ground.wgsl")),
    ("lib/colour.wgsl", include_str!("../../shaders/lib/colour.wgsl")),
    (
        "lib/surface_vertex.wgsl",
        include_str!("../../shaders/lib/surface_vertex.wgsl"),
    ),
    (
        "lib/surface_shape.wgsl",
        include_str!("../../shaders/lib/surface_shape.wgsl"),
    ),
    ("lib/tone.wgsl", include_str!("../../shaders/lib/tone.wgsl")),
    (
        "lib/reflectance.wgsl",
        include_str!("../../shaders/lib/reflectance.wgsl"),
    ),
    ("lib/line.wgsl", include_str!("../../shaders/lib/line.wgsl")),
];

/// `text` with its includes expanded. An include of an unknown file stays, so that the compiler reports it.
fn compose(text: &str) -> String {
    let mut composed = String::with_capacity(4 * text.len());
    for line in text.lines() {
        let included = line
            .trim()
            .strip_prefix("#include \"")
            .and_then(|rest| rest.strip_suffix('"'))
            .and_then(|name| LIBRARY.iter().find(|(shared, _)| *shared == name));
        composed.push_str(included.map_or(line, |(_, shared)| shared));
        composed.push('\n');
    }
    composed
}

#[cfg(test)]
#[path = "shader_tests.rs"]
mod tests;
