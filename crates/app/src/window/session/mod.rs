//! The open file, and the jobs that load and save it.

mod clause;
mod following;
mod frames;
mod mixing;
mod open_file;
pub(in crate::window) mod opening;
mod shapes;
mod stitching;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{FollowedFrame, Following, JobQueue, Revision, SaveMark, StitchRequest};

use crate::files::original::Original;
use crate::window::files::in_file::InFile;
use crate::window::files::rest_mesh::RestMesh;
pub use crate::window::files::save_request::KeepOriginal;
use crate::window::files::save_request::{Changed, Content, SaveRequest, Unwritten, Written, WrittenKind};
use crate::window::files::writing::write;
use crate::window::session::following::FrameSearch;
use crate::window::session::frames::FrameReads;
pub use crate::window::session::frames::meant_by;
use crate::window::session::mixing::MixReads;
pub use crate::window::session::open_file::OpenFile;
pub use crate::window::session::opening::Source;
use crate::window::session::opening::{absolute, open};
use crate::window::session::shapes::OtherShapes;
use crate::window::threads::message::{Message, ModelToShow, Refusal};
use crate::window::threads::workers::Workers;
use crate::window::viewport::gpu::Gpu;
use pliant_engine::files::{KnownFiles, is_same};
use pliant_engine::watch::Watch;
use pliant_mesh::Cancel;

/// The open file and the jobs that read and write it.
#[derive(Default)]
pub struct Session {
    /// The open file.
    pub open: Option<OpenFile>,
    next: u64,
    loading: JobQueue<(Source, Gpu)>,
    /// The stage of the running load.
    watch: Watch,
    saving: JobQueue<SaveRequest>,
    /// The stage of the running save, if it has several.
    save_watch: Option<Watch>,
    /// Saves that wait for the running one, in their order: none replaces another.
    to_save: VecDeque<SaveRequest>,
    /// The files that were read and written, as they were then.
    known: KnownFiles,
    /// The number of files opened so far.
    opened: u64,
    /// The open file with other triangles.
    pub others: OtherShapes,
    /// The file that a change of the mesh appends.
    pub to_append: Option<PathBuf>,
    /// The frames of the open sequence.
    frames: FrameReads,
    /// The frames of the other sequence that leads its handles.
    mix: MixReads,
    /// True while a chosen sequence is checked that is to lead them.
    is_checking_mix: bool,
    /// The body of the open sequence.
    following: FrameSearch,
    /// The running change of the mesh.
    stitching: Option<(Revision, Watch)>,
}

impl Session {
    /// Opens a file, off the window's thread. A running load is cancelled.
    pub fn load(&mut self, source: Source, gpu: &Gpu, workers: &Workers) {
        self.loading.cancel();
        let stamp = self.stamp();
        self.loading.request(stamp, (source.absolute(), gpu.clone()));
        self.start_loading(workers);
    }

    /// Changes the open file's triangles, off the window's thread.
    pub fn stitch(&mut self, request: StitchRequest, gpu: &Gpu, workers: &Workers) {
        let Some(open) = &self.open else { return };
        let (loaded, gpu) = (Arc::clone(&open.loaded), gpu.clone());
        let second = self.to_append.clone();
        let (stamp, watch) = (self.stamp(), Watch::default());
        self.stitching = Some((stamp, watch.clone()));
        workers.spawn(
            "stitching",
            move || {
                let made = stitching::stitch(&request, &loaded, second.as_deref(), &gpu, &watch);
                Message::Stitched(stamp, made)
            },
            move |sentence| Message::Stitched(stamp, Err(Refusal { sentence, place: None })),
        );
    }

    /// Notes the end of a change of the mesh. Returns true if it is still wanted.
    pub fn has_stitched(&mut self, stamp: Revision) -> bool {
        let ended = self.stitching.take_if(|(running, _)| *running == stamp);
        ended.is_some()
    }

    fn stop_stitching(&self) {
        if let Some((_, watch)) = &self.stitching {
            watch.cancel.cancel();
        }
    }

    /// A frame of the open sequence, if it is known; if not, it is read, off the window's thread.
    pub fn frame(&mut self, frame: usize, workers: &Workers) -> Option<Arc<Vec<DVec3>>> {
        let sequence = Arc::clone(self.open.as_ref()?.sequence.as_ref()?);
        let read = move |watch: &Watch| sequence.displacements(frame, watch);
        let message = move |stamp, shape| Message::Frame(stamp, frame, shape);
        self.frames.request(frame, read, message, workers)
    }

    /// A frame of the other sequence that leads handles of the open one, by the other one's name, if it is known; if not,
    /// it is read, off the window's thread.
    pub fn mix_frame(&mut self, name: &str, frame: usize, workers: &Workers) -> Option<Arc<Vec<DVec3>>> {
        let sequence = self.open.as_ref()?.sequence.as_ref()?;
        self.mix.request(name, frame, sequence, workers)
    }

    /// Takes a frame of the other sequence that was read. Returns it if it is still wanted.
    pub fn take_mix_frame(
        &mut self,
        stamp: Revision,
        frame: usize,
        shape: Result<Arc<Vec<DVec3>>, String>,
    ) -> Option<Result<Arc<Vec<DVec3>>, String>> {
        self.mix.take(stamp, frame, shape)
    }

    /// Checks off the window's thread that the sequence that a person means by a file can lead handles of the open one.
    pub fn check_mix(&mut self, file: &Path, frame: usize, workers: &Workers) {
        if let Some(sequence) = self.open.as_ref().and_then(|open| open.sequence.as_ref()) {
            self.is_checking_mix = true;
            mixing::check(file, frame, sequence, workers);
        }
    }

    /// Takes a frame that was read. Returns it if it belongs to the open sequence.
    pub fn take_frame(
        &mut self,
        stamp: Revision,
        frame: usize,
        shape: Result<Arc<Vec<DVec3>>, String>,
    ) -> Option<Result<Arc<Vec<DVec3>>, String>> {
        self.frames.take(stamp, frame, shape)
    }

    /// Notes the end of that check.
    pub fn has_checked_mix(&mut self) {
        self.is_checking_mix = false;
    }

    /// Follows the body and some handles of the open sequence through all frames, off the window's thread.
    pub fn follow(&mut self, following: Following, workers: &Workers) {
        if let Some(sequence) = self.open.as_ref().and_then(|open| open.sequence.as_ref()) {
            self.following.request(following, sequence, workers);
        }
    }

    /// Returns true while the body is being followed.
    pub fn is_following(&self) -> bool {
        self.following.doing().is_some()
    }

    /// Takes all frames of a sequence. Returns them if they belong to the open one.
    pub fn take_followed(
        &mut self,
        stamp: Revision,
        frames: Result<Vec<FollowedFrame>, String>,
    ) -> Option<Result<Vec<FollowedFrame>, String>> {
        self.following.take(stamp, frames)
    }

    /// Cancels the running work: a change of the mesh, a load, a search through all frames, or a save before it has
    /// changed anything on the disk.
    pub fn stop(&mut self) {
        self.stop_stitching();
        self.following.stop();
        self.loading.cancel();
        self.saving.cancel();
        self.to_save.clear();
    }

    /// Makes the next save ask again before it replaces the opened file, unless one already did.
    pub fn ask_again(&mut self) {
        if let Some(open) = &mut self.open {
            open.may_write_over = open.in_file.saved().is_some();
        }
    }

    /// Returns true if a save is running.
    pub fn is_saving(&self) -> bool {
        self.saving.is_busy() || !self.to_save.is_empty()
    }

    /// Takes a load's result. `None` if it is no longer wanted.
    pub fn loaded(
        &mut self,
        stamp: Revision,
        result: Result<Box<ModelToShow>, String>,
        workers: &Workers,
    ) -> Option<Result<Box<ModelToShow>, String>> {
        let wanted = self.loading.running().is_some_and(|running| running.stamp == stamp);
        self.loading.finish(stamp);
        self.start_loading(workers);
        wanted.then_some(result)
    }

    /// Makes an opened file the open one.
    pub fn adopt(&mut self, opened: &ModelToShow) {
        self.opened += 1;
        self.others = OtherShapes::default();
        self.stop_stitching();
        self.stitching = None;
        self.frames.forget();
        self.mix.forget();
        self.following.forget();
        for (path, stamp) in opened.loaded.stamps() {
            self.known.note(path, stamp.clone());
        }
        for (path, stamp) in &opened.stamps {
            self.known.note(path, stamp.clone());
        }
        self.open = Some(OpenFile {
            path: opened.path.clone(),
            loaded: Arc::clone(&opened.loaded),
            morph_targets: opened.loaded.scene.morph_targets(),
            drawing: Arc::clone(&opened.drawing),
            mesh: RestMesh::new(Arc::clone(&opened.loaded), opened.source.clone())
                .of_sequence(opened.sequence.as_ref().map(|(sequence, _)| &**sequence)),
            project: opened.project.clone(),
            sequence: opened.sequence.as_ref().map(|(sequence, _)| Arc::clone(sequence)),
            in_file: match &opened.path {
                Some(path) if is_same(path, &opened.loaded.path) => InFile::AsRead,
                _ => InFile::Unknown,
            },
            may_write_over: false,
        });
    }

    /// Writes a file, off the window's thread: the state of the document for `mark`.
    pub fn save(&mut self, path: &Path, content: Content, mark: SaveMark, workers: &Workers) {
        let of_open = |open: &OpenFile| {
            let sources = open.loaded.sources().skip(usize::from(open.path.is_none()));
            sources.map(|(_, path)| path.to_owned()).collect()
        };
        let request = SaveRequest {
            path: absolute(path),
            content,
            sources: self.open.as_ref().map(of_open).unwrap_or_default(),
            known: self.known.clone(),
            changed: Changed::Ask,
            mark,
            opened: self.opened,
        };
        self.save_again(request, workers);
    }

    /// Writes the next waiting save, off the window's thread.
    pub fn save_again(&mut self, request: SaveRequest, workers: &Workers) {
        self.to_save.push_back(request);
        self.start_saving(workers);
    }

    /// Finds out where the original of the file at `path` is or will be kept, off the window's thread.
    pub fn look_for_original(&self, path: &Path, workers: &Workers) {
        let Some(open) = &self.open else { return };
        let (loaded, path) = (Arc::clone(&open.loaded), path.to_owned());
        let unread = path.clone();
        workers.spawn(
            "original",
            move || {
                let cancel = Cancel::new();
                let kept = Original::of(&path, &loaded, &cancel).and_then(|original| original.place(&loaded, &cancel));
                Message::OriginalFound(path, kept.map_err(|error| error.to_string()))
            },
            move |sentence| Message::OriginalFound(unread.clone(), Err(sentence)),
        );
    }

    /// Takes a save's end.
    pub fn written(&mut self, stamp: Revision, result: &Result<Written, Unwritten>, workers: &Workers) {
        self.saving.finish(stamp);
        if let (Some(open), Ok(written)) = (&mut self.open, result)
            && written.opened == self.opened
        {
            match &written.what {
                WrittenKind::Model { of, source, saved } => {
                    open.path = Some(written.path.clone());
                    self.others.were_replaced();
                    // Undo may have led to other triangles while this was written.
                    let (mesh, in_file, may_write_over) = match self.others.of_mut(of) {
                        Some(other) => {
                            open.in_file.was_replaced();
                            open.may_write_over = false;
                            (&mut other.mesh, &mut other.in_file, &mut other.may_write_over)
                        }
                        None => (&mut open.mesh, &mut open.in_file, &mut open.may_write_over),
                    };
                    *in_file = InFile::Saved(saved.clone());
                    *may_write_over = true;
                    if let Some(source) = source {
                        mesh.source = source.clone();
                    }
                }
                WrittenKind::Project => open.project = Some(written.path.clone()),
                WrittenKind::Edit
                | WrittenKind::Morph
                | WrittenKind::Animation
                | WrittenKind::Frames
                | WrittenKind::Picture => {}
            }
        }
        self.start_saving(workers);
    }

    /// Returns true if a save's file belongs to the open one.
    pub fn is_of_open(&self, written: &Written) -> bool {
        written.opened == self.opened
    }

    /// The running work, with its progress (0 to 1).
    pub fn doing(&self) -> Option<(&'static str, f32)> {
        let loading = self
            .loading
            .running()
            .map(|_| self.watch.now().unwrap_or(("opening the file", 0.0)));
        let stitching = self.stitching.as_ref();
        let stitching = stitching.map(|(_, watch)| watch.now().unwrap_or(("changing the mesh", 0.0)));
        let stage = || self.save_watch.as_ref().and_then(Watch::now);
        let saving = self.saving.running();
        let saving = saving.map(|running| stage().unwrap_or(("saving", running.progress.get())));
        let checking = self.is_checking_mix.then_some(("reading the other sequence", 0.0));
        loading.or(stitching).or(saving).or(self.following.doing()).or(checking)
    }

    fn stamp(&mut self) -> Revision {
        self.next += 1;
        Revision(self.next)
    }

    fn start_loading(&mut self, workers: &Workers) {
        let Some((running, (source, gpu))) = self.loading.start_next() else {
            return;
        };
        let stamp = running.stamp;
        let watch = Watch::cancelled_by(&running.cancel);
        self.watch = watch.clone();
        workers.spawn(
            "opening",
            move || Message::Opened(stamp, open(&source, &gpu, &watch).map_err(|error| error.to_string())),
            move |sentence| Message::Opened(stamp, Err(sentence)),
        );
    }

    fn start_saving(&mut self, workers: &Workers) {
        if !self.saving.is_busy()
            && let Some(mut request) = self.to_save.pop_front()
        {
            // The save before it may have moved the mesh as it was read to another file.
            if let (Some(open), Some(mesh)) = (&self.open, request.content.mesh_mut())
                && request.opened == self.opened
                && Arc::ptr_eq(&mesh.loaded, &open.mesh.loaded)
            {
                mesh.source = open.mesh.source.clone();
            }
            let stamp = self.stamp();
            self.saving.request(stamp, request);
        }
        let Some((running, request)) = self.saving.start_next() else {
            return;
        };
        self.save_watch = request.content.watch().cloned();
        let stamp = running.stamp;
        let (progress, cancel) = (running.progress.clone(), running.cancel.clone());
        workers.spawn(
            "saving",
            move || Message::Written(stamp, write(request, &progress, &cancel)),
            move |sentence| Message::Written(stamp, Err(Unwritten::Refused(sentence))),
        );
    }
}
