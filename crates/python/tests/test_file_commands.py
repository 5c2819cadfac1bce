"""Functions from files to files, with the names and arguments of the command line's commands."""

import json
import warnings

import numpy as np
import pytest

import pliant
from conftest import ROOT, bar, write_off
from test_command_line import run

CREATURE = ROOT / "assets" / "creature.glb"
EDIT = ROOT / "assets" / "creature.edit.json"
TIMES = ("load_ms", "order_ms", "bind_ms", "save_ms", "check_ms", "fill_ms", "join_ms", "total_ms")

BEND = {
    "version": 1,
    "method": {"name": "bilaplacian"},
    "fixed": {"slab": {"axis": "y", "from": 0, "to": 0.1}},
    "handles": [{"name": "top", "select": {"slab": {"axis": "y", "from": 0.9, "to": 1}}}],
}
RAISED = {"translation": [0.3, -0.2, 0.0], "rotation": [0, 0, 0.5, 0.87]}
LIFT = {**BEND, "handles": [{**BEND["handles"][0], "transform": RAISED}]}
KEYED = {**BEND, "keys": [{"time": 0, "handles": {"top": {}}}, {"time": 0.25, "handles": {"top": RAISED}}]}
SPANNED = {**BEND, "keys": [{"frame": 1, "span": [0, 2], "handles": {"top": RAISED}}]}


def without_times(report):
    return {name: value for name, value in report.items() if name not in TIMES and name != "frames"}


@pytest.fixture
def files(tmp_path):
    """A bar as a file, and its edits as files."""
    vertices, faces = bar()
    write_off(tmp_path / "bar.off", vertices, faces)
    for name, edit in {"lift": LIFT, "keyed": KEYED, "spanned": SPANNED}.items():
        (tmp_path / f"{name}.json").write_text(json.dumps(edit))
    return tmp_path


def test_info_tells_what_the_command_line_tells(program, files):
    for file in (CREATURE, files / "bar.off"):
        assert pliant.info(file) == json.loads(run(program, "info", file, "--json"))
    told = pliant.info(files / "bar.off")
    assert (told["vertices"], told["triangles"], len(told["components"])) == (480, 936, 1)
    with pytest.raises(FileNotFoundError):
        pliant.info(files / "none.off")


def test_apply_writes_the_command_line_s_bytes(program, tmp_path):
    expected, report = tmp_path / "expected.glb", tmp_path / "expected.json"
    run(program, "apply", CREATURE, "--edit", EDIT, "--output", expected, "--report", report)
    told = pliant.apply(CREATURE, edit=EDIT, output=tmp_path / "own.glb", report=tmp_path / "own.json")
    assert (tmp_path / "own.glb").read_bytes() == expected.read_bytes()
    assert told == json.loads((tmp_path / "own.json").read_text())
    assert without_times(told) == without_times(json.loads(report.read_text()))


def test_apply_takes_a_dict_and_another_method(files):
    by_file = pliant.apply(files / "bar.off", edit=files / "lift.json", output=files / "a.off")
    by_dict = pliant.apply(files / "bar.off", edit=LIFT, output=files / "b.off")
    assert without_times(by_file) == without_times(by_dict)
    assert (files / "a.off").read_bytes() == (files / "b.off").read_bytes()
    own = pliant.apply(files / "bar.off", edit=LIFT, output=files / "c.off", method={"name": "arap"}, frames=3)
    assert (own["method"], own["frames"]["count"]) == ("arap", 3)
    bound = pliant.load(files / "bar.off").bind(
        handles={"top": BEND["handles"][0]["select"]}, fixed=BEND["fixed"], method="bilaplacian"
    )
    assert np.allclose(pliant.load(files / "a.off").vertices, bound.step({"top": RAISED}), atol=1e-9)


def test_apply_adds_a_morph_target(files):
    pliant.save(files / "bar.glb", pliant.load(files / "bar.off"))
    for given, name in [(True, "lift"), ("smile", "smile")]:
        pliant.apply(
            files / "bar.glb", edit=files / "lift.json", output=files / "morph.glb", as_morph=given, morph_weight=0.5
        )
        told = pliant.info(files / "morph.glb")
        assert told["holds"]["morph_targets"] == 1
        assert name.encode() in (files / "morph.glb").read_bytes()


def test_a_refusal_writes_nothing_and_names_the_argument(files):
    bar_, lift = files / "bar.off", files / "lift.json"
    before = {path.name: path.read_bytes() for path in files.iterdir()}
    wrong = {**LIFT, "metod": {}}
    for said, call in [
        ("edit: .*metod", lambda: pliant.apply(bar_, edit=wrong, output=files / "x.off")),
        ("edit is of type list: give a path, or a dict", lambda: pliant.apply(bar_, edit=[], output=files / "x.off")),
        ("frames is 0: give a number from 1", lambda: pliant.apply(bar_, edit=lift, output=files / "x.off", frames=0)),
        (
            "memory is lots: give a number of bytes",
            lambda: pliant.apply(bar_, edit=lift, output=files / "x.off", memory="lots"),
        ),
        ("did you mean `arap`", lambda: pliant.apply(bar_, edit=lift, output=files / "x.off", method="arab")),
        ("^output .* is also edit: give it another name", lambda: pliant.apply(bar_, edit=lift, output=lift)),
        (
            "^report .* is also output",
            lambda: pliant.apply(bar_, edit=lift, output=files / "x.off", report=files / "x.off"),
        ),
        (
            'morph_deltas takes "turn" or "stay"',
            lambda: pliant.apply(bar_, edit=lift, output=files / "x.off", morph_deltas="both"),
        ),
        ("use `pliant animate`", lambda: pliant.apply(bar_, edit=KEYED, output=files / "x.off")),
        (
            "fps is 0: give a number from 0.001 to 1000",
            lambda: pliant.animate(bar_, edit=KEYED, output=files / "x.pc2", fps=0),
        ),
        (
            "^output .* is one file: end its name in -####",
            lambda: pliant.animate(bar_, edit=KEYED, output=files / "x.off"),
        ),
        ("output .* is the file that is read: give another name$", lambda: pliant.fill(bar_, output=bar_)),
        ("give largest or at, not both", lambda: pliant.fill(bar_, output=files / "x.off", largest=1, at=0)),
        ("at is -1: give the number of a vertex", lambda: pliant.fill(bar_, output=files / "x.off", at=-1)),
        ("give one of delete, plane and curve", lambda: pliant.cut(bar_, output=files / "x.off")),
        ("its normal has no direction", lambda: pliant.cut(bar_, output=files / "x.off", plane=[0, 0, 0, 1])),
        ('keep takes "positive"', lambda: pliant.cut(bar_, output=files / "x.off", plane=[0, 1, 0, 1], keep="up")),
    ]:
        with pytest.raises(ValueError, match=said):
            call()
    with pytest.raises(FileNotFoundError):
        pliant.apply(bar_, edit=files / "none.json", output=files / "x.off")
    assert {path.name: path.read_bytes() for path in files.iterdir()} == before


def test_animate_and_sequence_write_the_command_line_s_bytes(program, files):
    (files / "program").mkdir()
    for output in ("wave.glb", "wave.pc2"):
        expected = files / "program" / output
        run(program, "animate", files / "bar.off", "--edit", files / "keyed.json", "--output", expected, "--fps", 12)
        told = pliant.animate(files / "bar.off", edit=files / "keyed.json", output=files / output, fps=12)
        assert told["frames"]["count"] == 4
        assert (files / output).read_bytes() == expected.read_bytes()
    (files / "frames").mkdir()
    pliant.animate(files / "bar.off", edit=KEYED, output=files / "frames" / "wave-####.off", fps=12)
    frames = sorted((files / "frames").iterdir())
    assert [frame.name for frame in frames] == [f"wave-{number:04}.off" for number in range(4)]
    run(program, "sequence", files / "frames", "--edit", files / "spanned.json", "--output", files / "expected")
    told = pliant.sequence(files / "frames", edit=SPANNED, output=files / "bent", report=files / "report.json")
    assert (told["frames"], told) == (4, json.loads((files / "report.json").read_text()))
    for frame in frames:
        assert (files / "bent" / frame.name).read_bytes() == (files / "expected" / frame.name).read_bytes()


def test_new_shapes_are_the_command_line_s(program, files):
    top = {"slab": {"axis": "y", "from": 0.8, "to": 1}}
    (files / "top.json").write_text(json.dumps(top))
    ring = {"version": 1, "points": [[0.05, 0.4, 0.2], [-0.05, 0.45, 0.2], [0, 0.55, 0.2]], "closed": True}
    (files / "ring.json").write_text(json.dumps(ring))
    (files / "joins.json").write_text(json.dumps({"version": 1}))
    bar_, half = files / "bar.off", files / "half.off"
    run(program, "cut", bar_, "--delete", files / "top.json", "--output", half)
    for words, call in [
        (["cut", bar_, "--delete", files / "top.json"], lambda out: pliant.cut(bar_, delete=top, output=out)),
        (
            ["cut", bar_, "--delete", files / "top.json"],
            lambda out: pliant.cut(bar_, delete=files / "top.json", output=out),
        ),
        (["cut", bar_, "--plane", "0,1,0,0.43"], lambda out: pliant.cut(bar_, plane=(0, 1, 0, 0.43), output=out)),
        (
            ["cut", bar_, "--plane", "0,1,0,0.43", "--keep", "both"],
            lambda out: pliant.cut(bar_, plane=np.array([0, 1, 0, 0.43]), keep="both", output=out),
        ),
        (
            ["cut", bar_, "--curve", files / "ring.json", "--keep", "negative"],
            lambda out: pliant.cut(bar_, curve=ring, keep="negative", output=out),
        ),
        (["fill", bar_], lambda out: pliant.fill(bar_, output=out)),
        (["fill", bar_, "--largest", 1], lambda out: pliant.fill(bar_, largest=1, output=out)),
        (["fill", bar_, "--at", 0], lambda out: pliant.fill(bar_, at=0, output=out)),
        (["bridge", bar_, "--borders", 0, 479], lambda out: pliant.bridge(bar_, borders=(0, 479), output=out)),
        (
            ["merge", bar_, half, "--joins", files / "joins.json"],
            lambda out: pliant.merge(bar_, half, joins={"version": 1}, output=out),
        ),
    ]:
        expected, own, report = files / "expected.ply", files / "own.ply", files / "report.json"
        run(program, *words, "--output", expected, "--report", report)
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            told = call(own)
        assert own.read_bytes() == expected.read_bytes(), words
        assert without_times(told) == without_times(json.loads(report.read_text())), words
        assert [str(one.message) for one in warned] == told["warnings"]
