"""The archive that Blender installs."""

import importlib.util
import re
import zipfile
from pathlib import Path

import pytest

spec = importlib.util.spec_from_file_location("pack", Path(__file__).parents[1] / "pack.py")
pack = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pack)


@pytest.mark.parametrize(
    "tag, platform",
    [
        ("manylinux_2_28_x86_64", "linux-x64"),
        ("linux_x86_64", "linux-x64"),
        ("manylinux2014_aarch64", "linux-arm64"),
        ("macosx_11_0_arm64", "macos-arm64"),
        ("macosx_10_12_x86_64", "macos-x64"),
        ("win_amd64", "windows-x64"),
        ("win_arm64", "windows-arm64"),
    ],
)
def test_the_manifest_names_the_wheel_and_its_platform(tmp_path, tag, platform):
    wheel = tmp_path / f"pliant-0.1.0-cp310-abi3-{tag}.whl"
    wheel.write_bytes(b"an engine")
    archive = pack.pack([wheel], tmp_path)
    again = archive.read_bytes()
    with zipfile.ZipFile(pack.pack([wheel], tmp_path)) as files:
        names, manifest = files.namelist(), files.read("blender_manifest.toml").decode()
    assert archive.read_bytes() == again, "equal files give equal bytes"
    assert {"__init__.py", "live.py", "LICENSE", f"wheels/{wheel.name}"} <= set(names)
    assert re.search(r"^platforms = (.*)$", manifest, re.MULTILINE)[1] == f'["{platform}"]'
    assert re.search(r"^wheels = (.*)$", manifest, re.MULTILINE)[1] == f'["./wheels/{wheel.name}"]'


def test_a_wheel_for_what_blender_does_not_run_on_is_named(tmp_path):
    wheel = tmp_path / "pliant-0.1.0-cp310-abi3-emscripten_3_1_wasm32.whl"
    wheel.write_bytes(b"")
    with pytest.raises(SystemExit, match="emscripten_3_1_wasm32"):
        pack.pack([wheel], tmp_path)


def test_an_archive_for_several_platforms_has_all_wheels_in_any_order(tmp_path):
    tags = ["win_amd64", "manylinux_2_28_x86_64", "macosx_11_0_arm64"]
    wheels = [tmp_path / f"pliant-0.1.0-cp310-abi3-{tag}.whl" for tag in tags]
    for wheel in wheels:
        wheel.write_bytes(wheel.name.encode())
    archive = pack.pack(wheels, tmp_path)
    packed = archive.read_bytes()
    with zipfile.ZipFile(archive) as files:
        manifest = files.read("blender_manifest.toml").decode()
        assert all(files.read(f"wheels/{wheel.name}") == wheel.read_bytes() for wheel in wheels)
    assert 'platforms = ["linux-x64", "macos-arm64", "windows-x64"]' in manifest
    assert all(f'"./wheels/{wheel.name}"' in manifest for wheel in wheels)
    assert pack.pack(wheels[::-1], tmp_path).read_bytes() == packed
    with pytest.raises(SystemExit, match="several wheels are for windows-x64"):
        pack.pack([*wheels, wheels[0].with_name("pliant-0.2.0-cp310-abi3-win_amd64.whl")], tmp_path)
