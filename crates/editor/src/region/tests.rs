//! Laws of the region.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Loose, Role};
use pliant_mesh::{Cancel, Drawn, Model, Progress, WeldOptions, shapes};

use crate::Reach;
use crate::document::{HandleId, Paint, Tips};
use crate::region::{FileContacts, Region, RegionInput};

/// A model whose vertices are painted by their positions, with handles of this reach.
pub(super) fn painted_input(
    model: Model,
    handles: &[HandleId],
    reach: Reach,
    paint: impl Fn(&DVec3) -> Paint,
) -> RegionInput {
    RegionInput {
        paint: Arc::new(model.surface.positions.iter().map(paint).collect()),
        model: Arc::new(model),
        handles: handles.iter().map(|id| (*id, reach)).collect(),
        twins: BTreeMap::new(),
        rest: None,
        is_of_file: false,
        tips: Tips::ComeAlong,
        loose: Loose::Follow,
        loose_parts: Arc::default(),
        access: Arc::default(),
        contacts: FileContacts::default(),
        has_controls: false,
    }
}

/// A sheet over the unit square with a handle: the vertices within `radius` of its middle.
fn sheet_with_disc(radius: f64, reach: Reach) -> RegionInput {
    let drawn = shapes::grid(60, 60);
    let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
    let middle = DVec3::new(0.5, 0.5, 0.0);
    let is_inside = |p: &DVec3| p.distance(middle) <= radius;
    let paint = |p: &DVec3| {
        if is_inside(p) {
            Paint::Handle(HandleId(7))
        } else {
            Paint::Bare
        }
    };
    painted_input(model, &[HandleId(3), HandleId(7)], reach, paint)
}

#[test]
fn control_points_set_everything_free_that_is_bare_only_where_there_is_no_handle_and_nothing_was_painted_free() {
    let with_controls = RegionInput {
        has_controls: true,
        ..sheet_with_disc(0.08, Reach::default())
    };
    let of = |input: &RegionInput| Region::measure(input, &Cancel::new()).unwrap();
    let without_controls = sheet_with_disc(0.08, Reach::default());
    assert_eq!(
        of(&with_controls).roles,
        of(&without_controls).roles,
        "a handle has its reach"
    );
    let mut bare = RegionInput {
        handles: Vec::new(),
        paint: Arc::new(vec![Paint::Bare; with_controls.paint.len()]),
        ..with_controls
    };
    Arc::make_mut(&mut bare.paint)[3] = Paint::Fixed;
    let region = of(&bare);
    assert_eq!((region.counts.fixed, region.roles[3]), (1, Role::Fixed));
    Arc::make_mut(&mut bare.paint)[5] = Paint::Free;
    assert_eq!(of(&bare).counts.free, 1);
}

#[test]
fn a_disc_reaches_three_of_its_radii_beyond_its_rim() {
    let radius = 0.08;
    let input = sheet_with_disc(radius, Reach::default());
    let region = Region::measure(&input, &Cancel::new()).unwrap();
    assert_eq!(*region.handles, [HandleId(7)], "a handle without vertices is none");
    for (position, role) in input.model.surface.positions.iter().zip(region.roles.iter()) {
        let from_middle = position.distance(DVec3::new(0.5, 0.5, 0.0));
        let expected = match from_middle / radius {
            ..=1.0 => Some(Role::Handle(0)),
            1.2..3.6 => Some(Role::Free),
            4.4.. => Some(Role::Fixed),
            _ => None,
        };
        assert!(
            expected.is_none_or(|expected| expected == *role),
            "{role:?} at {from_middle}"
        );
    }
}

#[test]
fn a_reach_of_nothing_frees_nothing_and_paint_wins_over_reach() {
    let input = sheet_with_disc(0.1, Reach::Length(0.0));
    assert_eq!(Region::measure(&input, &Cancel::new()).unwrap().counts.free, 0);
    let mut input = sheet_with_disc(0.1, Reach::Length(10.0));
    for (paint, position) in Arc::make_mut(&mut input.paint)
        .iter_mut()
        .zip(&input.model.surface.positions)
    {
        if position.x < 0.2 {
            *paint = Paint::Fixed;
        }
    }
    let region = Region::measure(&input, &Cancel::new()).unwrap();
    for (position, role) in input.model.surface.positions.iter().zip(region.roles.iter()) {
        assert_eq!(position.x < 0.2, *role == Role::Fixed);
    }
}

/// A long mesh with a handle around the share `at` of its length, which reaches a tenth of the length.
fn cut_at(drawn: Drawn, at: f64) -> (RegionInput, Vec<f64>) {
    let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
    let bounds = model.bounds().unwrap();
    let extent = bounds.max - bounds.min;
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap();
    let positions = model.surface.positions.iter();
    let shares: Vec<f64> = positions.map(|p| (p[axis] - bounds.min[axis]) / extent[axis]).collect();
    let paint = |share: &f64| match (share - at).abs() < 0.02 {
        true => Paint::Handle(HandleId(0)),
        false => Paint::Bare,
    };
    let input = RegionInput {
        paint: Arc::new(shares.iter().map(paint).collect()),
        model: Arc::new(model),
        handles: vec![(HandleId(0), Reach::Length(0.1 * extent[axis]))],
        twins: BTreeMap::new(),
        rest: None,
        is_of_file: false,
        tips: Tips::ComeAlong,
        loose: Loose::Follow,
        loose_parts: Arc::default(),
        access: Arc::default(),
        contacts: FileContacts::default(),
        has_controls: false,
    };
    (input, shares)
}

fn long_meshes() -> Vec<Drawn> {
    let stretched = DAffine3::from_scale(DVec3::new(1.0, 8.0, 1.0));
    vec![
        shapes::bar(60, 4, 4),
        shapes::tube(24, 80, 9.0),
        shapes::moved(&shapes::icosphere(5), stretched),
    ]
}

fn roles(input: &RegionInput) -> Vec<Role> {
    Region::measure(input, &Cancel::new()).unwrap().roles.to_vec()
}

#[test]
fn what_the_reach_cuts_off_a_limb_comes_along_and_the_body_stays() {
    for drawn in long_meshes() {
        let (mut input, shares) = cut_at(drawn, 0.8);
        for (share, role) in shares.iter().zip(roles(&input)) {
            match share {
                ..0.66 => assert_eq!(role, Role::Fixed, "{share}"),
                0.84.. => assert_eq!(role, Role::Free, "{share}"),
                _ => {}
            }
        }
        input.tips = Tips::Held;
        for (share, role) in shares.iter().zip(roles(&input)) {
            assert!(*share < 0.94 || role == Role::Fixed, "{share}");
        }
    }
}

#[test]
fn halves_of_a_cut_in_the_middle_both_stay() {
    for drawn in long_meshes() {
        let (input, shares) = cut_at(drawn, 0.49);
        for (share, role) in shares.iter().zip(roles(&input)) {
            assert!((0.34..0.64).contains(share) || role == Role::Fixed, "{share}");
        }
    }
}

#[test]
fn a_tip_that_was_told_what_to_do_does_it() {
    let is_held_between = |input: &RegionInput, shares: &[f64]| {
        let between = shares
            .iter()
            .zip(roles(input))
            .filter(|(share, _)| (0.93..0.97).contains(*share));
        let held: Vec<bool> = between.map(|(_, role)| role == Role::Fixed).collect();
        assert!(!held.is_empty());
        held.into_iter().all(|held| held)
    };
    for drawn in long_meshes() {
        let (mut input, shares) = cut_at(drawn, 0.8);
        assert!(!is_held_between(&input, &shares));
        let bare = Arc::clone(&input.paint);
        let paint_tip = |input: &mut RegionInput, with: Paint| {
            let paint = bare.iter().zip(&shares);
            input.paint = Arc::new(
                paint
                    .map(|(bare, share)| if *share > 0.98 { with } else { *bare })
                    .collect(),
            );
        };
        paint_tip(&mut input, Paint::Fixed);
        assert!(is_held_between(&input, &shares), "a pinned tip");
        input.handles.push((HandleId(1), Reach::Length(0.0)));
        paint_tip(&mut input, Paint::Handle(HandleId(1)));
        assert!(
            is_held_between(&input, &shares),
            "a tip that is a handle without a reach"
        );
    }
}

/// A cube with the given edge length whose lowest face is centred at `foot`.
fn cube(edge: f64, foot: DVec3) -> Drawn {
    let to_foot = DAffine3::from_translation(DVec3::new(-1.0, -1.0, 0.0));
    let place = DAffine3::from_translation(foot) * DAffine3::from_scale(DVec3::splat(0.5 * edge)) * to_foot;
    shapes::moved(&shapes::bar(2, 2, 2), place)
}

#[test]
fn a_part_goes_with_what_it_touches_and_not_with_what_is_near_through_the_air() {
    let middle = |z| DVec3::new(0.5, 0.5, z);
    let ceiling = shapes::moved(&shapes::grid(30, 30), DAffine3::from_translation(DVec3::Z * 0.06));
    let on_sheet = cube(0.04, middle(0.0005));
    let on_cube = cube(0.01, middle(0.0405));
    let under_ceiling = cube(0.04, DVec3::new(0.55, 0.5, 0.0195));
    let on_still_place = cube(0.04, DVec3::new(0.95, 0.95, 0.0005));
    let in_the_air = cube(0.01, DVec3::new(0.45, 0.5, 0.02));
    let drawn = shapes::together(&[
        shapes::grid(60, 60),
        ceiling,
        on_sheet.clone(),
        on_cube.clone(),
        under_ceiling.clone(),
        on_still_place.clone(),
        in_the_air.clone(),
    ]);
    let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
    let mut input = sheet_with_disc(0.08, Reach::default());
    let is_inside = |p: &DVec3| p.z == 0.0 && p.distance(middle(0.0)) <= 0.08;
    let painted = |p: &DVec3| {
        if is_inside(p) {
            Paint::Handle(HandleId(7))
        } else {
            Paint::Bare
        }
    };
    input.paint = Arc::new(model.surface.positions.iter().map(painted).collect());
    input.model = Arc::new(model);
    let roles = roles(&input);
    let role_of = |part: &Drawn| {
        let at = |p: &DVec3| {
            input
                .model
                .surface
                .positions
                .iter()
                .position(|q| q.distance(*p) < 1e-12)
        };
        let roles: Vec<Role> = part.positions.iter().map(|p| roles[at(p).unwrap()]).collect();
        assert!(roles.iter().all(|role| *role == roles[0]));
        roles[0]
    };
    assert_eq!(role_of(&on_sheet), Role::Free);
    assert_eq!(role_of(&on_cube), Role::Free, "it touches a part that goes along");
    assert_eq!(role_of(&under_ceiling), Role::Fixed, "what it touches is held");
    assert_eq!(role_of(&on_still_place), Role::Fixed, "the sheet is held there");
    assert_eq!(
        role_of(&in_the_air),
        Role::Free,
        "it touches nothing, and the handle reaches all of it"
    );
}
