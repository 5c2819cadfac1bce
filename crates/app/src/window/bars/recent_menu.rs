//! The menu of recent files, each with a small picture.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Button, ColorImage, RichText, TextureHandle, vec2};
use pliant_engine::files::{folder_of, shown};
use pliant_render::Image;

use crate::files::names::file_name;
use crate::window::input::file_command::FileCommand;

/// The size of a picture in the menu, in points.
const SIZE: egui::Vec2 = vec2(64.0, 48.0);

/// The small pictures of recent files, and the file that still needs one.
#[derive(Default)]
pub struct RecentPictures {
    /// The folder that keeps them; without it there are none.
    folder: Option<PathBuf>,
    pictures: BTreeMap<PathBuf, Picture>,
    wanted: Option<PathBuf>,
}

struct Picture {
    image: Image,
    /// The same on the device, once it has been there.
    texture: Option<TextureHandle>,
}

/// The recent files, the newest first, and their pictures.
pub struct Recent<'a> {
    /// The files.
    pub files: &'a [PathBuf],
    /// The pictures.
    pub pictures: &'a RecentPictures,
}

impl RecentPictures {
    /// Pictures that `folder` keeps; none without a folder.
    pub fn in_folder(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            ..Self::default()
        }
    }

    /// The folder that keeps them.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Notes that a picture of this file is to be taken when its shape rests on the screen.
    pub fn want(&mut self, file: &Path) {
        if self.folder.is_some() {
            // As the list of recent files names it.
            self.wanted = Some(std::fs::canonicalize(file).unwrap_or_else(|_| file.to_owned()));
        }
    }

    /// Returns true if a picture is to be taken.
    pub fn is_wanted(&self) -> bool {
        self.wanted.is_some()
    }

    /// The file whose picture is taken now.
    pub fn take_wanted(&mut self) -> Option<PathBuf> {
        self.wanted.take()
    }

    /// Takes pictures that were read or made.
    pub fn take(&mut self, pictures: Vec<(PathBuf, Image)>) {
        let pictures = pictures
            .into_iter()
            .map(|(file, image)| (file, Picture { image, texture: None }));
        self.pictures.extend(pictures);
    }

    /// Brings new pictures to the device.
    pub fn upload(&mut self, context: &egui::Context) {
        for (file, picture) in &mut self.pictures {
            picture.texture.get_or_insert_with(|| {
                let Image { width, height, rgba } = &picture.image;
                let image = ColorImage::from_rgba_unmultiplied([*width, *height].map(|side| side as usize), rgba);
                context.load_texture(shown(file), image, egui::TextureOptions::LINEAR)
            });
        }
    }

    /// Forgets the device's copies: it is lost.
    pub fn forget_textures(&mut self) {
        self.pictures.values_mut().for_each(|picture| picture.texture = None);
    }
}

/// Shows the menu; returns the chosen file's command.
pub fn show(ui: &mut egui::Ui, recent: &Recent<'_>) -> Option<FileCommand> {
    let mut chosen = None;
    ui.add_enabled_ui(!recent.files.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for file in recent.files {
                if row(ui, file, recent.pictures.pictures.get(file)) {
                    chosen = Some(FileCommand::OpenPath(file.clone()));
                    ui.close();
                }
            }
        });
    });
    chosen
}

/// The picture, the name and the folder of a file; true when it is clicked.
fn row(ui: &mut egui::Ui, file: &Path, picture: Option<&Picture>) -> bool {
    let folder = folder_of(file);
    let text = RichText::new(file_name(file));
    let beside = RichText::new(file_name(folder)).weak().small();
    let texture = picture.and_then(|picture| picture.texture.as_ref());
    let button = match texture {
        Some(texture) => {
            let image = egui::Image::from_texture(texture)
                .fit_to_exact_size(SIZE)
                .corner_radius(3.0);
            Button::image_and_text(image, text)
        }
        None => Button::new(text),
    };
    let button = button.right_text(beside).min_size(vec2(220.0, SIZE.y));
    let response = ui.add(button);
    let name = file_name(file);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    response.on_hover_text(shown(file)).clicked()
}
