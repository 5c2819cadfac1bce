//! A person's work, the actions on it, and their consequences.

mod body_way;
mod colour_revisions;
mod colours;
mod consequences;
mod control_selection;
mod controls;
mod crease_distances;
mod crease_width;
mod curves;
mod dirty_colours;
mod examples;
mod filter_work;
mod filters;
mod flow;
mod flow_play;
mod footprint_work;
mod footprints;
mod frame_work;
mod frames;
mod freedom;
mod handle_values;
mod handle_ways;
mod handles;
mod key_work;
mod keys;
mod mirror;
mod mirror_request;
mod mix;
mod mix_work;
mod objects;
mod options;
mod painting;
mod path;
mod poses;
mod regions;
mod selection;
mod shown_controls;
mod skin_frames;
mod skins;
mod snapshot;
mod state;
mod stiffness;
mod stitching;
mod stitching_request;
mod symmetry;
mod work_pose;

pub(crate) use colour_revisions::ColouredBy;
pub use colours::stiffness_colour;
pub(crate) use colours::{light_part, region_colour, rims, tint_limb};
pub(crate) use controls::{
    bring as bring_attachment, make as make_controls, middle, put_attachment, reset as reset_controls,
};
pub(crate) use crease_width::set_crease_width;
pub(crate) use curves::{
    divide_curve, pin_or_unpin_curve_points, remove_curve_points, selected_curve, set_bend_range, sharpen_crease,
};
pub(crate) use examples::{add_example, keep_example, remove_example, rename_example, set_example_weight};
pub(crate) use filters::set_filter;
pub(crate) use footprints::set_footprints;
pub(crate) use freedom::{aim_free_handles, free_or_hold_selected};
pub(crate) use handle_values::{set_continuity, set_parent, set_reach, set_soft, set_turn, transform_handle};
pub(crate) use handles::{
    change_handle, count_turn, delete_selected, held_because, pin_or_unpin_selected, put_handle, put_handles,
    reset_region, set_pivot, set_pivot_place, split_selected, untwin,
};
pub(crate) use keys::{
    copy_keys, delete_keys, go_to, key_here, key_pose, key_strength, key_weights, move_keys, neighbour_key, paste_keys,
    set_fps, set_key_ease, set_key_space, set_span, step_frames, stretch_keys,
};
pub(crate) use mirror::{mirror, take_mirrored};
pub(crate) use mirror_request::Purpose;
pub(crate) use mix::set_mix;
pub(crate) use objects::{
    NOTHING_HERE, act_on_object_here, act_on_objects, isolate, set_small_parts, show_everything, turn_inside_out,
};
pub(crate) use options::{
    apply_shape, clear_regions, reset_shape, set_loose, set_loose_part, set_method, set_strength, set_tips,
};
pub(crate) use painting::{members, tidy_handles};
pub(crate) use path::{BEND_PATH, bend_path, free_path, put_path};
pub(crate) use poses::{keep_pose, remove_pose, rename_pose, renew_pose, take_pose};
pub use regions::RegionAction;
pub(crate) use regions::act_on_region;
pub(crate) use shown_controls::{ControlSource, ShownLines};
pub use snapshot::SnapshotKey;
pub(crate) use state::Workspace;
pub use stiffness::StiffnessChange;
pub(crate) use stiffness::{change_stiffness, clear_stiffness, set_stiffness};
pub(crate) use stitching::{
    held_parts, merge_held, mirror_held, spared_by_cuts, stitch, take_stitched, take_stitching,
};
pub(crate) use symmetry::set_symmetry;
pub(crate) use work_pose::{carry_corrections, lasting, toggle_work_pose};
