"""Packs the add-on with wheels into the archive that Blender installs: pack.py WHEEL.. FOLDER.

With one wheel the archive is for its platform; with several it is for all of theirs.
"""

import re
import sys
import zipfile
from pathlib import Path


# The system and processor at the end of a wheel's name, and Blender's names for them.
PLATFORMS = {
    ("linux", "x86_64"): "linux-x64",
    ("linux", "aarch64"): "linux-arm64",
    ("macosx", "arm64"): "macos-arm64",
    ("macosx", "x86_64"): "macos-x64",
    ("win", "amd64"): "windows-x64",
    ("win", "arm64"): "windows-arm64",
}


def platform(wheel):
    """The platform of a wheel, in Blender's words."""
    tag = wheel.stem.rsplit("-", 1)[1]
    for (system, processor), name in PLATFORMS.items():
        if re.match(rf"(many)?{system}", tag) and tag.endswith(processor):
            return name
    raise SystemExit(f"{wheel.name} is for {tag}, which Blender does not run on: build the wheel for another platform")


def listed(name, values, manifest):
    """The manifest with another list of this name."""
    values = ", ".join(f'"{value}"' for value in values)
    return re.sub(rf"^{name} = \[.*\]", f"{name} = [{values}]", manifest, flags=re.MULTILINE)


def pack(wheels, folder):
    """The path of the archive. Equal files give equal bytes, in any order of the wheels."""
    platforms = [platform(wheel) for wheel in wheels]
    for name in platforms:
        if platforms.count(name) > 1:
            raise SystemExit(f"several wheels are for {name}: give one for each platform")
    wheels = dict(sorted(zip(platforms, wheels)))
    source = Path(__file__).parent / "addon"
    manifest = (source / "blender_manifest.toml").read_text(encoding="utf-8")
    version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE)[1]
    manifest = listed("wheels", [f"./wheels/{wheel.name}" for wheel in wheels.values()], manifest)
    manifest = listed("platforms", wheels, manifest)
    files = {path.name: path.read_bytes() for path in [*source.glob("*.py"), source / "LICENSE"]}
    files["blender_manifest.toml"] = manifest.encode()
    files |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels.values()}
    archive = folder / f"pliant-blender-{version}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for name in sorted(files):
            out.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED)
    return archive


if __name__ == "__main__":
    *wheels, folder = map(Path, sys.argv[1:])
    print(pack(wheels, folder))
