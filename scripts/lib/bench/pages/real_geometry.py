"""Objects with a tile's geometry beside the same objects with its BTF and the BTF's model: a sheet of
pictures, and errors, seconds and megabytes for docs/engine/btf_models.md."""

from __future__ import annotations

import shutil

import numpy as np
from velour.native import images

from .. import blender, charts, page, provenance
from ..geometry_error import GeometryError, geometry_error
from ..run import Run

SETTINGS = {"texels": (64, 32), "capture_samples": (16, 4), "side": (192, 128), "samples": (256, 32)}
SHOTS = {
    "captured": "plane, a pair that was captured",
    "plane": "plane, sun and sky",
    "cylinder": "cylinder, sun and sky",
}
_WORST = 0.5  # difference, relative to the mean of the geometry's picture, at which the colors saturate
_LABELS = {"btf": "BTF", "model": "model"}


def measure(run: Run) -> dict:
    own, folder = run.settings, run.work / "pictures"
    shutil.rmtree(folder, ignore_errors=True)  # a capture overwrites nothing
    folder.mkdir(parents=True)
    capture = {
        "texels": own.texels,
        "views": 105,
        "lights": 105,
        "samples": own.capture_samples,
        "bounces": 1,
    }
    task = {"tile": "WEAVE", "options": {}, "capture": capture, "megabytes": 0, "side": own.side}
    task |= {"samples": own.samples, "shots": list(SHOTS), "folder": str(folder.resolve())}
    report = blender.run("real_geometry", task, run.work / "blender.log")
    rows, sheet = [], []
    for name, title in SHOTS.items():
        shown = {w: images.read(folder / f"{name}-{w}.exr") for w in ("geometry", *_LABELS)}
        truth, seconds = shown["geometry"], report["shots"][name]["seconds"]
        cells, differences = [(f"{title}\ngeometry, {seconds['geometry']:.1f} s", _display(truth))], []
        for what, label in _LABELS.items():
            error = geometry_error(shown[what], truth)
            rows.append({"shot": name, "what": what, "seconds": seconds[what], **error._asdict()})
            caption = f"{label}, {report[f'{what}_bytes'] / 1e6:.3g} MB, {seconds[what]:.1f} s"
            cells.append((f"{caption}\nerror {error.pixels:.2f}", _display(shown[what])))
            legend = f"{label} - geometry\nred: too bright; full at {_WORST:.0%}"
            differences.append((legend, _difference(shown[what], truth)))
        rows.append({"shot": name, "what": "geometry", "seconds": seconds["geometry"]})
        sheet.append([*cells, *differences])
    charts.sheet(run.output / "images/btf_geometry.png", sheet, (2.0, 2.4))
    report.pop("shots")
    return {"conditions": run.conditions(), "rows": rows, **report}


def _display(picture: np.ndarray) -> np.ndarray:
    return charts.display(picture[..., :3])


def _difference(picture: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """The signed difference of the channels' mean, as colors."""
    difference = (picture - truth)[..., :3].mean(axis=-1) / truth[..., :3][truth[..., 3] > 0.5].mean()
    return charts.colored(difference, "RdBu_r", -_WORST, _WORST)


def write(run: Run, found: dict) -> None:
    print(provenance.sentence(found["conditions"]))
    print(page.filled("capture {capture_seconds:.0f} s, {btf_bytes:M.1f} MB", found))
    print(page.filled("compress {compress_seconds:.1f} s, {model_bytes:M.2f} MB\n", found))
    rows = (dict.fromkeys(GeometryError._fields) | row for row in found["rows"])
    titles = "shot | what | error | of blocks | mean | seconds"
    print(
        page.table(rows, titles, "{shot} | {what} | {pixels:.3f} | {blocks:.3f} | {mean:.3f} | {seconds:.2f}")
    )
