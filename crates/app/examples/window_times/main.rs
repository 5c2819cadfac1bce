//! The time that the window's thread is busy, and the time of a drag from the pointer to the GPU's buffers: one JSON
//! object a line.
//!
//! `cargo run --release -p pliant-app --example window_times -- FILE [REACH]`: opens FILE in the whole application
//! without a display, paints a handle on its upper part, drags it for 60 pointer moves, runs the menus' commands, draws
//! lines and changes the mesh. `longest_frame_ms` leaves drawing out, because a software device draws on the processor;
//! `drawn_*` are whole frames, for a real device.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a measurement fails by panicking and prints its table"
)]

mod lines;
mod menus;
mod mesh_changes;
mod session;

use std::time::{Duration, Instant};

use egui::{Key, Modifiers, vec2};
use glam::DVec3;
use pliant_editor::{Command, Reach};

use lines::lines;
use menus::menus;
use mesh_changes::mesh_changes;
use session::{Session, ms};

fn main() {
    let file = std::env::args().nth(1).expect("give a file");
    let mut session = Session::open(&file);
    session.row("opening");

    let (top, vertex_count, size) = {
        let view = session.harness.state().editor().view();
        let model = view.model.expect("the file opened");
        let positions = &model.surface.positions;
        let bounds = model.bounds().expect("it has vertices");
        // The vertex that is nearest to the viewer in the uppermost eighth.
        let is_high = |at: &&DVec3| at.y > bounds.max.y - bounds.extent().y / 8.0;
        let nearness = |at: &DVec3| -view.camera.eye().distance_squared(*at);
        let top = positions
            .iter()
            .filter(is_high)
            .max_by(|a, b| nearness(a).total_cmp(&nearness(b)))
            .expect("the highest vertex is among them");
        (session.place_of(*top), positions.len(), bounds.diagonal())
    };
    session.move_to(top);
    session.step();
    session.press(top, true);
    for step in 1..=8 {
        session.move_to(top + vec2(0.0, 2.0 * step as f32));
        session.step();
    }
    session.press(top + vec2(0.0, 16.0), false);
    session.row("painting a handle");
    let start = Instant::now();
    session.settle();
    let bound_ms = ms(start.elapsed());
    session.row("while it binds");

    // The second argument (a share of the diagonal) sets how much of the surface comes along.
    if let Some(reach) = std::env::args().nth(2).and_then(|share| share.parse::<f64>().ok()) {
        let application = session.harness.state_mut();
        let handle = application
            .editor()
            .document()
            .handles()
            .first()
            .expect("the stroke made a handle")
            .id;
        application.command(Command::SetReach(handle, Reach::Length(reach * size)));
        session.settle();
        session.row("widening the region");
    }
    session.harness.key_press(Key::G);
    session.step();
    let mut latencies = Vec::new();
    for step in 1..=60 {
        let drawn_before = session.harness.state().drawing_time();
        let start = Instant::now();
        session.move_to(top + vec2(1.5 * step as f32, -(step as f32)));
        session.step();
        while !session.shows_handle(size) {
            assert!(
                start.elapsed() < Duration::from_secs(20),
                "the surface does not follow move {step}: {}",
                session.harness.state().editor().view().status
            );
            session.step();
        }
        let drawing = session.harness.state().drawing_time() - drawn_before;
        latencies.push(start.elapsed().saturating_sub(drawing));
    }
    session.row("dragging");
    session.harness.key_press(Key::Enter);
    session.settle();
    let free = session.harness.state().editor().view().counts.free;
    session.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    session.settle();
    session.row("committing and undoing");
    menus(&mut session);
    lines(&mut session);
    mesh_changes(&mut session, &file);
    session.begin_row();
    session.command(Command::CompareMethods);
    session.row("views of all methods");
    latencies.sort();
    println!(
        "{{\"vertices\": {vertex_count}, \"free\": {}, \"region_and_bind_ms\": {bound_ms:.1}, \"pointer_to_buffers_ms\": {:.2}, \"p95_ms\": {:.2}}}",
        free,
        ms(latencies[30]),
        ms(latencies[57])
    );
}
