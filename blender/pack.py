"""Packs the add-on with a wheel into the archive that Blender installs: pack.py WHEEL FOLDER."""

import re
import sys
import zipfile
from pathlib import Path


def pack(wheel, folder):
    """The path of the archive. Equal files give equal bytes."""
    source = Path(__file__).parent / "addon"
    manifest = (source / "blender_manifest.toml").read_text()
    version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE)[1]
    manifest = re.sub(r"^wheels = \[.*\]", f'wheels = ["./wheels/{wheel.name}"]', manifest, flags=re.MULTILINE)
    files = {f"{path.name}": path.read_bytes() for path in source.glob("*.py")}
    files["blender_manifest.toml"] = manifest.encode()
    files[f"wheels/{wheel.name}"] = wheel.read_bytes()
    archive = folder / f"pliant-blender-{version}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for name in sorted(files):
            out.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED)
    return archive


if __name__ == "__main__":
    print(pack(Path(sys.argv[1]), Path(sys.argv[2])))
