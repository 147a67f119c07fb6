"""Processor time of Cycles and Velour at the same noise, in one run. Nothing else should run meanwhile.

--only renders some of the scenes, --blender in a version of scripts/blenders with the packaged add-on; their
page stays in build/equal_noise.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter
from velour.core.luminance import LUMINANCE

from .. import blender, charts, project
from ..run import Run, read_rgb

SCENES = ("floor of 9 m", "floor of 20 m", "floor of 200 m", "room", "hundred lamps", "metals", "corridor")
SCENES += ("signs", "copper", "clamped copper")  # of inside/equal_noise.py
ENGINES = {"cycles": "CYCLES", "velour": "VELOUR"}
# Both take about the same time; noise falls with time in the same way for both.
SETTINGS = {
    "size": ((320, 180), (96, 54)),
    "seeds": (4, 2),
    "cycles": (64, 16),  # samples per pixel: each one direction of the material and one of the light
    "velour": (256, 64),  # light directions per pixel
    "only": (SCENES, SCENES),
    "blender": ("", ""),
}
PAGES = {"equal_noise.md": "equal_noise"}
DENOISED_TO = 0.01  # relmse
_FIREFLY = 0.25  # luminance above the median of 3 x 3 pixels that makes a firefly


def measure(run: Run) -> dict:
    own, rows, sheet = run.settings, [], ([], [])
    unknown = set(own.only) - set(SCENES)
    if unknown:
        raise SystemExit(f"There is no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}.")
    if own.blender or len(own.only) < len(SCENES):
        run.output = run.work / "part"  # it must not replace the page
    load, version = project.busy_threads(), ""
    for name in own.only:
        row, pictures, version = _compared(run, name)
        print(f"{name}: {_ratio(row):.2f} of Cycles' time to equal noise", flush=True)
        rows.append(row)
        for line, (engine, picture) in zip(sheet, pictures.items(), strict=True):
            line.append((f"{name}, {engine}", charts.display(picture)))
    charts.sheet(run.output / "images/equal_noise.png", sheet, (2.2, 1.37), few_colors=True)
    return {"conditions": run.conditions(load=load, blender=version, seed=0), "rows": rows}


def _compared(run: Run, name: str) -> tuple[dict, dict[str, np.ndarray], str]:
    """The row of a scene, the mean pictures by engine, and the version of Blender."""
    own, folder = run.settings, run.work / name.replace(" ", "-")
    folder.mkdir(parents=True, exist_ok=True)
    samples = {engine: getattr(own, name) for name, engine in ENGINES.items()}
    task = {"scene": name, "size": own.size, "seeds": own.seeds, "samples": samples}
    task |= {"folder": str(folder), "relmse": DENOISED_TO}
    options = ("-t", str(run.threads))
    said = blender.run("equal_noise", task, folder / "blender.log", options, version=own.blender or None)
    row, means = {"scene": name, "denoised": min(said["denoised"], default=None)}, {}
    for side, engine in ENGINES.items():
        files = [folder / f"{engine}{seed}.exr" for seed in range(own.seeds)]
        row[side], means[side.capitalize()] = _side(files, said["seconds"][engine])
    return row, means, said["blender"]


def _side(files: list[Path], seconds: list[float]) -> tuple[dict, np.ndarray]:
    """Processor seconds and noise (relmse, from the spread of the seeds) of one render, mean light,
    fireflies; and the mean picture of all seeds."""
    pictures = np.stack([read_rgb(file).astype(np.float64) for file in files])
    mean, variance = pictures.mean(0), pictures.var(0, ddof=1)
    noise = float((variance / (mean**2 + 0.01 * mean.mean() ** 2)).mean())
    row = {"seconds": min(seconds), "noise": noise, "light": float(mean.mean())}
    return row | {"fireflies": _fireflies(pictures, mean)}, mean


def _fireflies(pictures: np.ndarray, mean: np.ndarray) -> float:
    """Mean number of pixels of a render that are far brighter than their neighbors while the mean is not."""

    def stand_out(picture: np.ndarray) -> np.ndarray:
        luminance = picture @ LUMINANCE
        return luminance - median_filter(luminance, 3) > _FIREFLY

    own = stand_out(mean)
    return float(np.mean([np.count_nonzero(stand_out(picture) & ~own) for picture in pictures]))


def _cost(side: dict) -> float:
    """Seconds to a relmse of 1: noise falls with the inverse of time."""
    return side["seconds"] * side["noise"]


def _ratio(row: dict) -> float:
    return _cost(row["velour"]) / _cost(row["cycles"])


def values(found: dict) -> dict:
    rows = found["rows"]
    for row in rows:
        # Both should render the same picture.
        row |= {"ratio": _ratio(row), "apart": 100 * (row["velour"]["light"] / row["cycles"]["light"] - 1)}
        if row["denoised"]:
            row["without"] = _cost(row["velour"]) / DENOISED_TO
            row["times"] = row["without"] / row["denoised"]
    denoised = {"denoised": rows, "relmse": DENOISED_TO, "noise": DENOISED_TO**0.5}
    parts = [denoised] if all(row["denoised"] for row in rows) else []
    return {"rows": rows, "firefly": _FIREFLY, "denoised": parts}
