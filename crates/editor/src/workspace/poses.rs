//! Actions on kept poses.

use super::handles::held_because;
use super::state::Workspace;
use crate::document::{Document, HandleId};

/// Keeps the shown state as a pose.
pub(crate) fn keep_pose(workspace: &mut Workspace) {
    workspace.change("Keep pose", |document| {
        let pose = document.present_pose(free_name(document));
        document.change_poses(|poses| poses.push(pose));
    });
}

/// Moves everything to a pose; locked handles and pins stay.
pub(crate) fn take_pose(workspace: &mut Workspace, place: usize) {
    let Some(pose) = workspace.document.poses().get(place).cloned() else {
        return;
    };
    let held: Vec<HandleId> = pose
        .handles
        .keys()
        .copied()
        .filter(|&id| held_because(workspace, id).is_some())
        .collect();
    workspace.change(format!("Pose {}", pose.name), |document| {
        document.take_pose(&pose, |id| !held.contains(&id));
    });
}

/// Replaces a pose by the shown state.
pub(crate) fn renew_pose(workspace: &mut Workspace, place: usize) {
    workspace.change("Update pose", |document| {
        if let Some(name) = document.poses().get(place).map(|pose| pose.name.clone()) {
            let pose = document.present_pose(name);
            document.change_poses(|poses| poses[place] = pose);
        }
    });
}

/// Renames a pose.
pub(crate) fn rename_pose(workspace: &mut Workspace, place: usize, name: String) {
    workspace.change("Rename pose", |document| {
        document.change_poses(|poses| {
            if let Some(pose) = poses.get_mut(place) {
                pose.name = name;
            }
        });
    });
}

/// Removes a pose. Nothing moves.
pub(crate) fn remove_pose(workspace: &mut Workspace, place: usize) {
    workspace.change("Remove pose", |document| {
        document.change_poses(|poses| {
            if place < poses.len() {
                poses.remove(place);
            }
        });
    });
}

/// "pose 1", or with the next number that no pose has.
fn free_name(document: &Document) -> String {
    let name = |number: usize| format!("pose {number}");
    let is_free = |number: &usize| document.poses().iter().all(|pose| pose.name != name(*number));
    name((1..=document.poses().len() + 1).find(is_free).unwrap_or(1))
}
