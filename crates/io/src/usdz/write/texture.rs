//! The nodes of a texture.

use std::fmt::Write as _;

use crate::appearance::Wrap;

/// A texture of a material.
pub(super) struct Texture<'a> {
    pub name: &'a str,
    pub path: &'a str,
    pub wrap: [Wrap; 2],
    pub space: &'a str,
    pub scale: [f32; 4],
    pub bias: [f32; 4],
}

/// Appends the node of a texture of the material with the path `own`.
pub(super) fn push_texture(nodes: &mut String, own: &str, texture: &Texture<'_>) {
    let Texture {
        name,
        path,
        wrap,
        space,
        scale,
        bias,
    } = texture;
    let [wrap_s, wrap_t] = wrap.map(|wrap| match wrap {
        Wrap::Repeat => "repeat",
        Wrap::MirroredRepeat => "mirror",
        Wrap::ClampToEdge => "clamp",
    });
    let list = |numbers: &[f32; 4]| numbers.map(|number| number.to_string()).join(", ");
    let (scale, bias) = (list(scale), list(bias));
    // Writing to a String can't fail.
    let _ = write!(
        nodes,
        "\n            def Shader \"{name}\"\n            {{\n                \
         uniform token info:id = \"UsdUVTexture\"\n                \
         asset inputs:file = @{path}@\n                \
         float4 inputs:bias = ({bias})\n                \
         float4 inputs:scale = ({scale})\n                \
         token inputs:sourceColorSpace = \"{space}\"\n                \
         float2 inputs:st.connect = <{own}/Coordinates.outputs:result>\n                \
         token inputs:wrapS = \"{wrap_s}\"\n                \
         token inputs:wrapT = \"{wrap_t}\"\n                \
         float outputs:a\n                float outputs:b\n                float outputs:g\n                \
         float outputs:r\n                float3 outputs:rgb\n            }}\n"
    );
}
