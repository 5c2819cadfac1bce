//! Laws of the shaders that need no device: they are valid, they translate to HLSL and MSL, and the layouts of their
//! structs match the Rust structs.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

use std::mem::offset_of;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use pliant_shaders::Shader;

use crate::pipelines::MaterialAttributes;
use crate::pipelines::vertex_layouts::{
    OVERLAY_LINE_BUFFER, OVERLAY_TRIANGLE_BUFFER, SHAPE_BUFFERS, SURFACE_LINE_BUFFER, material_buffers,
};
use crate::uniforms::{
    EnvironmentUniform, FrameUniform, GridUniform, MapUniform, MatcapUniform, MaterialUniform, MaterialVertex,
    OverlayLineInstance, OverlayVertex, ShadowUniform, SurfaceLineInstance, SurfaceUniform,
};

#[test]
fn every_shader_is_valid() {
    for &shader in Shader::ALL {
        let (module, _) = validated(shader);
        assert!(
            !module.entry_points.is_empty(),
            "{} has entry points",
            shader.file_name()
        );
    }
}

#[test]
fn no_include_is_left_over() {
    for &shader in Shader::ALL {
        assert!(!shader.composed().contains("#include"), "{}", shader.file_name());
    }
}

#[test]
fn every_shader_translates_to_hlsl() {
    for &shader in Shader::ALL {
        let (module, info) = validated(shader);
        let mut text = String::new();
        let options = naga::back::hlsl::Options {
            shader_model: naga::back::hlsl::ShaderModel::V6_0,
            ..Default::default()
        };
        let pipeline = naga::back::hlsl::PipelineOptions::default();
        naga::back::hlsl::Writer::new(&mut text, &options, &pipeline)
            .write(&module, &info, None)
            .unwrap_or_else(|error| panic!("{}: {error}", shader.file_name()));
        assert!(text.contains("SV_Position"), "{}", shader.file_name());
    }
}

#[test]
fn every_shader_translates_to_msl() {
    for &shader in Shader::ALL {
        let (module, info) = validated(shader);
        let options = naga::back::msl::Options {
            lang_version: (2, 4),
            fake_missing_bindings: true,
            ..Default::default()
        };
        let pipeline = naga::back::msl::PipelineOptions::default();
        let (text, translation) = naga::back::msl::write_string(&module, &info, &options, &pipeline)
            .unwrap_or_else(|error| panic!("{}: {error}", shader.file_name()));
        assert!(text.contains("[[position]]"), "{}", shader.file_name());
        for name in translation.entry_point_names {
            name.unwrap_or_else(|error| panic!("{}: {error}", shader.file_name()));
        }
    }
}

/// Size of `$rust`, and offsets and sizes of its members, to compare with a WGSL struct.
macro_rules! layout {
    ($rust:ident { $($member:ident: $ty:ty),+ $(,)? }) => {
        (size_of::<$rust>() as u32, vec![$((
            stringify!($member).to_owned(),
            offset_of!($rust, $member) as u32,
            size_of::<$ty>() as u32,
        )),+])
    };
}

#[test]
fn uniform_structs_are_laid_out_alike() {
    let frame = layout!(FrameUniform {
        clip_from_world: [[f32; 4]; 4],
        view_from_world: [[f32; 4]; 4],
        background_top: [f32; 4],
        background_bottom: [f32; 4],
        size_px: [f32; 2],
        background_span: [f32; 2],
        region_share: f32,
        scale_px: f32,
        perspective: f32,
        flatness: f32,
        pixels_per_point: f32,
        padding: f32,
        padding_to_16: [f32; 2],
    });
    let frameless = [Shader::Mipmap, Shader::Environment, Shader::ShadowBlur];
    for &shader in Shader::ALL.iter().filter(|shader| !frameless.contains(shader)) {
        assert_eq!(wgsl_layout(shader, "Frame"), frame, "{}", shader.file_name());
    }
    let surface = layout!(SurfaceUniform {
        id_base: u32,
        colours_are_linear: u32,
        mean_edge: f32,
        padding: u32,
    });
    for shader in [
        Shader::Surface,
        Shader::Material,
        Shader::SurfaceId,
        Shader::Wireframe,
        Shader::SurfaceLine,
        Shader::ShadowOcclusion,
    ] {
        assert_eq!(wgsl_layout(shader, "Surface"), surface, "{}", shader.file_name());
    }
    let matcap = layout!(MatcapUniform {
        colour: [f32; 4],
        inside: [f32; 4],
        on_regions: [f32; 4],
    });
    assert_eq!(wgsl_layout(Shader::Surface, "Matcap"), matcap);
    let material = layout!(MaterialUniform {
        base_colour: [f32; 4],
        emissive: [f32; 4],
        metallic: f32,
        roughness: f32,
        normal_scale: f32,
        occlusion_strength: f32,
        back_share: f32,
        flags: u32,
        padding: [f32; 2],
        metallic_roughness: MapUniform,
        normal: MapUniform,
        occlusion: MapUniform,
        emission: MapUniform,
    });
    assert_eq!(wgsl_layout(Shader::Material, "Material"), material);
    let map = layout!(MapUniform {
        u: [f32; 4],
        v: [f32; 4]
    });
    assert_eq!(wgsl_layout(Shader::Material, "Map"), map);
    let grid = layout!(GridUniform {
        middle: [f32; 3],
        step: f32,
        along_u: [f32; 3],
        reach: f32,
        along_v: [f32; 3],
        fine_share: f32,
        axes: [f32; 2],
        padding: [f32; 2],
        colour: [f32; 4],
        u_axis_colour: [f32; 4],
        v_axis_colour: [f32; 4],
    });
    assert_eq!(wgsl_layout(Shader::Grid, "Grid"), grid);
    let shadow = layout!(ShadowUniform {
        middle: [f32; 3],
        half_side: f32,
        along_u: [f32; 3],
        padding: f32,
        along_v: [f32; 3],
        padding_to_16: f32,
    });
    assert_eq!(wgsl_layout(Shader::Shadow, "Shadow"), shadow);
    let environment = layout!(EnvironmentUniform {
        right: [f32; 4],
        down: [f32; 4],
        forward: [f32; 4],
        roughness: f32,
        samples: u32,
        padding: [f32; 2],
    });
    assert_eq!(wgsl_layout(Shader::Environment, "Face"), environment);
}

#[test]
fn vertex_buffers_have_what_shaders_read() {
    let shape: Vec<_> = SHAPE_BUFFERS.iter().flatten().cloned().collect();
    assert_attributes(Shader::Surface, "SurfaceVertex", &shape);
    assert_attributes(Shader::Material, "SurfaceVertex", &shape);
    for attributes in [MaterialAttributes::PerVertex, MaterialAttributes::Shared] {
        let buffers = material_buffers(attributes);
        let own: Vec<_> = buffers[3].iter().cloned().collect();
        assert_attributes(Shader::Material, "MaterialVertex", &own);
    }
    assert_attributes(Shader::SurfaceLine, "SurfaceLine", &[SURFACE_LINE_BUFFER]);
    assert_attributes(Shader::OverlayTriangle, "OverlayVertex", &[OVERLAY_TRIANGLE_BUFFER]);
    assert_attributes(Shader::OverlayLine, "OverlayLine", &[OVERLAY_LINE_BUFFER]);
}

#[test]
fn vertex_structs_have_their_members_where_their_buffers_say() {
    let offsets = |layout: &wgpu::VertexBufferLayout<'_>| -> Vec<u64> {
        layout.attributes.iter().map(|attribute| attribute.offset).collect()
    };
    let triangle = [
        offset_of!(OverlayVertex, position),
        offset_of!(OverlayVertex, colour),
        offset_of!(OverlayVertex, hidden_share),
    ];
    assert_eq!(offsets(&OVERLAY_TRIANGLE_BUFFER), triangle.map(|offset| offset as u64));
    let line = [
        offset_of!(OverlayLineInstance, start),
        offset_of!(OverlayLineInstance, width_px),
        offset_of!(OverlayLineInstance, end),
        offset_of!(OverlayLineInstance, hidden_share),
        offset_of!(OverlayLineInstance, start_colour),
        offset_of!(OverlayLineInstance, end_colour),
    ];
    assert_eq!(offsets(&OVERLAY_LINE_BUFFER), line.map(|offset| offset as u64));
    for buffer in SHAPE_BUFFERS.iter().flatten() {
        assert_eq!(buffer.array_stride, buffer.attributes[0].format.size());
    }
    let expected = [offset_of!(MaterialVertex, uvs), offset_of!(MaterialVertex, colour)];
    for buffer in material_buffers(MaterialAttributes::PerVertex)[3].iter() {
        assert_eq!(offsets(buffer), expected.map(|offset| offset as u64));
    }
    let line = [
        offset_of!(SurfaceLineInstance, start),
        offset_of!(SurfaceLineInstance, end),
        offset_of!(SurfaceLineInstance, shares),
        offset_of!(SurfaceLineInstance, width_points),
        offset_of!(SurfaceLineInstance, hidden_share),
        offset_of!(SurfaceLineInstance, colour),
    ];
    assert_eq!(offsets(&SURFACE_LINE_BUFFER), line.map(|offset| offset as u64));
}

fn validated(shader: Shader) -> (naga::Module, ModuleInfo) {
    let text = shader.composed();
    let module = naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(&text, shader.file_name())));
    // Only core WGSL, except for the primitive index in the shader that needs it.
    let capabilities = match shader {
        Shader::SurfaceId => Capabilities::PRIMITIVE_INDEX,
        _ => Capabilities::empty(),
    };
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(&text, shader.file_name())));
    (module, info)
}

/// Size of a WGSL struct, and name, offset and size of its members.
fn wgsl_layout(shader: Shader, name: &str) -> (u32, Vec<(String, u32, u32)>) {
    let (module, _) = validated(shader);
    let (members, span) = wgsl_struct(&module, shader, name);
    let sizes = members.iter().map(|member| {
        let size = module.types[member.ty].inner.size(module.to_ctx());
        (member.name.clone().unwrap(), member.offset, size)
    });
    (span, sizes.collect())
}

fn wgsl_struct<'a>(module: &'a naga::Module, shader: Shader, name: &str) -> (&'a [naga::StructMember], u32) {
    let found = module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
            Some((members.as_slice(), *span))
        }
        _ => None,
    });
    found.unwrap_or_else(|| panic!("{} has a struct {name}", shader.file_name()))
}

/// Every `@location` of a WGSL struct has exactly one vertex attribute, with the same number of components.
fn assert_attributes(shader: Shader, name: &str, buffers: &[wgpu::VertexBufferLayout<'_>]) {
    let (module, _) = validated(shader);
    let (members, _) = wgsl_struct(&module, shader, name);
    let mut read: Vec<(u32, u32)> = Vec::new();
    for member in members {
        let Some(naga::Binding::Location { location, .. }) = member.binding else {
            panic!("{name}.{:?} has a location", member.name)
        };
        read.push((location, module.types[member.ty].inner.size(module.to_ctx()) / 4));
    }
    let mut given: Vec<(u32, u32)> = buffers
        .iter()
        .flat_map(|buffer| buffer.attributes)
        .map(|attribute| (attribute.shader_location, components(attribute.format)))
        .collect();
    read.sort_unstable();
    given.sort_unstable();
    assert_eq!(read, given, "{} {name}", shader.file_name());
}

fn components(format: wgpu::VertexFormat) -> u32 {
    match format {
        wgpu::VertexFormat::Float32 => 1,
        wgpu::VertexFormat::Float32x2 => 2,
        wgpu::VertexFormat::Uint32x2 => 2,
        wgpu::VertexFormat::Float32x3 => 3,
        wgpu::VertexFormat::Float32x4 => 4,
        wgpu::VertexFormat::Unorm8x4 => 4,
        other => panic!("say here how many components {other:?} has"),
    }
}
