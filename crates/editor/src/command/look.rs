//! Commands on the display of the surface.

use super::entry::{Action, Entry, Reason, Scope, State, alt, always, character, item, shift, when_open};
use crate::jobs::Inspectable;
use crate::view::{Before, Clay, Shading};

/// Shades the surface like this clay.
pub(super) const SET_CLAY: Entry<Clay> = Entry {
    listed: &[
        item(
            Clay::Clay,
            "Plain clay",
            "Shades like warm grey modelling clay, which shows the shape alone.",
            "clay matcap shading",
            &[],
        ),
        item(
            Clay::Plaster,
            "Plaster",
            "Shades like white plaster in soft daylight, which shows the finest changes.",
            "clay matcap shading",
            &[],
        ),
        item(
            Clay::Wax,
            "Wax",
            "Shades like red sculptors' wax with a soft gloss.",
            "clay matcap shading",
            &[],
        ),
        item(
            Clay::Bronze,
            "Bronze",
            "Shades like dark bronze, with highlights along every ridge.",
            "clay matcap shading",
            &[],
        ),
        item(
            Clay::Porcelain,
            "Porcelain",
            "Shades like glazed porcelain under sharp lamps, which show every dent.",
            "clay matcap shading",
            &[],
        ),
        item(
            Clay::Graphite,
            "Graphite",
            "Shades like graphite lit from the side, which shows relief.",
            "clay matcap shading",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, clay| {
        context.view.look.clay = clay;
        context.view.look.shading = Shading::Clay;
    }),
};

/// The shading of the surface.
pub(super) const SET_SHADING: Entry<Shading> = Entry {
    listed: &[
        item(
            Shading::Clay,
            "Clay",
            "Shades the surface like clay.",
            "matcap shading",
            &[],
        ),
        item(
            Shading::Material,
            "Material",
            "Shades the surface with the file's materials.",
            "texture colour color pbr",
            &[],
        ),
        item(
            Shading::Stretch,
            "Edge stretch",
            "Colours the surface by the ratio of its edges' lengths to those at rest.",
            "strain distortion",
            &[],
        ),
        item(
            Shading::Area,
            "Area change",
            "Colours the surface by the ratio of its area to that at rest.",
            "distortion",
            &[],
        ),
        item(
            Shading::Stiffness,
            "Stiffness",
            "Colours the surface by its painted stiffness.",
            "",
            &[],
        ),
        item(
            Shading::Weights,
            "Handle's weights",
            "Colours the surface by the share of the selected handle's turn and stretch that it follows.",
            "heat map influence propagation",
            &[],
        ),
        item(
            Shading::Curvature,
            "Curvature",
            "Colours the surface by its mean curvature: red where it bulges, blue where it is hollow.",
            "bulge",
            &[],
        ),
        item(
            Shading::Zebra,
            "Zebra stripes",
            "Mirrors stripes in the surface: they break at creases and kink where curvature jumps.",
            "reflection",
            &[],
        ),
        item(
            Shading::Normals,
            "Normals",
            "Colours the surface by the direction in which it faces.",
            "",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: |state, shading| match shading {
        Shading::Weights => no_weights(state),
        _ => None,
    },
    action: Action::Do(|context, shading| context.view.look.shading = shading),
};

/// The reason why no handle's weights can be shown.
fn no_weights(state: &State<'_>) -> Option<Reason> {
    let why =
        |title: &str| format!("The method \"{title}\" uses no weights: choose one that does, such as \"Twists\".");
    let inspectable = |inspectable: Inspectable| inspectable.weights;
    state
        .selected()
        .err()
        .or_else(|| not_in_binding(state, inspectable, why))
}

/// The reason why a part of the binding can't be shown: nothing is bound, or `why` for the method of this title.
fn not_in_binding(
    state: &State<'_>,
    is_there: impl Fn(Inspectable) -> bool,
    why: impl Fn(&str) -> String,
) -> Option<Reason> {
    let workspace = state.workspace;
    if !workspace.jobs.is_bound() {
        return Some("The method is not bound yet: paint a handle, or wait.".into());
    }
    let title = workspace.document.method().declaration().title;
    (!is_there(workspace.computed().inspectable())).then(|| why(title).into())
}

/// Shows the smooth base instead of the surface, or the surface again.
pub(super) const TOGGLE_BASE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Smooth base",
        "Shows the smooth base that the handles bend, without the details.",
        "fairing multiresolution detail",
        &[],
    )],
    scope: Scope::View,
    unavailable: |state, ()| {
        let why = |title: &str| {
            format!("The method \"{title}\" has no smooth base here: choose \"Soft\" and set its option Detail.")
        };
        let reason = || not_in_binding(state, |inspectable| inspectable.base, why);
        // An active display can always be turned off.
        (!state.view.look.base).then(reason).flatten()
    },
    action: Action::Do(|context, ()| context.view.look.base = !context.view.look.base),
};

/// Shows the file's own shape instead of the present one, or the present one again.
pub(super) const TOGGLE_ORIGINAL: Entry<()> = Entry {
    listed: &[item(
        (),
        "Original",
        "Shows the shape as it was opened while you hold the key.",
        "before after compare undeformed rest ghost",
        &[character('o')],
    )],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, ()| context.view.look.original = !context.view.look.original),
};

/// Shows the file's own shape together with the present one, or stops showing it.
pub(super) const TOGGLE_BEFORE: Entry<Before> = Entry {
    listed: &[
        item(
            Before::Split,
            "Before and after",
            "Shows the opened shape on the left of a line that you can drag, and the present shape on the right.",
            "split compare original slider wipe",
            &[alt('o')],
        ),
        item(
            Before::Ghost,
            "Original as ghost",
            "Shows the opened shape through the present shape.",
            "onion skin overlay compare before transparent",
            &[shift('o')],
        ),
    ],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, before| {
        let look = &mut context.view.look;
        look.before = if look.before == before { Before::Off } else { before };
    }),
};

/// Shades each triangle flat, or with interpolated normals.
pub(super) const TOGGLE_FLAT: Entry<()> = Entry {
    listed: &[item(
        (),
        "Flat faces",
        "Shades each triangle flat, or with interpolated normals.",
        "facets smooth shading",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.flat = !context.view.look.flat),
};

/// Marks edges that a closed surface does not have, or stops marking them.
pub(super) const TOGGLE_BORDERS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Borders",
        "Marks edges where the surface ends and edges that more than two triangles share.",
        "boundary holes edges",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.borders = !context.view.look.borders),
};

/// Shows or hides the handles' outlines and the border of the fixed part.
pub(super) const TOGGLE_OUTLINES: Entry<()> = Entry {
    listed: &[item(
        (),
        "Outlines",
        "Shows or hides the outlines of the handles and of the fixed region, while regions are shown.",
        "contours",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.outlines = !context.view.look.outlines),
};

/// Shows or hides the ground's grid.
pub(super) const TOGGLE_GRID: Entry<()> = Entry {
    listed: &[item(
        (),
        "Ground grid",
        "Shows or hides the ground's grid.",
        "floor",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.grid = !context.view.look.grid),
};

/// Shows or hides the surface's shadow on the ground.
pub(super) const TOGGLE_SHADOW: Entry<()> = Entry {
    listed: &[item(
        (),
        "Ground shadow",
        "Shows or hides the soft shadow on the ground. It is updated when the shape rests.",
        "contact occlusion floor",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.shadow = !context.view.look.shadow),
};

/// Shows or hides the regions: their colours over clay and material, and their outlines.
pub(super) const TOGGLE_REGIONS: Entry<()> = Entry {
    listed: &[item(
        (),
        "Show regions",
        "Shows or hides the regions: their colours and their outlines.",
        "colours colors overlay",
        &[],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.regions = !context.view.look.regions),
};

/// Shows or hides the wireframe.
pub(super) const TOGGLE_WIREFRAME: Entry<()> = Entry {
    listed: &[item(
        (),
        "Wireframe",
        "Shows or hides the triangles' edges.",
        "edges triangles mesh",
        &[character('w')],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.look.wireframe = !context.view.look.wireframe),
};
