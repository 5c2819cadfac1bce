//! A sequence of shapes in a folder, and edits of it.

use std::fs;

use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Ended, Folder, open, run};
use serde_json::{Value, json};

pub const FRAMES: usize = 9;

pub fn bar() -> Drawn {
    shapes::turned(30, 12, |share| {
        let cap = (share * (1.0 - share) * 40.0).clamp(0.0, 1.0).sqrt();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { 0.3 * cap }, 4.0 * share)
    })
}

/// The bar in a frame that moves each point.
pub fn posed(of: impl Fn(DVec3) -> DVec3) -> Drawn {
    let mut bar = bar();
    bar.positions.iter_mut().for_each(|position| *position = of(*position));
    bar
}

/// The rigid motion of the whole bar in a frame.
pub fn rigid(frame: usize) -> DAffine3 {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.35 * frame as f64);
    DAffine3::from_rotation_translation(turn, DVec3::new(0.3 * frame as f64, -0.1, 0.0))
}

/// A bar that sways and grows thin: no frame is like another.
pub fn swaying(frame: usize) -> Drawn {
    let phase = 0.6 * frame as f64;
    posed(|p| {
        let thin = 1.0 - 0.02 * frame as f64;
        rigid(frame).transform_point3(DVec3::new(thin * p.x + 0.2 * phase.sin() * p.z, p.y, p.z))
    })
}

pub struct Take {
    pub folder: Folder,
}

impl Take {
    /// A folder `in` with these frames.
    pub fn of(frame: impl Fn(usize) -> Drawn) -> Self {
        let folder = Folder::new();
        fs::create_dir(folder.at("in")).unwrap();
        for number in 0..FRAMES {
            folder.write_mesh(&format!("in/walk-{number}.off"), &frame(number));
        }
        Self { folder }
    }

    pub fn edited(&self, edit: &Value, out: &str, more: &[&str]) -> Ended {
        let edit_at = self.folder.write("edit.json", edit.to_string());
        let words = [
            "sequence".into(),
            self.folder.at("in").into_os_string(),
            "--edit".into(),
            edit_at.into(),
        ];
        let rest = ["--output".into(), self.folder.at(out).into_os_string()];
        run(words.into_iter().chain(rest).chain(more.iter().map(Into::into)))
    }

    pub fn bytes(&self, folder: &str, frame: usize) -> Vec<u8> {
        fs::read(self.folder.at(&format!("{folder}/walk-{frame}.off"))).unwrap()
    }

    pub fn shape(&self, folder: &str, frame: usize) -> Vec<DVec3> {
        open(&self.folder.at(&format!("{folder}/walk-{frame}.off")))
            .model
            .rest_positions()
    }
}

pub fn edit(method: &Value, keys: Value) -> Value {
    json!({
        "version": 1,
        "method": method,
        "fixed": { "ranges": [[0, 80]] },
        "handles": [{ "name": "top", "select": { "ranges": [[300, 349]] } }],
        "keys": keys,
    })
}

pub fn bilaplacian() -> Value {
    json!({ "name": "bilaplacian" })
}

pub fn turned(radians: f64, translation: [f64; 3]) -> Value {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 1.0, 0.0).normalize(), radians);
    json!({ "rotation": turn.to_array(), "translation": translation })
}

pub fn key(frame: usize, span: [usize; 2], transform: Value) -> Value {
    json!({ "frame": frame, "span": span, "handles": { "top": transform } })
}
