//! Laws of picking, tested if there is a device.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use glam::{Vec3, Vec4Swizzles};
use pliant_render::{Frame, IdTarget, Picked, PixelRect, Renderer, Style, Surface, View};
use rig::{SIZE_PX, Shape, front_view, parallel_front_view, renderer};

const WHOLE: PixelRect = PixelRect::whole(SIZE_PX);

fn pick(renderer: &mut Renderer, view: &View, surfaces: &[&Surface], rect: PixelRect) -> Vec<Option<Picked>> {
    let style = Style::default();
    let frame = Frame {
        view,
        style: &style,
        surfaces,
        grid: None,
        overlays: &[],
    };
    let mut target = IdTarget::new();
    let request = renderer.pick(&mut target, SIZE_PX, rect, &frame).unwrap();
    request.wait(renderer).unwrap().ids
}

/// The ray through the middle of a pixel.
fn ray(view: &View, x: u32, y: u32) -> (Vec3, Vec3) {
    let ndc_x = 2.0 * (x as f32 + 0.5) / SIZE_PX[0] as f32 - 1.0;
    let ndc_y = 1.0 - 2.0 * (y as f32 + 0.5) / SIZE_PX[1] as f32;
    let world_from_clip = view.clip_from_world.inverse();
    let at = |depth: f32| {
        let world = world_from_clip * Vec3::new(ndc_x, ndc_y, depth).extend(1.0);
        world.xyz() / world.w
    };
    let (near, far) = (at(0.9), at(0.001));
    (near, (far - near).normalize())
}

#[test]
fn the_id_in_each_pixel_is_the_triangle_that_a_ray_hits() {
    let Some(mut headless) = renderer() else { return };
    let shape = Shape::sphere(2);
    let surface = shape.upload(&headless.renderer);
    for view in [front_view(), parallel_front_view()] {
        let ids = pick(&mut headless.renderer, &view, &[&surface], WHOLE);
        assert_eq!(ids.len(), 15_000);
        let mut compared = 0;
        for y in (0..SIZE_PX[1]).step_by(2) {
            for x in (0..SIZE_PX[0]).step_by(2) {
                let (origin, direction) = ray(&view, x, y);
                let seen = ids[(y * SIZE_PX[0] + x) as usize];
                match shape.ray(origin, direction) {
                    // This is too close to an edge to decide.
                    Some((_, margin)) if margin < 0.02 => {}
                    Some((triangle, _)) => {
                        compared += 1;
                        assert_eq!(seen, Some(Picked { surface: 0, triangle }), "pixel {x}, {y}");
                    }
                    None => assert!(seen.is_none() || is_beside_a_miss(&shape, &view, x, y)),
                }
            }
        }
        assert!(compared > 500, "{compared} pixels compared");
    }
}

/// Returns true if a ray a hundredth of a pixel away hits the shape: rounding decides such a pixel.
fn is_beside_a_miss(shape: &Shape, view: &View, x: u32, y: u32) -> bool {
    let (origin, direction) = ray(view, x, y);
    [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y]
        .iter()
        .any(|&aside| shape.ray(origin, (direction + 1e-4 * aside).normalize()).is_some())
}

#[test]
fn ids_distinguish_surfaces_and_empty_ones_count() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let upload = |shape: Shape| shape.upload(&headless.renderer);
    let left = upload(Shape::square(-0.6, 0.0, 0.4));
    let empty = upload(Shape::default());
    let right = upload(Shape::square(0.6, 0.0, 0.4));
    let ids = pick(&mut headless.renderer, &view, &[&left, &empty, &right], WHOLE);
    let at = |position: Vec3| {
        let pixel = view.pixel_from_world(position, SIZE_PX).unwrap();
        ids[(pixel.y as u32 * SIZE_PX[0] + pixel.x as u32) as usize]
    };
    assert_eq!(
        at(Vec3::new(-0.4, -0.1, 0.0)),
        Some(Picked {
            surface: 0,
            triangle: 0
        })
    );
    assert_eq!(
        at(Vec3::new(-0.8, 0.1, 0.0)),
        Some(Picked {
            surface: 0,
            triangle: 1
        })
    );
    assert_eq!(
        at(Vec3::new(0.8, -0.1, 0.0)),
        Some(Picked {
            surface: 2,
            triangle: 0
        })
    );
    assert_eq!(at(Vec3::ZERO), None);
}

#[test]
fn part_of_the_picture_says_what_the_whole_says() {
    let Some(mut headless) = renderer() else { return };
    let view = front_view();
    let sphere = Shape::sphere(3).upload(&headless.renderer);
    let whole = pick(&mut headless.renderer, &view, &[&sphere], WHOLE);
    let rect = PixelRect {
        x: 37,
        y: 21,
        width: 70,
        height: 300,
    };
    let part = pick(&mut headless.renderer, &view, &[&sphere], rect);
    assert_eq!(part.len(), 70 * 79, "the rectangle is cut to the picture");
    for (number, id) in part.iter().enumerate() {
        let (x, y) = (37 + number % 70, 21 + number / 70);
        assert_eq!(*id, whole[y * SIZE_PX[0] as usize + x]);
    }
    assert!(pick(&mut headless.renderer, &view, &[&sphere], PixelRect::pixel(999, 0)).is_empty());
}

#[test]
fn polling_returns_the_result_without_blocking() {
    let Some(mut headless) = renderer() else { return };
    let (view, style) = (front_view(), Style::default());
    let sphere = Shape::sphere(3).upload(&headless.renderer);
    let frame = Frame {
        view: &view,
        style: &style,
        surfaces: &[&sphere],
        grid: None,
        overlays: &[],
    };
    let mut target = IdTarget::new();
    let renderer = &mut headless.renderer;
    let rect = PixelRect::pixel(75, 50);
    let waited = renderer
        .pick(&mut target, SIZE_PX, rect, &frame)
        .unwrap()
        .wait(renderer)
        .unwrap();
    let mut request = renderer.pick(&mut target, SIZE_PX, rect, &frame).unwrap();
    // Dropping a request is fine.
    drop(renderer.pick(&mut target, SIZE_PX, rect, &frame).unwrap());
    let polled = (0..1_000_000).find_map(|_| {
        std::thread::yield_now();
        request.poll(renderer)
    });
    assert_eq!(polled, Some(Ok(waited)));
}
