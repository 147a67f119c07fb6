"""scripts/package, after staging: bundles the libraries with their licenses, and makes the zip."""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import tomllib
from velour.native import library as native

ROOT = Path(__file__).resolve().parents[2]
BUILT = ROOT / "build/release"
STAGED = ROOT / "build/package/blender/addons/velour"  # build/package/blender serves as BLENDER_USER_SCRIPTS
# Provided by the system that runs Blender, in the version we link or newer (docs/engine/packaging.md).
_OF_THE_SYSTEM = (
    "ld-linux",
    "libc.so",
    "libm.so",
    "libdl.so",
    "libpthread.so",
    "librt.so",
    "libstdc++.so",
    "libgcc_s.so",
)
_DOS_FOLDER = 0x10
_OLDEST_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest date of zips, for all files: builds are reproducible


def main() -> int:
    parser = argparse.ArgumentParser(prog="package")
    parser.add_argument("--output", metavar="FOLDER", type=Path, default=ROOT / "build/package")
    output = parser.parse_args().output
    shutil.rmtree(STAGED, ignore_errors=True)
    shutil.copytree(BUILT / "blender/addons/velour", STAGED, ignore=shutil.ignore_patterns("__pycache__"))
    library = STAGED / "lib/libvelour.so"
    shutil.copy(BUILT / "portable/libvelour.so", library)
    (STAGED / "lib/libvelour_openimageio.so").unlink()  # the portable library reads pictures itself
    sources = bundled(library)
    for source in sources:
        shutil.copy(source, library.parent / source.name)
    _write_licences(sources, STAGED / "lib/LICENSES.txt")
    manifest = tomllib.loads((STAGED / "blender_manifest.toml").read_text(encoding="utf-8"))
    output.mkdir(parents=True, exist_ok=True)
    path = output / f"{manifest['id']}-{manifest['version']}-{manifest['platforms'][0]}.zip"
    write_zip(path, STAGED)
    needs = [oldest(STAGED / "lib" / file.name) for file in [library, *sources]]
    glibc, runtime = (max(need[kind] for need in needs) for kind in ("GLIBC", "GLIBCXX"))
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB, {len(sources)} libraries beside Velour's")
    print(f"needs glibc {_dotted(glibc)} and libstdc++ with GLIBCXX_{_dotted(runtime)}, or newer")
    return 0


def bundled(library: Path) -> list[Path]:
    """Files of all libraries that `library` needs, directly or not, and that a system may lack."""
    known = _system_libraries()
    embree = Path(native.system()["embree"]["path"])  # opened at run time, so no header names it
    found: dict[str, Path] = {embree.name: embree}
    wanted = _needed(library) + _needed(embree)
    while wanted:
        name = wanted.pop()
        if name in found or name.startswith(_OF_THE_SYSTEM):
            continue
        if name not in known:
            raise SystemExit(
                f"package: {name}, which the library needs, is not installed; run scripts/setup."
            )
        found[name] = known[name]
        wanted += _needed(known[name])
    return [found[name] for name in sorted(found)]


def _needed(file: Path) -> list[str]:
    text = subprocess.run(["readelf", "-d", file], check=True, capture_output=True, text=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.+)\]", text)


def _system_libraries() -> dict[str, Path]:
    text = subprocess.run(["/sbin/ldconfig", "-p"], check=True, capture_output=True, text=True).stdout
    rows = re.findall(r"^\s+(\S+) \(libc6,x86-64\S*.*\) => (\S+)$", text, re.MULTILINE)
    return {name: Path(path) for name, path in reversed(rows)}


def oldest(file: Path) -> dict[str, tuple[int, ...]]:
    """The newest version of each kind of symbol that the file requires of the system."""
    text = subprocess.run(["readelf", "-V", file], check=True, capture_output=True, text=True).stdout
    found: dict[str, tuple[int, ...]] = {"GLIBC": (0,), "GLIBCXX": (0,)}
    for kind, version in re.findall(r"Name: (GLIBC|GLIBCXX)_([\d.]+)", text):
        found[kind] = max(found[kind], tuple(int(part) for part in version.split(".")))
    return found


def _dotted(version: tuple[int, ...]) -> str:
    return ".".join(map(str, version))


def _write_licences(sources: list[Path], to: Path) -> None:
    """Writes the copyright notices of the libraries' Debian packages."""
    packages: dict[str, list[str]] = {}
    for source in sources:
        # Packages may list a file in /lib, which is a link to /usr/lib.
        pattern = "*" + str(source.resolve()).removeprefix("/usr")
        answer = subprocess.run(["dpkg", "-S", pattern], capture_output=True, text=True).stdout
        packages.setdefault(answer.split(":")[0], []).append(source.name)
    parts = []
    for package, names in packages.items():
        notice = Path("/usr/share/doc") / package / "copyright"
        if not package or not notice.is_file():
            raise SystemExit(f"package: no Debian package has the license of {', '.join(names)}.")
        text = notice.read_text(encoding="utf-8")
        parts.append(f"{', '.join(names)} (Debian's {package})\n{'=' * 78}\n{text}")
    to.write_text("\n".join(parts), encoding="utf-8")


def write_zip(path: Path, folder: Path) -> None:
    """Writes a zip with one top-level folder, as all versions of Blender expect of add-ons.

    The folder has its own entry: without it, Blender's *Install* overwrites the files of an older Velour
    instead of removing them, which breaks the library in a Blender that has mapped it.
    """
    partial = path.with_suffix(".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        entry = zipfile.ZipInfo(f"{folder.name}/", _OLDEST_DATE)
        entry.external_attr = 0o40755 << 16 | _DOS_FOLDER
        out.writestr(entry, b"")
        for file in sorted(file for file in folder.rglob("*") if file.is_file()):
            entry = zipfile.ZipInfo(str(Path(folder.name) / file.relative_to(folder)), _OLDEST_DATE)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, file.read_bytes())
    partial.replace(path)


if __name__ == "__main__":
    sys.exit(main())
