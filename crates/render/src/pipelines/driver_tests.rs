//! Laws of the pipelines that need a device, though not one that draws: its driver's compiler accepts every pipeline.
//!
//! Mesa's Radeon driver compiles for absent cards (`RADV_FORCE_FAMILY=navi21`) and fails only when work is submitted,
//! so some of them are tested in the same way.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use pliant_shaders::Shader;

use super::description::PipelineDescription;
use super::{Alpha, MaterialAttributes, Pipeline, Pipelines, Visibility};
use crate::device::guard::guarded;
use crate::materials::environment;
use crate::surface::shadow;
use crate::{Headless, Samples};

/// All pipelines, because of [`every_fragment_shader_belongs_to_a_pipeline`].
fn every_pipeline() -> Vec<Pipeline> {
    let mut every = vec![
        Pipeline::Matcap,
        Pipeline::Painted,
        Pipeline::Zebra,
        Pipeline::Normals,
        Pipeline::Wireframe,
        Pipeline::Background,
        Pipeline::Grid,
        Pipeline::Occlusion,
        Pipeline::Shadow,
        Pipeline::Id,
    ];
    for alpha in [Alpha::Opaque, Alpha::Mask, Alpha::Blend] {
        for attributes in [MaterialAttributes::PerVertex, MaterialAttributes::Shared] {
            every.push(Pipeline::Material(alpha, attributes));
        }
    }
    for visibility in Visibility::BOTH {
        every.push(Pipeline::SurfaceLines(visibility));
        every.push(Pipeline::OverlayTriangles(visibility));
        every.push(Pipeline::OverlayLines(visibility));
    }
    every
}

#[test]
fn every_fragment_shader_belongs_to_a_pipeline() {
    let fullscreen = [Shader::Mipmap, Shader::Environment, Shader::ShadowBlur];
    let mut written = BTreeSet::new();
    for &shader in Shader::ALL.iter().filter(|shader| !fullscreen.contains(shader)) {
        let module = naga::front::wgsl::parse_str(&shader.composed()).unwrap();
        for entry in module.entry_points {
            if entry.stage == naga::ShaderStage::Fragment {
                written.insert((shader.file_name(), entry.name));
            }
        }
    }
    let taken = every_pipeline().into_iter().map(|pipeline| {
        let description = PipelineDescription::of(pipeline);
        (description.shader.file_name(), description.fragment_entry.to_owned())
    });
    assert_eq!(written, taken.collect());
}

/// Cards of the generations whose compilers differ most: GCN 4, GCN 5, RDNA 1 and RDNA 2.
const CARDS: [&str; 4] = ["polaris10", "vega10", "navi10", "navi21"];

/// The manifest of Mesa's driver for Radeon cards.
const RADEON: &str = "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json";

/// The one of [`CARDS`] that a test process must find.
const CARD: &str = "PLIANT_TEST_CARD";

#[test]
fn the_driver_compiles_every_pipeline() {
    // The pipelines of textures are made with the renderer.
    let headless = match Headless::new() {
        Ok(headless) => headless,
        Err(error) => return say(&format!("skipped: pictures ({error})")),
    };
    if let Ok(card) = std::env::var(CARD) {
        let name = headless.renderer.device_name().to_lowercase();
        assert!(name.contains(&card), "{name} is not {card}");
    }
    let device = headless.renderer.device();
    let mut pipelines = Pipelines::new(device);
    for pipeline in every_pipeline() {
        for samples in [Samples::One, Samples::Four] {
            if matches!(pipeline, Pipeline::Id | Pipeline::Occlusion) && samples == Samples::Four {
                continue; // These are drawn with only one sample.
            }
            pipelines
                .prepare(device, pipeline, samples)
                .unwrap_or_else(|error| panic!("{pipeline:?}, {samples:?}: {error}"));
        }
    }
    guarded(device, "while compiling shaders", || {
        Ok((environment::pipelines(device), shadow::blurs(device)))
    })
    .unwrap();
}

#[test]
fn drivers_of_cards_that_are_not_here_compile_every_pipeline() {
    if !Path::new(RADEON).exists() {
        return say("skipped: pictures on Radeon cards (Mesa's driver for them is not installed)");
    }
    for card in CARDS {
        // A process loads its drivers once: each card needs its own process.
        let output = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "pipelines::driver_tests::the_driver_compiles_every_pipeline"])
            .env("RADV_FORCE_FAMILY", card)
            .env("VK_DRIVER_FILES", RADEON)
            .env("VK_ICD_FILENAMES", RADEON)
            .env(CARD, card)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && said.contains("1 passed"), "{card}: {said}");
        assert!(!said.contains("skipped"), "{card}: {said}");
    }
}

fn say(sentence: &str) {
    #[expect(clippy::print_stderr, reason = "a skipped test says so")]
    {
        eprintln!("{sentence}");
    }
}
