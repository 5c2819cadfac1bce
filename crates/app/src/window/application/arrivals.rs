//! Results of other threads: files, shapes in buffers, images; and the view's requests for them.

use std::sync::Arc;

use pliant_editor::{Command, Event, JobKind, Shading};
use pliant_mesh::Cancel;

use crate::window::application::Application;
use crate::window::dialogs::question::Question;
use crate::window::panels::notes::{Note, Notes};
use crate::window::session::OpenFile;
use crate::window::threads::message::{ImagesOf, LoadedMaterials, Message, ModelToShow, Posed};
use crate::window::threads::workers::PoseSource;
use crate::window::viewport::shown::Shown;
use pliant_engine::Loaded;
use pliant_picture::drawing::{self, Drawing, Field};

impl Application {
    /// Takes the results of other threads. Returns whether there was anything besides new shapes, which come at every
    /// frame of a drag.
    pub(in crate::window) fn take_messages(&mut self) -> bool {
        let mut is_news = false;
        while let Ok(message) = self.messages.try_recv() {
            let is_shape = match &message {
                Message::Job(done, _) => matches!(done.kind, JobKind::Solve | JobKind::Flow),
                Message::Posed(..) => true,
                _ => false,
            };
            is_news |= !is_shape;
            match message {
                Message::Job(done, posed) => {
                    self.editor.handle(Event::JobDone(done));
                    // A stale result's pose is not shown, because the editor has another shape.
                    if let Some(posed) =
                        posed.filter(|posed| Arc::ptr_eq(&posed.displacements, self.editor.view().drawn))
                    {
                        self.show_pose(posed);
                    }
                }
                Message::Posed(stamp, result) => {
                    self.poses.finish(stamp);
                    match result {
                        Ok(posed) if self.belongs_to_open_file(&posed) => self.show_pose(posed),
                        Ok(_) => {}
                        Err(sentence) => self.fail(sentence),
                    }
                }
                // This one goes to a further view.
                Message::Uploaded(..) => {}
                Message::Redrawn(result) => self.take_drawing(result),
                Message::LoadedMaterials(of, result) => self.set_materials(&of, result),
                Message::Opened(stamp, result) => match self.session.loaded(stamp, result, &self.workers) {
                    Some(Ok(opened)) => self.adopt(*opened),
                    Some(Err(sentence)) => {
                        self.settings.change(|settings| settings.forget_if_gone(&sentence));
                        self.fail(sentence);
                    }
                    None => {}
                },
                Message::Frame(stamp, frame, shape) => {
                    if let Some(shape) = self.session.take_frame(stamp, frame, shape) {
                        self.editor.handle(Event::Frame(frame, shape));
                    }
                }
                Message::MixFrame(stamp, name, frame, shape) => {
                    if let Some(shape) = self.session.take_mix_frame(stamp, frame, shape) {
                        self.editor.handle(Event::MixFrame(name, frame, shape));
                    }
                }
                Message::MixChosen(chosen) => self.take_mix(chosen),
                Message::Followed(stamp, following, frames) => {
                    if let Some(frames) = self.session.take_followed(stamp, frames) {
                        self.editor.handle(Event::Followed(following, frames));
                    }
                }
                Message::Stitched(stamp, result) => self.take_stitched(stamp, result),
                Message::Written(stamp, result) => self.written(stamp, result),
                Message::OriginalFound(path, kept) => {
                    if let Some(Question::WriteOver(asked, found)) = &mut self.dialogs.question
                        && *asked == path
                    {
                        *found = Some(kept);
                    }
                }
                Message::Autosaved(key, result) => {
                    let failed = self
                        .recovery
                        .as_mut()
                        .and_then(|recovery| recovery.written(key, result));
                    if let Some(sentence) = failed {
                        self.fail(sentence);
                    }
                }
                Message::Cage(mesh) => self.take_cage(mesh),
                Message::Example(loaded, shape) => self.take_example(&loaded, shape),
                Message::Folder(folder, contents) => {
                    if let Some(Question::File(_, browser)) = &mut self.dialogs.question {
                        browser.set_contents(&folder, contents);
                    }
                }
                Message::Shown(result) => {
                    if let Err(sentence) = result {
                        self.fail(sentence);
                    }
                }
                Message::RecentPictures(pictures) => self.recent_pictures.take(pictures),
                Message::Chosen(purpose, path) => self.chosen(purpose, path),
                Message::NoDialog(purpose, suggested) => self.browse(purpose, &suggested),
            }
        }
        is_news
    }

    fn belongs_to_open_file(&self, posed: &Posed) -> bool {
        posed.displacements.len() == self.editor.view().displacements.len()
    }

    fn adopt(&mut self, opened: ModelToShow) {
        self.session.adopt(&opened);
        // Requests of the former file do not apply to this one.
        self.waiting.wishes.clear();
        self.waiting.unwritten = None;
        self.redrawing = None;
        let ModelToShow {
            loaded,
            drawing,
            surface,
            displacements,
            beginning,
            notes,
            done,
            recovered,
            unsaved,
            project,
            path,
            sequence,
            ..
        } = opened;
        let is_file = path.is_some() || project.is_some();
        let is_project = project.is_some() || recovered.is_some();
        let place = sequence.as_ref().map(|(sequence, _)| sequence.path().to_owned());
        if let Some(path) = project.or(place).or(path).filter(|_| recovered.is_none()) {
            self.settings.change(|settings| settings.remember(&path));
            self.recent_pictures.want(&path);
        }
        let name = self.session.open.as_ref().map(OpenFile::name).unwrap_or_default();
        self.pose_from(&loaded, &drawing);
        // The sample is about bending: it is in clay, as on its pictures.
        let has_vertex_colours = is_file && drawing.has_vertex_colours();
        self.viewport
            .show(Shown::new(drawing, surface, displacements, &loaded.model));
        self.notes = Notes {
            headline: done.map(Note::Done),
            about_file: notes,
            open_borders: Vec::new(),
        };
        self.editor.handle(Event::Opened {
            model: Arc::clone(&loaded.model),
            name,
            beginning,
        });
        if let Some((sequence, shown)) = sequence {
            self.editor.handle(Event::OpenedSequence {
                count: sequence.count(),
                shown,
                fps: sequence.rate().filter(|_| !is_project),
            });
        }
        self.show_vertex_colours(has_vertex_colours);
        if let Some(needed) = unsaved {
            self.editor.handle(Event::Recovered(needed));
            self.keep_for_recovery();
        }
        if recovered.is_some() {
            self.recovered_from = recovered;
        }
    }

    /// Chooses *Material* for a file with vertex colours, and clay again for the next one without. Vertex colours are a
    /// scan's or a painter's own work, and kept dye is the person's: in clay they look lost.
    fn show_vertex_colours(&mut self, has_them: bool) {
        let present = self.editor.view().look.shading;
        let (instead_of, shading) = match (has_them, self.shows_vertex_colours) {
            (true, false) => (Shading::Clay, Shading::Material),
            (false, true) => (Shading::Material, Shading::Clay),
            _ => return,
        };
        // Another shading is the person's own choice.
        let is_replaced = present == instead_of;
        self.shows_vertex_colours = has_them && is_replaced;
        if is_replaced {
            self.editor.handle(Event::Command(Command::SetShading(shading)));
        }
    }

    fn show_pose(&mut self, posed: Posed) {
        if let Err(error) = self.viewport.pose(posed) {
            self.fail(error.to_string());
        }
    }

    /// The field of the shape that is shown as colours.
    pub(in crate::window) fn wanted_field(&self) -> Option<Field> {
        drawing::field(self.editor.view().look.shading).filter(|field| field.is_of_shape())
    }

    /// Decodes and uploads the images when materials are first shown.
    pub(in crate::window) fn request_images(&mut self) {
        let Some(open) = &self.session.open else { return };
        if self.images.is_some()
            || self.editor.view().look.shading != Shading::Material
            || !open.drawing.materials.has_images()
        {
            return;
        }
        let cancel = Cancel::new();
        self.images = Some(cancel.clone());
        let gpu = self.viewport.gpu();
        let of = ImagesOf {
            drawing: Arc::clone(&open.drawing),
            cancel,
        };
        let failed = of.clone();
        self.workers.spawn(
            "images",
            move || {
                let decoded = match of.drawing.materials.decode(&of.cancel) {
                    Ok(decoded) => decoded,
                    Err(cancelled) => return Message::LoadedMaterials(of, Err(cancelled.to_string())),
                };
                let materials = gpu.upload_images(&decoded).map_err(|error| error.to_string());
                let notes = decoded.notes;
                Message::LoadedMaterials(of, materials.map(|materials| LoadedMaterials { materials, notes }))
            },
            move |sentence| Message::LoadedMaterials(failed.clone(), Err(sentence)),
        );
    }

    /// Stops the decoding of images, for another file or another device.
    pub(in crate::window) fn stop_images(&mut self) {
        if let Some(cancel) = self.images.take() {
            cancel.cancel();
        }
    }

    fn set_materials(&mut self, of: &ImagesOf, result: Result<LoadedMaterials, String>) {
        // Another file is open, or its images are decoded again for another device.
        if of.cancel.is_cancelled() {
            return;
        }
        let result = result.and_then(|LoadedMaterials { materials, notes }| {
            self.notes.about_file.extend(notes);
            self.viewport
                .set_materials(&of.drawing, materials)
                .map_err(|error| error.to_string())
        });
        if let Err(sentence) = result {
            self.viewport.give_up_images(&of.drawing);
            self.fail(format!("the materials are shown without their images: {sentence}"));
        }
    }

    /// Poses are those of this file from here on; what was under way for another is dropped.
    pub(in crate::window) fn pose_from(&mut self, loaded: &Arc<Loaded>, drawing: &Arc<Drawing>) {
        self.workers.set_pose_source(PoseSource {
            loaded: Arc::clone(loaded),
            drawing: Arc::clone(drawing),
            field: self.wanted_field(),
            scales: Arc::default(),
        });
        self.poses.cancel();
        self.stop_images();
    }

    /// Requests the pose of the present shape if it is not the shown one (after undo, or while a handle moves before
    /// its binding is ready).
    pub(in crate::window) fn request_pose(&mut self) {
        let field = self.wanted_field();
        let Some(mut source) = self.workers.pose_source() else {
            return;
        };
        if source.field != field {
            source.field = field;
            self.workers.set_pose_source(source.clone());
        }
        self.poses
            .follow(self.editor.view().drawn, &self.viewport, &source, &self.workers);
    }
}
