//! Pliant's shaders, a crate of their own so that what embeds them can be published: each WGSL file beside `src`, with its
//! includes expanded.
//!
//! There is no preprocessor crate, because a handful of shaders needs only a line `#include "lib/NAME.wgsl"` that a
//! file replaces. The line numbers in naga's messages refer to the expanded source.
//!
//! ```
//! use pliant_shaders::Shader;
//!
//! assert!(Shader::Grid.composed().contains("@fragment"));
//! ```

/// Makes the list of shaders from their files' names.
macro_rules! shaders {
    ($($shader:ident = $file:literal,)+) => {
        /// A file with a shader.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the files are named by what they draw")]
        pub enum Shader {
            $($shader,)+
        }

        impl Shader {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$shader),+];

            /// The file's name.
            pub fn file_name(self) -> &'static str {
                match self {
                    $(Self::$shader => $file,)+
                }
            }

            fn text(self) -> &'static str {
                match self {
                    $(Self::$shader => include_str!(concat!("../", $file)),)+
                }
            }
        }
    };
}

shaders! {
    Surface = "surface.wgsl",
    SurfaceId = "surface_id.wgsl",
    Material = "material.wgsl",
    Environment = "environment.wgsl",
    Wireframe = "wireframe.wgsl",
    SurfaceLine = "surface_line.wgsl",
    Background = "background.wgsl",
    Grid = "grid.wgsl",
    Shadow = "shadow.wgsl",
    ShadowOcclusion = "shadow_occlusion.wgsl",
    ShadowBlur = "shadow_blur.wgsl",
    OverlayTriangle = "overlay_triangle.wgsl",
    OverlayLine = "overlay_line.wgsl",
    Mipmap = "mipmap.wgsl",
}

/// Makes the list of files that can be included.
macro_rules! library {
    ($($file:literal,)+) => {
        const LIBRARY: &[(&str, &str)] = &[$(($file, include_str!(concat!("../", $file)))),+];
    };
}

library! {
    "lib/frame.wgsl",
    "lib/ground.wgsl",
    "lib/colour.wgsl",
    "lib/surface_vertex.wgsl",
    "lib/surface_shape.wgsl",
    "lib/tone.wgsl",
    "lib/reflectance.wgsl",
    "lib/line.wgsl",
}

impl Shader {
    /// The file's source with its includes expanded. An include of an unknown file stays, so that the compiler reports it.
    pub fn composed(self) -> String {
        let text = self.text();
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
}
