"""scripts/presets, after staging: models and previews of the presets, and the .blend of them."""

from __future__ import annotations

import argparse
import hashlib
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
import numpy as np
import preset_preview
import presets_sheet
import script
from preset_build import QUICK, Sizes, Workshop
from preset_table import CATALOGS, PRESETS, Preset, Weave
from progress import Progress
from velour.core import files, presets
from velour.core.machine import threads
from velour.core.presets import CATALOG_FILE, INDEX_FILE, LIBRARY_FILE, LICENCE_FILE, MOST_BYTES
from velour.core.srgb import decoded, encoded
from velour.native import images
from velour_cli import ROOT

_MODELS = ROOT / "addon/presets"  # in the repository
_BUILT = ROOT / "build/presets"
_KEY = "library.key"  # hash of everything that the .blend was made of
_PICTURE = ROOT / "docs/results/images/presets.png"
_COST = {True: 10, False: 1}  # relative time of a cloth and of other presets, for the progress
_LICENCE = """The materials of this folder are in the public domain: CC0-1.0,
https://creativecommons.org/publicdomain/zero/1.0/
"""


def main() -> int:
    args = _arguments()
    models = args.output or (_BUILT / "quick" if args.quick else _MODELS)
    library = models if args.output or args.quick else _BUILT
    if not args.library:
        _build(models, args)
    listed = presets.listed(models)
    if args.docs:
        pictures = {preset.name: encoded(images.read_picture(preset.picture)) for preset in listed}
        presets_sheet.draw(_PICTURE, pictures)
    write_library(models, library)
    kept = {path for place in (models, library) for path in place.iterdir() if path.is_file()}
    size = sum(path.stat().st_size for path in kept)
    print(f"{library / LIBRARY_FILE}: {len(listed)} of {len(PRESETS)} presets, {size / 1e6:.2f} MB in all")
    if size > MOST_BYTES:
        print(f"presets: that is more than {MOST_BYTES / 1e6:.0f} MB", file=sys.stderr)
        return 1
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="presets")
    parser.add_argument("--only", metavar="NAME[,NAME...]", default="", help="builds no others")
    parser.add_argument("--quick", action="store_true", help="small and coarse, to try the script")
    parser.add_argument("--fresh", action="store_true", help="rebuilds what is kept")
    parser.add_argument("--library", action="store_true", help="builds only the .blend, from kept models")
    parser.add_argument("--docs", action="store_true", help=f"writes {_PICTURE.relative_to(ROOT)}, too")
    parser.add_argument("--output", metavar="FOLDER", type=Path)
    parser.add_argument("--threads", metavar="T", type=int, default=threads())
    return parser.parse_args()


def _chosen(only: str) -> list[Preset]:
    by_name = {preset.name.lower(): preset for preset in PRESETS}
    names = [name.strip().lower() for name in only.split(",") if name.strip()]
    unknown = [name for name in names if name not in by_name]
    if unknown:
        raise SystemExit(
            f"presets: there is no {unknown[0]!r}; there are {', '.join(p.name for p in PRESETS)}"
        )
    return [by_name[name] for name in names] or list(PRESETS)


def _build(models: Path, args: argparse.Namespace) -> None:
    """Builds the chosen presets into the folder `models`. Others that are there stay; the index names all."""
    models.mkdir(parents=True, exist_ok=True)
    work = _BUILT / "quick/work" if args.quick else _BUILT / "work"
    workshop = Workshop(work, QUICK if args.quick else Sizes(), args.threads, args.fresh)
    chosen = _chosen(args.only)
    progress = Progress()
    for preset in chosen:
        progress.expect(_cost(preset))
    for preset in chosen:
        if workshop.is_built(preset):
            progress.skip(preset.name, _cost(preset))
        else:
            with progress.work(preset.name, _cost(preset)):
                workshop.build(preset)
        put(preset, workshop.model_path(preset), models, 8 if args.quick else 1024)
    there = [entry_of(preset, models) for preset in PRESETS]
    files.write_text(models / INDEX_FILE, presets.index_text([e for e in there if e.model.is_file()]))
    files.write_text(models / LICENCE_FILE, _LICENCE)


def _cost(preset: Preset) -> int:
    return _COST[isinstance(preset.made_of, Weave)]


def entry_of(preset: Preset, models: Path) -> presets.Preset:
    return presets.Preset(
        preset.name,
        models / f"{preset.file_name}.velour",
        models / f"{preset.file_name}.png",
        preset.catalog,
        preset.description,
        preset.tags,
        preset.made_of.repeats if isinstance(preset.made_of, Weave) else 0,
    )


def put(preset: Preset, model: Path, models: Path, spp: int) -> None:
    """Copies a built model into the folder of all, with a new preview, unless it is there already."""
    entry = entry_of(preset, models)
    if entry.picture.is_file() and entry.model.is_file() and entry.model.read_bytes() == model.read_bytes():
        return
    pixels = preset_preview.picture(preset, model, spp)
    linear = np.ascontiguousarray(decoded(pixels[..., :3]), np.float32)
    images.write(entry.picture, linear)
    files.write_atomic(entry.model, lambda temporary: shutil.copyfile(model, temporary))


def write_library(models: Path, folder: Path) -> None:
    """Writes the .blend of all presets in `models`, its catalogs and license, unless it is up to date."""
    folder.mkdir(parents=True, exist_ok=True)
    key, kept = _library_key(models), folder / _KEY
    if (folder / LIBRARY_FILE).is_file() and kept.is_file() and kept.read_text() == key:
        return
    task = {"path": str((folder / LIBRARY_FILE).resolve()), "folder": str(models.resolve())}
    task["catalogs"] = CATALOGS
    headless_blender.run("presets_blend.py", task, folder / "blender.log")
    lines = [f"{number}:Velour/{name}:Velour-{name.replace(' ', '-')}" for name, number in CATALOGS.items()]
    files.write_text(folder / CATALOG_FILE, "\n".join(("VERSION 1", "", *lines, "")))
    files.write_text(folder / LICENCE_FILE, _LICENCE)
    files.write_text(kept, key)


def _library_key(models: Path) -> str:
    """Hash of the models and of the code that turns them into materials."""
    digest = hashlib.sha256()
    code = [*(ROOT / "addon/velour").rglob("*.py"), Path(__file__).with_name("presets_blend.py")]
    for path in (*sorted(models.glob("*.*")), *sorted(code)):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


if __name__ == "__main__":
    raise SystemExit(script.guarded("presets", main))
