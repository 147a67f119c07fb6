"""The demo's scene with few samples, the same denoised by the compositor's Denoise node with Velour's two
passes, and with many samples: docs/guide/images/denoise.png, and their errors.

Uses the module bpy of Blender 4.5 (scripts/blenders), because Debian's Blenders have no OpenImageDenoise.
"""

from __future__ import annotations

import numpy as np
from velour.native import images

from .. import blender, charts
from ..run import Run, read_rgb
from ..velour_cli import ROOT

SETTINGS = {"size": ((320, 240), (80, 60)), "few": (16, 4), "many": (4096, 64)}


def measure(run: Run) -> dict:
    own, folder = run.settings, run.work
    task = {"size": own.size, "few": own.few, "many": own.many, "folder": str(folder)}
    blender.run("denoise", task, folder / "blender.log")
    shown = {name: read_rgb(folder / f"{name}.exr") for name in ("few", "without", "denoised", "many")}
    if np.array_equal(shown["few"], shown["denoised"]):
        raise blender.BlenderError("this Blender has no OpenImageDenoise")
    titles = {"few": f"{own.few} samples", "denoised": "the same, denoised", "many": f"{own.many} samples"}
    whole = [(title, charts.display(shown[name])) for name, title in titles.items()]
    # Rows and columns around an eye.
    height, width = whole[0][1].shape[:2]
    detail = slice(2 * height // 5, 11 * height // 15), slice(31 * width // 80, 231 * width // 320)
    output = run.output / "images" if own.few < 16 else ROOT / "docs/guide/images"
    charts.sheet(
        output / "denoise.png", [whole, [("", p[detail]) for _, p in whole]], (2.3, 1.84), few_colors=True
    )
    print(output / "denoise.png")
    # Root of the library's relmse: the relative error, in dark parts relative to a tenth of the mean.
    errors = {n: images.compare(shown[n], shown["many"])[1] ** 0.5 for n in ("few", "without", "denoised")}
    return {"conditions": run.conditions(), "errors": errors}


def write(run: Run, found: dict) -> None:
    for name, error in found["errors"].items():
        print(f"{name}: {error:.4f}")
