//! Laws of overlays, tested if there is a device.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use pliant_render::{Background, Image, Overlay, OverlayLine, OverlayTriangle, Style};
use rig::{SIZE_PX, Shape, draw, front_view, is_near, pixel_at, renderer};

const MARK: [u8; 4] = [200, 100, 50, 255];

fn on_black() -> Style {
    Style {
        background: Background::Gradient {
            top: [0; 3],
            bottom: [0; 3],
        },
        ..Style::default()
    }
}

fn triangle(z: f32, colour: [u8; 4]) -> OverlayTriangle {
    OverlayTriangle {
        corners: [[-0.5, -0.5, z], [0.5, -0.5, z], [0.0, 0.7, z]],
        colours: [colour; 3],
    }
}

fn line(start: [f32; 3], end: [f32; 3], width_px: f32) -> OverlayLine {
    OverlayLine {
        ends: [start, end],
        colours: [MARK; 2],
        width_px,
    }
}

#[test]
fn an_overlay_has_exactly_its_colour() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let overlay = Overlay {
        triangles: vec![triangle(0.0, MARK)],
        ..Overlay::default()
    };
    let image = draw(&mut headless.renderer, &view, &on_black(), &[], &[overlay]);
    assert!(is_near(pixel_at(&image, &view, [0.0; 3]), MARK, 1));
}

#[test]
fn hidden_parts_of_overlays_are_fainter_by_the_hidden_share() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let square = Shape::square(0.0, 0.0, 1.2).upload(&headless.renderer);
    let bare = draw(&mut headless.renderer, &view, &on_black(), &[&square], &[]);
    let clay = pixel_at(&bare, &view, [0.0; 3]);
    let mut shown = |z, hidden_share| {
        let overlay = Overlay {
            triangles: vec![triangle(z, MARK)],
            hidden_share,
            ..Overlay::default()
        };
        let image = draw(&mut headless.renderer, &view, &on_black(), &[&square], &[overlay]);
        pixel_at(&image, &view, [0.0; 3])
    };
    for share in [0.0, 0.5, 1.0] {
        assert!(
            is_near(shown(1.0, share), MARK, 1),
            "before the surface nothing is hidden"
        );
    }
    assert!(is_near(shown(-1.0, 0.0), clay, 1));
    assert!(is_near(shown(-1.0, 1.0), MARK, 1));
    let half = shown(-1.0, 0.5);
    assert!(!is_near(half, clay, 10) && !is_near(half, MARK, 10));
}

#[test]
fn an_overlay_on_a_surface_is_fully_visible() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let square = Shape::square(0.0, 0.0, 1.2).upload(&headless.renderer);
    let overlay = Overlay {
        lines: vec![line([-1.0, 0.1, 0.0], [1.0, 0.1, 0.0], 5.0)],
        ..Overlay::default()
    };
    let image = draw(&mut headless.renderer, &view, &on_black(), &[&square], &[overlay]);
    for step in 0..=18 {
        let x = -0.9 + 0.1 * step as f32;
        assert!(is_near(pixel_at(&image, &view, [x, 0.1, 0.0]), MARK, 1), "at {x}");
    }
}

#[test]
fn a_line_has_its_width_at_any_distance() {
    let Some(mut headless) = renderer() else { return };
    for (width_px, z) in [(1.0, 0.0), (3.0, 0.0), (6.0, 2.0), (6.0, -20.0)] {
        let lines = vec![line([-9.0, 0.0, z], [9.0, 0.0, z], width_px)];
        let overlay = Overlay {
            lines,
            ..Overlay::default()
        };
        let image = draw(&mut headless.renderer, &front_view(), &on_black(), &[], &[overlay]);
        // Coverage across the line adds up to its width.
        let linear = |byte: u8| (f64::from(byte) / 255.0 + 0.055).max(0.0).powf(2.4) / 1.055_f64.powf(2.4);
        let column = (0..SIZE_PX[1]).map(|y| image.pixel(SIZE_PX[0] / 2, y).unwrap()[0]);
        let black = linear(0);
        let sum: f64 = column
            .map(|red| (linear(red) - black) / (linear(MARK[0]) - black))
            .sum();
        assert!((sum - f64::from(width_px)).abs() < 0.35, "{width_px} px at {z}: {sum}");
    }
}

#[test]
fn a_line_through_the_eye_is_clipped_at_the_near_plane() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let through = line([0.3, -0.4, 0.0], [0.3, 3.0, 60.0], 4.0);
    let behind = line([-1.0, 0.0, 9.0], [1.0, 0.5, 50.0], 4.0);
    let cut = Overlay {
        lines: vec![through, behind],
        ..Overlay::default()
    };
    let image = draw(&mut headless.renderer, &view, &on_black(), &[], &[cut]);
    assert!(is_near(pixel_at(&image, &view, [0.3, -0.4 + 0.01, 0.2]), MARK, 40));
    let marked = |image: &Image| image.rgba.chunks_exact(4).filter(|pixel| pixel[0] > 20).count();
    let hidden = Overlay {
        lines: vec![behind],
        ..Overlay::default()
    };
    let nothing = draw(&mut headless.renderer, &view, &on_black(), &[], &[hidden]);
    assert_eq!(marked(&nothing), 0, "what is behind the eye is not seen");
    assert!(marked(&image) > 20);
}

#[test]
fn later_layers_lie_over_earlier_ones_and_many_marks_fit() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let under = Overlay {
        triangles: vec![triangle(0.0, MARK); 5000],
        ..Overlay::default()
    };
    let over = Overlay {
        triangles: vec![triangle(0.0, [0, 0, 255, 255])],
        ..Overlay::default()
    };
    let image = draw(
        &mut headless.renderer,
        &view,
        &on_black(),
        &[],
        &[under.clone(), over.clone()],
    );
    assert!(is_near(pixel_at(&image, &view, [0.0; 3]), [0, 0, 255, 255], 1));
    let image = draw(
        &mut headless.renderer,
        &view,
        &on_black(),
        &[],
        &[over, Overlay::default(), under],
    );
    assert!(is_near(pixel_at(&image, &view, [0.0; 3]), MARK, 1));
}
