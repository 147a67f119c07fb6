"""The nodes of measured materials in EEVEE beside Cycles, in several versions of Blender.

What differs is EEVEE's light as a rule, so the closures of Blender stand beside.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from .. import blender, charts, flip_metric, project
from ..run import Run, read_rgb
from ..scenes import STUDIO, SUNSET
from . import closures

CSV = "eevee.csv"
SETTINGS = {
    "materials": (99, 1),
    "worlds": ((SUNSET, "potsdamer_platz", STUDIO), (SUNSET,)),
    "versions": (("", "4.3", "5.2"), ("",)),  # of scripts/blenders; empty: the installed one
    "size": (128, 48),
    "samples": (32, 16),
}
PAGES = {"eevee.md": "eevee"}
PLAIN = ("Diffuse", "Glossy")  # closures of Blender, of inside/eevee.py


def measure(run: Run) -> dict:
    models = {}
    for name, measurement in run.materials():
        model, _report = run.fit(measurement, "parametric", tolerance=0.02)
        models[name] = {"model": str(model), "measurement": str(measurement)}
    rows, sheet = [], []
    for version in run.settings.versions:
        folder, said = _pictures(run, version, models)
        for world in run.settings.worlds:
            for name in (*PLAIN, *models):
                eevee, cycles, where = _read(folder / f"{run.world(world).name}-{name}")
                found = closures.differences(cycles, eevee, where)
                rows.append({"blender": said["blender"], "world": world, "material": name, **found})
        sheet.append(_shown(folder, run.world(run.settings.worlds[0]).name, models, said["blender"]))
    charts.sheet(run.output / "images/eevee.png", sheet, (1.3, 1.3))
    return {"conditions": run.conditions(), "rows": rows}


def _pictures(run: Run, version: str, models: dict) -> tuple[Path, dict]:
    own, parameters = run.settings, {"version": version, "models": models, **vars(run.settings)}
    folder = run.stem("eevee", parameters)
    task = {"materials": models, "worlds": [str(run.world(world)) for world in own.worlds]}
    task |= {"folder": str(folder), "size": own.size, "samples": own.samples}

    def make() -> dict:
        folder.mkdir(exist_ok=True)
        if version:
            subprocess.run([project.ROOT / "scripts/package"], check=True)
        log = folder / "blender.log"
        return blender.run("eevee", task, log, ("--addons", "velour"), version or None, screen=True)

    return folder, run.keep(f"pictures of Blender {version}".strip(), "eevee", parameters, make)


def _read(stem: Path):
    """EEVEE's and Cycles' picture, and which pixels show the ball in both."""
    files = [stem.with_name(f"{stem.name}-{kind}.exr") for kind in ("eevee", "cycles")]
    alphas = [closures.covered(file) for file in files]
    return *map(read_rgb, files), alphas[0] & alphas[1]


def _shown(folder: Path, world: str, models: dict, version: str) -> list:
    out = []
    for name in models:
        eevee, cycles, where = _read(folder / f"{world}-{name}")
        scale = flip_metric.exposure(cycles, where)
        out += [
            (f"{name}, EEVEE {version}", charts.display(scale * eevee)),
            ("Cycles", charts.display(scale * cycles)),
        ]
    return out


def values(found: dict) -> dict:
    return {"rows": found["rows"]}
