"""Moments of one uniform sample of each pixel, by a program that estimates them with importance sampling."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass

import numpy as np
from renders import Renders
from scenes import Scene
from tail_bound import Moments
from velour.core import files
from velour.native import images
from velour_cli import ROOT

_PROGRAM = ROOT / "build/release/native/bench/uniform_moments"


@dataclass(frozen=True)
class Found:
    moments: Moments  # of the luminance: means over independent runs, and the largest sample of all runs
    error: np.ndarray  # relative standard error of the second moments, from the spread of the runs


def built() -> bool:
    return _PROGRAM.is_file()


def of(scene: Scene, renders: Renders, size: tuple[int, int], rays: int, seeds: range) -> Found:
    """One run per seed, with `rays` camera rays per pixel. `scene` must have the default camera."""
    runs = np.array([_run(scene, renders, size, rays, seed) for seed in seeds], np.float64)
    mean, second, third = (runs[..., k].mean(axis=0) for k in range(3))
    error = runs[..., 1].std(axis=0, ddof=1) / len(runs) ** 0.5 / np.maximum(second, 1e-300)
    return Found(Moments(mean, second, third, runs[..., 3].max(axis=0)), error)


def _run(scene: Scene, renders: Renders, size: tuple[int, int], rays: int, seed: int) -> np.ndarray:
    names = ("mesh", "material", "proposal", "world")
    parameters = {name: getattr(scene, name) for name in names if getattr(scene, name) is not None}
    parameters |= {"size": "{}x{}".format(*size), "rays": rays, "seed": seed}
    known = {**parameters, "program": _PROGRAM}
    out = renders.stem("moments", known).with_suffix(".exr")
    words = {**parameters, "threads": renders.settings.threads, "output": out}
    command = [_PROGRAM, *(str(part) for name, value in words.items() for part in (f"--{name}", value))]

    def run(report) -> dict:
        subprocess.run(command, check=True)
        files.write_json(report, {"rays": rays})
        return {}

    renders.keep(f"{scene.name}, moments of uniform samples, {rays} rays", "moments", known, run)
    return images.read(out)
