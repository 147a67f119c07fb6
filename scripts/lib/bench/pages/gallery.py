"""Pictures of presets for README and docs/results/gallery.md, in Blender, with their times."""

from __future__ import annotations

import shutil

from .. import blender
from ..run import Run

SCENES = {
    "metals": "Metals, paints and porcelain on sculptures",
    "cloths": "Denim, velvet and knitted wool, draped, with silhouettes of their yarns",
    "product": "Enamel worn to the metal, by nodes that mix two measured materials",
}
SETTINGS = {
    "size": ((1600, 900), (320, 180)),
    "samples": (1024, 64),  # maximum number of light directions per pixel
    "noise": (0.012, 0.1),
}
PAGES = {"gallery.md": "gallery"}


def measure(run: Run) -> dict:
    run.progress.expect(1, len(SCENES))
    return {"conditions": run.conditions(), "rows": [_row(run, name) for name in SCENES]}


def _row(run: Run, name: str) -> dict:
    """Renders a scene, unless its picture is kept, and copies the picture beside the page."""
    settings = {"scene": name, **vars(run.settings)}
    parameters = settings | {"program": blender.INSIDE / "gallery.py"}
    stem = run.stem(name, parameters)
    task, options = settings | {"folder": str(stem.parent), "name": stem.name}, ("-t", str(run.threads))
    make = lambda: blender.run("gallery", task, stem.with_suffix(".log"), options)  # noqa: E731
    report = run.keep(name, name, parameters, make, 1)
    (run.output / "images").mkdir(parents=True, exist_ok=True)
    shutil.copy(stem.with_suffix(".png"), run.output / f"images/gallery_{name}.png")
    return {"scene": name, "seconds": report["seconds"], "directions": report["spp"]}


def values(found: dict) -> dict:
    return {"rows": [row | {"about": SCENES[row["scene"]]} for row in found["rows"]]}
