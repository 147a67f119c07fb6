"""scripts/presets, after staging: models, previews and the .blend of the presets."""

from __future__ import annotations

import argparse
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
from velour.core import files
from velour.core.machine import threads
from velour.core.presets import CATALOG_FILE, LIBRARY_FILE, LICENCE_FILE, MOST_BYTES
from velour.native import images
from velour_cli import ROOT

_BUILT = ROOT / "build/presets"
_PICTURE = ROOT / "docs/results/images/presets.png"
_COST = {True: 10, False: 1}  # relative time of a cloth and of other presets, for the progress
_COLUMNS = 6  # columns of the sheet of all previews
_LICENCE = """The materials of this folder are in the public domain: CC0-1.0,
https://creativecommons.org/publicdomain/zero/1.0/
"""


def main() -> int:
    args = _arguments()
    output = args.output or (_BUILT / "quick" if args.quick else _BUILT)
    chosen = _chosen(args.only)
    workshop = Workshop(output / "work", QUICK if args.quick else Sizes(), args.threads, args.fresh)
    _build(workshop, chosen)
    built = [preset for preset in PRESETS if workshop.report_of(preset)]
    previews = {preset: _preview(workshop, preset, 8 if args.quick else 1024, args.fresh) for preset in built}
    sheet = _sheet(list(previews.values()))
    images.write(output / "work/sheet.png", sheet)
    if args.docs:
        presets_sheet.draw(_PICTURE, {preset.name: np.load(path) for preset, path in previews.items()})
    write_library(output, workshop, previews)
    size = sum((output / name).stat().st_size for name in (LIBRARY_FILE, CATALOG_FILE, LICENCE_FILE))
    print(f"{output / LIBRARY_FILE}: {len(built)} of {len(PRESETS)} presets, {size / 1e6:.2f} MB in all")
    print(f"{output / 'work/sheet.png'}: their previews")
    if size > MOST_BYTES:
        print(f"presets: that is more than {MOST_BYTES / 1e6:.0f} MB", file=sys.stderr)
        return 1
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="presets")
    parser.add_argument("--only", metavar="NAME[,NAME...]", default="", help="builds no others")
    parser.add_argument("--quick", action="store_true", help="small and coarse, to try the script")
    parser.add_argument("--fresh", action="store_true", help="builds anew what is kept")
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


def _build(workshop: Workshop, chosen: list[Preset]) -> None:
    progress = Progress()
    for preset in chosen:
        progress.expect(_COST[isinstance(preset.made_of, Weave)])
    for preset in chosen:
        cost = _COST[isinstance(preset.made_of, Weave)]
        if workshop.is_built(preset):
            progress.skip(preset.name, cost)
            continue
        with progress.work(preset.name, cost):
            workshop.build(preset)


def _preview(workshop: Workshop, preset: Preset, spp: int, fresh: bool) -> Path:
    """Returns the preview's file, kept beside the model that it shows."""
    model = workshop.model_path(preset)
    path = model.with_suffix(".npy")
    if fresh or not path.is_file() or path.stat().st_mtime < model.stat().st_mtime:
        pixels = preset_preview.picture(preset, model, spp)
        files.write_atomic(path, lambda temporary: np.save(temporary, pixels))
    return path


def _sheet(previews: list[Path]) -> np.ndarray:
    """All previews, row by row from the top, in the order of the table: linear RGB, row 0 at the bottom."""
    side = preset_preview.SIDE
    rows = -(-len(previews) // _COLUMNS)
    sheet = np.zeros((rows * side, _COLUMNS * side, 3), np.float32)
    for number, preview in enumerate(previews):
        bottom = (rows - 1 - number // _COLUMNS) * side
        left = number % _COLUMNS * side
        sheet[bottom : bottom + side, left : left + side] = _linear(np.load(preview)[..., :3])
    return sheet


def _linear(encoded: np.ndarray) -> np.ndarray:
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def write_library(folder: Path, workshop: Workshop, previews: dict[Preset, Path]) -> None:
    """Writes the .blend of the presets in `previews`, its catalogs and license."""
    presets = [
        {
            "name": preset.name,
            "model": str(workshop.model_path(preset).resolve()),
            "preview": str(preview.resolve()),
            "catalog": CATALOGS[preset.catalog],
            "description": preset.description,
            "tags": [*preset.tags, "velour"],
            "repeats": preset.made_of.repeats if isinstance(preset.made_of, Weave) else 0,
        }
        for preset, preview in previews.items()
    ]
    task = {"path": str((folder / LIBRARY_FILE).resolve()), "presets": presets}
    headless_blender.run("presets_blend.py", task, workshop.work / "blender.log")
    lines = [f"{number}:Velour/{name}:Velour-{name.replace(' ', '-')}" for name, number in CATALOGS.items()]
    files.write_text(folder / CATALOG_FILE, "\n".join(("VERSION 1", "", *lines, "")))
    files.write_text(folder / LICENCE_FILE, _LICENCE)


if __name__ == "__main__":
    raise SystemExit(script.guarded("presets", main))
