"""Packs the add-on with a wheel into the archive that Blender installs: pack.py WHEEL FOLDER."""

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


def pack(wheel, folder):
    """The path of the archive. Equal files give equal bytes."""
    source = Path(__file__).parent / "addon"
    manifest = (source / "blender_manifest.toml").read_text()
    version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE)[1]
    manifest = re.sub(r"^wheels = \[.*\]", f'wheels = ["./wheels/{wheel.name}"]', manifest, flags=re.MULTILINE)
    manifest = re.sub(r"^platforms = \[.*\]", f'platforms = ["{platform(wheel)}"]', manifest, flags=re.MULTILINE)
    files = {path.name: path.read_bytes() for path in [*source.glob("*.py"), source / "LICENSE"]}
    files["blender_manifest.toml"] = manifest.encode()
    files[f"wheels/{wheel.name}"] = wheel.read_bytes()
    archive = folder / f"pliant-blender-{version}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for name in sorted(files):
            out.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED)
    return archive


if __name__ == "__main__":
    print(pack(Path(sys.argv[1]), Path(sys.argv[2])))
