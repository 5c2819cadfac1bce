//! The whole program without a window, with verbs: open, paint, drag, undo, redo.
#![allow(dead_code, reason = "each test file uses the verbs it needs")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

pub mod new_mesh;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use pliant_deform::{Bound, Constraints, Loose, Method, Problem, Role};
use pliant_editor::{
    Access, Button, Command, Document, Editor, Event, Executor, GizmoPart, Handle, InlineExecutor, JobKind, Key,
    Modifiers, Paint, Pointer, Tips, ToolMode,
};
use pliant_mesh::{Cancel, Drawn, Model, Object, Progress, WeldOptions};

pub const VIEWPORT_PX: DVec2 = DVec2::new(800.0, 600.0);
pub const CENTRE_PX: DVec2 = DVec2::new(400.0, 300.0);

/// The largest distance between the ends of two descents to one minimum, in diagonals.
pub const ITERATED: f64 = 1e-3;

/// An editor and the list of its jobs.
pub struct Rig {
    pub editor: Editor,
    pub jobs: InlineExecutor,
    pub model: Arc<Model>,
    colours: Colours,
}

/// The colours of regions in a window, which fetches changes.
#[derive(Default)]
struct Colours {
    colours: Vec<[u8; 4]>,
    revision: u64,
}

impl Colours {
    /// Fetches the changes, which must be complete.
    fn follow(&mut self, editor: &Editor) {
        let known = std::mem::replace(&mut self.revision, editor.view().regions_revision);
        let mut all = Vec::new();
        editor.region_colours(&mut all);
        match editor.recoloured_since(known) {
            Some(vertices) if self.colours.len() == all.len() => {
                let colour = editor.region_colour();
                vertices.iter().for_each(|&v| self.colours[v.index()] = colour(v));
            }
            _ => self.colours.clone_from(&all),
        }
        assert!(self.colours == all, "a vertex changed its colour unsaid");
    }
}

/// The document's state that undo must restore, to the bit.
#[derive(Clone, PartialEq, Debug)]
pub struct Fingerprint {
    paint: Vec<Paint>,
    handles: Vec<Handle>,
    stiffness: Option<Vec<f64>>,
    method: Method,
    rest: Vec<[u64; 3]>,
    from_rest: Vec<[u64; 3]>,
    from_file: Vec<[u64; 3]>,
    access: Access,
    inside_out: BTreeSet<u32>,
    tips: Tips,
    loose: (Loose, BTreeMap<u32, Loose>),
    settled: bool,
    applied: bool,
}

impl Fingerprint {
    pub fn of(document: &Document) -> Self {
        let bits = |vectors: &[DVec3]| vectors.iter().map(|v| v.to_array().map(f64::to_bits)).collect();
        Self {
            paint: document.paint().to_vec(),
            handles: document.handles().to_vec(),
            stiffness: document.stiffness().map(<[f64]>::to_vec),
            method: document.method().clone(),
            rest: bits(document.rest()),
            from_rest: bits(document.from_rest()),
            from_file: bits(document.from_file()),
            inside_out: (**document.inside_out()).clone(),
            access: document.access().clone(),
            tips: document.tips(),
            loose: (document.loose(), document.loose_parts().clone()),
            settled: document.is_settled(),
            applied: document.is_applied(),
        }
    }
}

pub fn weld(drawn: Drawn) -> Arc<Model> {
    Arc::new(Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap())
}

impl Rig {
    /// A program with this mesh open and every job done.
    pub fn open(drawn: Drawn) -> Self {
        let mut rig = Self::open_with_jobs_waiting(drawn);
        rig.drain();
        rig
    }

    /// A program with this mesh open, which has separate objects, and every job done.
    pub fn open_with_objects(drawn: Drawn, objects: Vec<Object>) -> Self {
        let model = Arc::unwrap_or_clone(weld(drawn)).with_objects(objects);
        let mut rig = Self::open_model(Arc::new(model));
        rig.drain();
        rig
    }

    /// A program with this mesh open whose jobs have not run.
    pub fn open_with_jobs_waiting(drawn: Drawn) -> Self {
        Self::open_model(weld(drawn))
    }

    /// A program with this mesh open, which it takes for a very large one, and every job done.
    pub fn open_as_large(drawn: Drawn) -> Self {
        let mut rig = Self::open_by(InlineExecutor::with_large_mesh(0), weld(drawn));
        rig.drain();
        rig
    }

    fn open_model(model: Arc<Model>) -> Self {
        Self::open_by(InlineExecutor::new(), model)
    }

    fn open_by(jobs: InlineExecutor, model: Arc<Model>) -> Self {
        Self::open_on(Box::new(jobs.clone()), jobs, model)
    }

    /// A program with this mesh, whose executor leaves its jobs in this list.
    pub fn open_on(executor: Box<dyn Executor>, jobs: InlineExecutor, model: Arc<Model>) -> Self {
        let mut editor = Editor::new(executor);
        editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
        editor.handle(Event::Opened {
            model: Arc::clone(&model),
            name: "a shape".to_owned(),
            beginning: None,
        });
        Self::of(editor, jobs, model)
    }

    pub fn of(editor: Editor, jobs: InlineExecutor, model: Arc<Model>) -> Self {
        Self {
            editor,
            jobs,
            model,
            colours: Colours::default(),
        }
    }

    pub fn send(&mut self, event: Event) {
        self.editor.handle(event);
        self.colours.follow(&self.editor);
    }

    /// Chooses a method by its name, as a step of the history if it differs.
    pub fn choose(&mut self, method: &str) {
        self.command(Command::SetMethod(Method::from_name(method).unwrap()));
        self.drain();
    }

    /// Runs jobs until none waits.
    pub fn drain(&mut self) {
        for _ in 0..10_000 {
            let Some(done) = self.jobs.run_next() else { return };
            self.send(Event::JobDone(done));
        }
        panic!("the jobs never end: {:?} wait", self.jobs.waiting());
    }

    /// Runs the next job of this kind; false if none waits.
    pub fn run(&mut self, kind: JobKind) -> bool {
        let done = self.jobs.run(kind);
        let ran = done.is_some();
        if let Some(done) = done {
            self.send(Event::JobDone(done));
        }
        ran
    }

    pub fn command(&mut self, command: Command) {
        self.send(Event::Command(command));
    }

    pub fn key(&mut self, key: Key) {
        self.send(Event::Key(key, Modifiers::NONE));
    }

    pub fn type_keys(&mut self, keys: &str) {
        for character in keys.chars() {
            self.key(Key::Character(character));
        }
    }

    pub fn press(&mut self, position_px: DVec2) {
        self.send(Event::PointerMoved(at(position_px)));
        self.send(Event::PointerPressed(at(position_px), Button::Primary));
    }

    pub fn move_to(&mut self, position_px: DVec2) {
        self.send(Event::PointerMoved(at(position_px)));
    }

    pub fn release(&mut self, position_px: DVec2) {
        self.send(Event::PointerReleased(at(position_px), Button::Primary));
    }

    /// Holds the left button along a path over the screen.
    pub fn swipe(&mut self, way_px: &[DVec2]) {
        self.press(way_px[0]);
        for &position_px in &way_px[1..] {
            self.move_to(position_px);
        }
        self.release(way_px[way_px.len() - 1]);
    }

    /// Paints along a path.
    pub fn paint(&mut self, mode: ToolMode, way_px: &[DVec2]) {
        self.command(Command::SetTool(mode));
        self.swipe(way_px);
    }

    /// Paints a handle around the middle of the view.
    pub fn paint_handle(&mut self) {
        self.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    }

    /// Moves the selected handle along an axis by a typed number.
    pub fn move_by(&mut self, axis: char, length: &str) {
        self.type_keys("g");
        self.type_keys(&format!("{axis}{length}"));
        self.key(Key::Enter);
    }

    /// Drags a part of the gizmo by a number of points; false if it is not visible.
    pub fn drag(&mut self, part: GizmoPart, by_px: DVec2) -> bool {
        let Some(from_px) = self.grip(part) else { return false };
        self.swipe(&[from_px, from_px + by_px * 0.5, from_px + by_px]);
        true
    }

    /// A point of the screen at which this part of the gizmo is grabbed; the pointer rests there.
    pub fn grip(&mut self, part: GizmoPart) -> Option<DVec2> {
        let position_px = self.place_of(part)?;
        self.move_to(position_px);
        self.send(Event::PointerRested);
        Some(position_px)
    }

    /// A point of the screen on this part of the gizmo.
    pub fn place_of(&self, part: GizmoPart) -> Option<DVec2> {
        let view = self.editor.view();
        let shape = view.gizmo.iter().find(|shape| shape.part == part)?;
        let lines = shape.lines.iter().map(|[a, b]| (*a + *b) * 0.5);
        let triangles = shape.triangles.iter().map(|[a, b, c]| (*a + *b + *c) / 3.0);
        lines
            .chain(triangles)
            .filter_map(|point| view.camera.project(point, VIEWPORT_PX))
            .find(|&position_px| {
                pliant_editor::hit_gizmo(view.gizmo, position_px, view.camera, VIEWPORT_PX) == Some(part)
            })
    }

    pub fn undo(&mut self) {
        self.command(Command::Undo);
    }

    pub fn redo(&mut self) {
        self.command(Command::Redo);
    }

    /// The drawn shape, to the bit.
    pub fn drawn(&self) -> Vec<[u64; 3]> {
        let mut positions = Vec::new();
        self.model
            .drawn_positions(self.editor.view().displacements, &mut positions);
        positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
    }

    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint::of(self.editor.document())
    }

    /// Whether the settled shape is the solution for regions, handles and options, solved outside the program: for a
    /// linear method to the bit; for a minimum reached step by step from another start within [`ITERATED`].
    #[track_caller]
    pub fn assert_as_meant(&self, case: &str) {
        let document = self.editor.document();
        let from_rest = document.from_rest();
        let kept = document.kept();
        let Some((bound, meant)) = self.solved_apart(|handle| handle.affine()) else {
            assert!(kept.is_some() || from_rest.iter().all(|d| *d == DVec3::ZERO), "{case}");
            return;
        };
        let at_first = kept.and_then(|kept| Some(self.solved_apart(|handle| kept.targets[&handle.id])?.1));
        if bound.handle_bases().is_some() {
            let meant = match (kept, &at_first) {
                (Some(kept), Some(at_first)) => kept.carried(at_first, &meant),
                _ => meant,
            };
            assert!(meant == from_rest, "{case}: not the very shape");
            return;
        }
        let size = self.model.bounds().unwrap().diagonal();
        let farthest = |a: &[DVec3], b: &[DVec3]| {
            let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
            apart.fold(0.0, f64::max) / size
        };
        // The residual of a kept shape never grows.
        let residual = match (kept, &at_first) {
            (Some(kept), Some(at_first)) => farthest(&kept.shape, at_first),
            _ => 0.0,
        };
        let worst = farthest(&meant, from_rest);
        assert!(
            worst < residual + ITERATED,
            "{case}: {worst:e} of the size from the minimum, with a residual of {residual:e}"
        );
    }

    /// The document's problem, bound and solved to the end; `None` without a handle.
    fn solved_apart(&self, target: impl Fn(&Handle) -> DAffine3) -> Option<(Bound, Vec<DVec3>)> {
        let document = self.editor.document();
        let mut surface = self.model.surface.clone();
        let mut displacements = vec![DVec3::ZERO; surface.positions.len()];
        // A handle with only locked vertices does not count.
        let roles = self.editor.roles();
        let is_held = |handle: &&Handle| {
            let mut painted = document.paint().iter().zip(roles);
            painted.any(|(paint, role)| *paint == Paint::Handle(handle.id) && *role != Role::Fixed)
        };
        let handles: Vec<&Handle> = document.handles().iter().filter(is_held).collect();
        if handles.is_empty() {
            return None;
        }
        for (position, rest) in surface.positions.iter_mut().zip(document.rest()) {
            *position += *rest;
        }
        let ones = vec![1.0; surface.positions.len()];
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let method = document.method();
        let ordering = method.ordering(&self.model.topology, &progress, &cancel).unwrap();
        let soft: Vec<Option<f64>> = handles.iter().map(|handle| handle.soft).collect();
        let parts: Vec<(u32, Loose)> = document
            .loose_parts()
            .iter()
            .map(|(part, loose)| (*part, *loose))
            .collect();
        let problem = Problem {
            surface: &surface,
            topology: &self.model.topology,
            roles,
            handle_count: handles.len(),
            stiffness: document.stiffness().unwrap_or(&ones),
            constraints: Constraints {
                soft: &soft,
                continuity: &document.joints().unwrap_or_default(),
                parts: &parts,
                sections: &[],
            },
            loose: document.loose(),
            method,
            attachments: &[],
            revision: 0,
        };
        let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel).unwrap();
        let targets: Vec<DAffine3> = handles.iter().map(|handle| target(handle)).collect();
        bound.set_targets(&targets).unwrap();
        while !bound.step(&mut displacements).unwrap().finished {}
        Some((bound, displacements))
    }

    pub fn count(&self, paint: Paint) -> usize {
        self.editor.document().paint().iter().filter(|p| **p == paint).count()
    }

    /// The largest distance of a vertex from its place in the file.
    pub fn largest_displacement(&self) -> f64 {
        self.editor
            .document()
            .from_file()
            .iter()
            .map(|d| d.length())
            .fold(0.0, f64::max)
    }
}

pub fn at(position_px: DVec2) -> Pointer {
    Pointer {
        position_px,
        modifiers: Modifiers::NONE,
    }
}

/// A small generator of numbers with a fixed seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// A number between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point near the middle of the view.
    pub fn position_px(&mut self) -> DVec2 {
        CENTRE_PX + DVec2::new(self.unit() - 0.5, self.unit() - 0.5) * 420.0
    }
}
