"""Objects with real geometry beside the same objects with its BTF: pictures, errors, seconds, megabytes."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
import plots
import provenance
from display import display
from geometry_error import GeometryError, geometry_error
from velour.core.machine import threads
from velour.native import VelourError, images

ROOT = Path(__file__).resolve().parents[2]
CAPTURE = {"texels": 64, "views": 105, "lights": 105, "samples": 16, "bounces": 1}
TASK = {"tile": "WEAVE", "options": {}, "capture": CAPTURE, "megabytes": 0, "side": 192, "samples": 256}
QUICK = {**TASK, "capture": {**CAPTURE, "texels": 32, "samples": 4}, "side": 128, "samples": 32}
SHOTS = {
    "captured": "plane, a pair that was captured",
    "plane": "plane, sun and sky",
    "cylinder": "cylinder, sun and sky",
}
_CELL = 2.0  # width of a picture in inches, at 100 dots per inch
_WORST = 0.5  # difference, relative to the mean of the geometry's picture, at which the colors saturate


def main() -> int:
    args = _arguments()
    try:
        shutil.rmtree(args.work, ignore_errors=True)  # a capture overwrites nothing
        args.work.mkdir(parents=True)
        task = {**(QUICK if args.quick else TASK), "shots": list(SHOTS), "folder": str(args.work.resolve())}
        headless_blender.run("real_geometry_scene.py", task, args.work / "blender.log")
    except (VelourError, OSError, headless_blender.BlenderError) as error:
        print(f"real_geometry: {error}", file=sys.stderr)
        return 1
    report = json.loads((args.work / "report.json").read_text())
    _tell(report, _draw(args.output, args.work, report))
    print(args.output)
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="real_geometry")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--work", type=Path, metavar="FOLDER")
    parser.add_argument("--output", type=Path, metavar="FILE")
    args = parser.parse_args()
    args.work = args.work or ROOT / "out" / ("real-geometry-quick" if args.quick else "real-geometry")
    small = args.work / "sheet.png"
    args.output = args.output or (small if args.quick else ROOT / "docs/results/images/btf_geometry.png")
    return args


def _draw(path: Path, folder: Path, report: dict) -> dict[str, dict[str, GeometryError]]:
    """Draws a row per shot: three pictures and two differences. Returns the errors."""
    sheet, axes = plots.sheet(len(SHOTS), 5, (5 * _CELL, len(SHOTS) * (_CELL + 0.4)))
    errors = {}
    for row, (name, title) in zip(axes, SHOTS.items(), strict=True):
        pictures = {w: images.read(folder / f"{name}-{w}.exr") for w in ("geometry", "btf", "model")}
        truth = pictures["geometry"]
        errors[name] = {w: geometry_error(pictures[w], truth) for w in ("btf", "model")}
        seconds = report["shots"][name]["seconds"]
        _show(row[0], truth, f"{title}\ngeometry, {seconds['geometry']:.1f} s")
        for cell, beside, what, label in ((row[1], row[3], "btf", "BTF"), (row[2], row[4], "model", "model")):
            size = report[f"{what}_bytes"] / 1e6
            caption = f"{label}, {size:.3g} MB, {seconds[what]:.1f} s\nerror {errors[name][what].pixels:.2f}"
            _show(cell, pictures[what], caption)
            _show_difference(beside, pictures[what], truth, f"{label} - geometry")
    plots.save(sheet, path, dpi=100)
    return errors


def _show(axes, picture: np.ndarray, title: str) -> None:
    axes.imshow(display(picture[..., :3]), interpolation="none")
    axes.set_title(title, fontsize=8)


def _show_difference(axes, picture: np.ndarray, truth: np.ndarray, title: str) -> None:
    """Shows the signed difference of the channels' mean."""
    difference = (picture - truth)[..., :3].mean(axis=-1) / truth[..., :3][truth[..., 3] > 0.5].mean()
    axes.imshow(difference[::-1], cmap="RdBu_r", vmin=-_WORST, vmax=_WORST, interpolation="none")
    axes.set_title(f"{title}\nred: too bright; full at {_WORST:.0%}", fontsize=8)


def _tell(report: dict, errors: dict[str, dict[str, GeometryError]]) -> None:
    print(provenance.sentence(provenance.conditions(1, threads())))
    print(f"capture  {report['capture_seconds']:.0f} s, {report['btf_bytes'] / 1e6:.1f} MB")
    print(f"compress {report['compress_seconds']:.1f} s, {report['model_bytes'] / 1e6:.2f} MB")
    for name, of_shot in errors.items():
        for what, error in of_shot.items():
            seconds = report["shots"][name]["seconds"]
            print(
                f"{name:9} {what:6} error {error.pixels:.3f}, of blocks {error.blocks:.3f},"
                f" mean {error.mean:.3f}, {seconds[what]:.2f} s (geometry {seconds['geometry']:.2f} s)"
            )


if __name__ == "__main__":
    sys.exit(main())
