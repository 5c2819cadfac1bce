//! What a handle on a limb sets free: the regions of brush strokes and spines on limbs of scans, drawn by the editor's own
//! gestures. `limbs [--symmetry] [FOLDER [LIMB ..]]`: all limbs, or those whose names contain one of the words; pictures of
//! the regions go to the folder.
//!
//! A row for each limb: the handle's share of the surface, the free area in areas of the handle, and the free share of a
//! part of the body that no artist would want to move with that limb. With symmetry, also the twin's area in areas of the
//! handle, the length of its rim in lengths of the handle's rim, which is 1 for a mirror image and more for a ragged one,
//! and the number of its pieces.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that reports")]

use std::collections::BTreeSet;
use std::path::Path;

use glam::{DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{
    Button, Command, Editor, Event, Handle, InlineExecutor, Modifiers, NamedView, Paint, Pointer, StrokeShape,
    Symmetry, ToolMode,
};
use pliant_mesh::{Bounds, Model, SurfaceVertex, bounding_box, face_area};
use pliant_tests::{assets, datum, open, run};

const VIEWPORT_PX: DVec2 = DVec2::new(1000.0, 1000.0);

/// A stroke over the view. Places are shares of the model's box in the view, from its lower left corner.
enum Stroke {
    /// One touch of the round brush: its place and radius, in shares of the box's height.
    Brush([f64; 2], f64),
    /// A spine, from the body to the tip.
    Spine(&'static [[f64; 2]]),
}

struct Limb {
    name: &'static str,
    file: &'static str,
    view: NamedView,
    stroke: Stroke,
    /// The part that should stay: from left to right, and from below upwards.
    apart: [[f64; 2]; 2],
}

const LEFT: [[f64; 2]; 2] = [[0.0, 0.48], [0.0, 1.0]];
const RIGHT: [[f64; 2]; 2] = [[0.52, 1.0], [0.0, 1.0]];

#[rustfmt::skip]
const LIMBS: &[Limb] = &[
    spine("armadillo, right arm", "armadillo.obj", NamedView::Front, &[[0.31, 0.75], [0.214, 0.74], [0.12, 0.71], [0.06, 0.76], [0.06, 0.85]], [[0.4, 0.6], [0.6, 1.0]]),
    spine("armadillo, left arm", "armadillo.obj", NamedView::Front, &[[0.69, 0.75], [0.79, 0.74], [0.87, 0.72], [0.92, 0.78], [0.93, 0.86]], [[0.4, 0.6], [0.6, 1.0]]),
    spine("armadillo, right leg", "armadillo.obj", NamedView::Front, &[[0.38, 0.42], [0.30, 0.27], [0.29, 0.06]], RIGHT),
    spine("armadillo, left leg", "armadillo.obj", NamedView::Front, &[[0.62, 0.42], [0.72, 0.27], [0.76, 0.06]], LEFT),
    spine("armadillo, tail", "armadillo.obj", NamedView::Left, &[[0.27, 0.425], [0.15, 0.36], [0.02, 0.29]], [[0.4, 1.0], [0.0, 1.0]]),
    spine("Homer, right arm", "homer.obj", NamedView::Front, &[[0.26, 0.60], [0.08, 0.56]], [[0.4, 1.0], [0.0, 1.0]]),
    spine("Homer, right leg", "homer.obj", NamedView::Front, &[[0.386, 0.32], [0.37, 0.05]], RIGHT),
    spine("human, right arm", "human_neutral.obj", NamedView::Front, &[[0.333, 0.79], [0.06, 0.77]], [[0.43, 0.57], [0.0, 1.0]]),
    spine("human, right leg", "human_neutral.obj", NamedView::Front, &[[0.443, 0.45], [0.43, 0.05]], RIGHT),
    spine("beast, right arm", "beast.obj", NamedView::Front, &[[0.325, 0.76], [0.05, 0.62]], [[0.43, 0.57], [0.0, 1.0]]),
    spine("beast, right leg", "beast.obj", NamedView::Front, &[[0.425, 0.44], [0.325, 0.28], [0.31, 0.06]], RIGHT),
    spine("horse, neck", "horse.ply", NamedView::Left, &[[0.25, 0.71], [0.13, 0.92]], [[0.0, 1.0], [0.0, 0.45]]),
    spine("horse, foreleg", "horse.ply", NamedView::Left, &[[0.31, 0.42], [0.29, 0.05]], [[0.5, 1.0], [0.0, 1.0]]),
    spine("creature, tail", "creature.glb", NamedView::Left, &[[0.35, 0.31], [0.05, 0.24]], [[0.5, 1.0], [0.0, 1.0]]),
    spine("knight, right leg", "decimated-knight.off", NamedView::Front, &[[0.375, 0.325], [0.375, 0.05]], RIGHT),
    spine("knight, right arm", "decimated-knight.off", NamedView::Front, &[[0.19, 0.675], [0.125, 0.35]], [[0.4, 0.6], [0.0, 1.0]]),
    spine("Spot, hind leg", "spot.obj", NamedView::Front, &[[0.27, 0.29], [0.27, 0.04]], RIGHT),
    brush("armadillo, right thigh", "armadillo.obj", NamedView::Front, [0.32, 0.34], 0.07, RIGHT),
    brush("armadillo, left thigh", "armadillo.obj", NamedView::Front, [0.69, 0.34], 0.07, LEFT),
    brush("armadillo, right arm", "armadillo.obj", NamedView::Front, [0.19, 0.73], 0.05, [[0.4, 0.6], [0.6, 1.0]]),
    brush("armadillo, left arm", "armadillo.obj", NamedView::Front, [0.81, 0.73], 0.05, [[0.4, 0.6], [0.6, 1.0]]),
    brush("armadillo, tail", "armadillo.obj", NamedView::Left, [0.1, 0.32], 0.03, [[0.4, 1.0], [0.0, 1.0]]),
    brush("Homer, right thigh", "homer.obj", NamedView::Front, [0.38, 0.25], 0.08, RIGHT),
    brush("Homer, left thigh", "homer.obj", NamedView::Front, [0.62, 0.25], 0.08, LEFT),
    brush("Homer, right arm", "homer.obj", NamedView::Front, [0.18, 0.58], 0.05, [[0.4, 1.0], [0.0, 1.0]]),
    brush("human, right thigh", "human_neutral.obj", NamedView::Front, [0.44, 0.36], 0.06, RIGHT),
    brush("human, left thigh", "human_neutral.obj", NamedView::Front, [0.56, 0.36], 0.06, LEFT),
    brush("human, right arm", "human_neutral.obj", NamedView::Front, [0.25, 0.79], 0.04, [[0.43, 0.57], [0.0, 1.0]]),
    brush("beast, right thigh", "beast.obj", NamedView::Front, [0.38, 0.36], 0.07, RIGHT),
    brush("beast, left thigh", "beast.obj", NamedView::Front, [0.62, 0.36], 0.07, LEFT),
    brush("beast, right arm", "beast.obj", NamedView::Front, [0.24, 0.74], 0.05, [[0.43, 0.57], [0.0, 1.0]]),
    brush("horse, foreleg", "horse.ply", NamedView::Left, [0.31, 0.38], 0.05, [[0.5, 1.0], [0.0, 1.0]]),
    brush("horse, hind leg", "horse.ply", NamedView::Left, [0.9, 0.4], 0.06, [[0.0, 0.6], [0.0, 1.0]]),
    brush("horse, neck", "horse.ply", NamedView::Left, [0.2, 0.8], 0.1, [[0.0, 1.0], [0.0, 0.45]]),
    brush("creature, tail", "creature.glb", NamedView::Left, [0.2, 0.27], 0.06, [[0.5, 1.0], [0.0, 1.0]]),
    brush("creature, hind leg", "creature.glb", NamedView::Left, [0.54, 0.12], 0.08, [[0.62, 1.0], [0.0, 1.0]]),
    brush("creature, foreleg", "creature.glb", NamedView::Left, [0.7, 0.12], 0.08, [[0.0, 0.62], [0.0, 1.0]]),
    brush("knight, right thigh", "decimated-knight.off", NamedView::Front, [0.375, 0.3], 0.06, RIGHT),
    brush("knight, left thigh", "decimated-knight.off", NamedView::Front, [0.625, 0.3], 0.06, LEFT),
    brush("Spot, right leg", "spot.obj", NamedView::Front, [0.27, 0.15], 0.11, RIGHT),
    brush("Spot, left leg", "spot.obj", NamedView::Front, [0.73, 0.15], 0.11, LEFT),
    brush("Spot, foreleg", "spot.obj", NamedView::Left, [0.41, 0.15], 0.1, [[0.62, 1.0], [0.0, 1.0]]),
    brush("Spot, hind leg", "spot.obj", NamedView::Left, [0.84, 0.15], 0.1, [[0.0, 0.62], [0.0, 1.0]]),
    brush("Spot, ear", "spot.obj", NamedView::Front, [0.08, 0.84], 0.05, RIGHT),
    brush("Nefertiti, brow", "nefertiti-lowres.obj", NamedView::Front, [0.653, 0.578], 0.025, [[0.0, 1.0], [0.0, 0.45]]),
    brush("Nefertiti, nose", "nefertiti-lowres.obj", NamedView::Front, [0.51, 0.494], 0.03, [[0.0, 1.0], [0.62, 1.0]]),
    brush("Demosthenes, nose", "demosthenes-low-res.obj", NamedView::Front, [0.53, 0.589], 0.035, [[0.0, 1.0], [0.0, 0.5]]),
    brush("Suzanne, ear", "suzanne.obj", NamedView::Front, [0.083, 0.59], 0.1, [[0.3, 1.0], [0.0, 1.0]]),
    brush("bunny, ear", "stanford-bunny.obj", NamedView::Front, [0.3, 0.85], 0.06, [[0.0, 1.0], [0.0, 0.5]]),
];

const fn spine(
    name: &'static str,
    file: &'static str,
    view: NamedView,
    way: &'static [[f64; 2]],
    apart: [[f64; 2]; 2],
) -> Limb {
    Limb {
        name,
        file,
        view,
        stroke: Stroke::Spine(way),
        apart,
    }
}

const fn brush(
    name: &'static str,
    file: &'static str,
    view: NamedView,
    at: [f64; 2],
    radius: f64,
    apart: [[f64; 2]; 2],
) -> Limb {
    Limb {
        name,
        file,
        view,
        stroke: Stroke::Brush(at, radius),
        apart,
    }
}

fn main() {
    let mut words = std::env::args().skip(1).peekable();
    let is_symmetric = words.next_if_eq("--symmetry").is_some();
    let folder = words.next();
    let words: Vec<String> = words.collect();
    let twin = if is_symmetric { "     twin    rim  pieces" } else { "" };
    println!("{:<32}{:>10}{:>12}{:>12}{twin}", "limb", "handle", "free area", "apart");
    let mut sums = [0.0; 2];
    for limb in LIMBS {
        let kind = match limb.stroke {
            Stroke::Brush(..) => "",
            Stroke::Spine(_) => ", spine",
        };
        let name = format!("{}{kind}", limb.name);
        if !words.is_empty() && !words.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let file = match limb.file {
            "creature.glb" => Some(assets().join("creature.glb")),
            scan => datum(&format!("scans/{scan}")),
        };
        let Some(file) = file else { continue };
        let model = open(&file).model;
        let mut limb_editor = Drawn::open(&model, limb.view);
        if is_symmetric {
            limb_editor.paint_both_sides();
        }
        limb_editor.stroke(&limb.stroke);
        let [handle, free, apart] = limb_editor.shares(&model, limb.apart);
        let twin = match limb_editor.twin(&model) {
            Some((area, rim, pieces)) => format!("{area:>9.2}{rim:>7.2}{pieces:>8}"),
            None => String::new(),
        };
        println!(
            "{name:<32}{:>9.1}%{:>12.2}{:>11.1}%{twin}",
            100.0 * handle,
            free / handle,
            100.0 * apart
        );
        sums[0] += free / handle;
        sums[1] += 100.0 * apart;
        if let Some(folder) = &folder {
            limb_editor.picture(
                &file,
                &Path::new(folder).join(format!("{}.png", name.replace([',', ' '], "-"))),
            );
        }
    }
    println!("{:<32}{:>10}{:>12.2}{:>11.1}%", "sum", "", sums[0], sums[1]);
}

/// An editor with a model in one view.
struct Drawn {
    editor: Editor,
    jobs: InlineExecutor,
    view: NamedView,
    /// The model's box in the view's axes.
    bounds: Bounds,
}

impl Drawn {
    fn open(model: &std::sync::Arc<Model>, view: NamedView) -> Self {
        let jobs = InlineExecutor::new();
        let mut editor = Editor::new(Box::new(jobs.clone()));
        editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
        editor.handle(Event::Opened {
            model: std::sync::Arc::clone(model),
            name: String::new(),
            beginning: None,
        });
        editor.handle(Event::Command(Command::View(view)));
        editor.handle(Event::Command(Command::ToggleProjection));
        let mut own = Self {
            editor,
            jobs,
            view,
            bounds: Bounds {
                min: DVec3::ZERO,
                max: DVec3::ZERO,
            },
        };
        own.drain();
        let seen_from = own.editor.view().camera.axes().transpose();
        let seen: Vec<DVec3> = model.surface.positions.iter().map(|p| seen_from * *p).collect();
        own.bounds = bounding_box(&seen).unwrap();
        own
    }

    fn drain(&mut self) {
        while let Some(done) = self.jobs.run_next() {
            self.editor.handle(Event::JobDone(done));
        }
    }

    /// The place on the screen of shares of the box.
    fn px(&self, [u, v]: [f64; 2]) -> DVec2 {
        let at = self.bounds.min + self.bounds.extent() * DVec3::new(u, v, 0.5);
        let camera = self.editor.view().camera;
        camera.project(camera.axes() * at, VIEWPORT_PX).unwrap()
    }

    fn stroke(&mut self, stroke: &Stroke) {
        self.editor
            .handle(Event::Command(Command::SetTool(ToolMode::PaintHandle)));
        let way = match stroke {
            Stroke::Brush(at, radius) => {
                let radius_px = radius * (self.px([0.0, 0.0]).y - self.px([0.0, 1.0]).y).abs();
                self.editor.handle(Event::Command(Command::SetBrushRadius(radius_px)));
                vec![self.px(*at)]
            }
            Stroke::Spine(way) => {
                self.editor
                    .handle(Event::Command(Command::SetStrokeShape(StrokeShape::Spine)));
                let steps = way.windows(2).flat_map(|ends| {
                    (0..=10).map(|step| {
                        [0, 1].map(|axis| ends[0][axis] + (ends[1][axis] - ends[0][axis]) * f64::from(step) / 10.0)
                    })
                });
                steps.map(|at| self.px(at)).collect()
            }
        };
        let at = |position_px: DVec2| Pointer {
            position_px,
            modifiers: Modifiers::NONE,
        };
        self.editor.handle(Event::PointerMoved(at(way[0])));
        self.editor.handle(Event::PointerPressed(at(way[0]), Button::Primary));
        for place in &way {
            self.editor.handle(Event::PointerMoved(at(*place)));
        }
        self.editor
            .handle(Event::PointerReleased(at(way[way.len() - 1]), Button::Primary));
        self.drain();
    }

    fn paint_both_sides(&mut self) {
        self.editor
            .handle(Event::Command(Command::SetSymmetry(Symmetry::Found)));
        self.drain();
        if let Some(problem) = self.editor.view().problem {
            println!("{problem}");
        }
    }

    /// The twin's area and length of its rim, in those of the handle, and the number of its pieces.
    fn twin(&self, model: &Model) -> Option<(f64, f64, usize)> {
        let [first, second] = self.editor.document().handles() else {
            return None;
        };
        let paint = self.editor.document().paint();
        let is_of = |v: SurfaceVertex, handle: &Handle| paint[v.index()] == Paint::Handle(handle.id);
        let extent = |handle: &Handle| {
            let (mut area, mut rim) = (0.0, 0.0);
            for triangle in &model.surface.triangles {
                let corners = triangle.map(|v| model.surface.positions[v.index()]);
                let own = triangle.iter().filter(|v| is_of(**v, handle)).count();
                area += face_area(corners) * own as f64 / 3.0;
                let edges = [0, 1, 2].map(|corner| corners[corner].distance(corners[(corner + 1) % 3]));
                rim += if own == 1 || own == 2 { edges.iter().sum() } else { 0.0 };
            }
            [area, rim]
        };
        let ([area, rim], [twin_area, twin_rim]) = (extent(first), extent(second));
        let mut rest: BTreeSet<SurfaceVertex> = (0..paint.len() as u32)
            .map(SurfaceVertex)
            .filter(|v| is_of(*v, second))
            .collect();
        let mut pieces = 0;
        while let Some(start) = rest.pop_first() {
            pieces += 1;
            let mut front = vec![start];
            while let Some(v) = front.pop() {
                front.extend(model.topology.neighbours(v).iter().filter(|other| rest.remove(other)));
            }
        }
        Some((twin_area / area, twin_rim / rim, pieces))
    }

    /// The shares of the surface of handle and free part, and the free share of a part of the box.
    fn shares(&self, model: &Model, apart: [[f64; 2]; 2]) -> [f64; 3] {
        let roles = self.editor.roles();
        let seen_from = self.editor.view().camera.axes().transpose();
        let (mut whole, mut handle, mut free, mut part, mut part_free) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for triangle in &model.surface.triangles {
            let corners = triangle.map(|v| model.surface.positions[v.index()]);
            let area = face_area(corners) / 3.0;
            for (corner, v) in corners.iter().zip(triangle) {
                let share = (seen_from * *corner - self.bounds.min) / self.bounds.extent();
                let [across, upwards] = apart;
                let is_part =
                    (across[0]..=across[1]).contains(&share.x) && (upwards[0]..=upwards[1]).contains(&share.y);
                let role = roles[v.index()];
                whole += area;
                handle += if matches!(role, Role::Handle(_)) { area } else { 0.0 };
                free += if role == Role::Free { area } else { 0.0 };
                part += if is_part { area } else { 0.0 };
                part_free += if is_part && role != Role::Fixed { area } else { 0.0 };
            }
        }
        [handle / whole, free / whole, part_free / part]
    }

    fn picture(&self, file: &Path, output: &Path) {
        let edit = output.with_extension("json");
        std::fs::write(&edit, self.editor.edit_file().unwrap().to_json()).unwrap();
        let side = match self.view {
            NamedView::Left => "left",
            _ => "front",
        };
        let words = [
            "render",
            "--shading",
            "regions",
            "--projection",
            "orthographic",
            "--size",
            "500x500",
            "--view",
            side,
        ];
        let words = words.map(std::ffi::OsString::from).into_iter();
        let files = [
            file.into(),
            "--edit".into(),
            edit.into(),
            "--output".into(),
            output.into(),
        ];
        run(words.chain(files)).done();
    }
}
