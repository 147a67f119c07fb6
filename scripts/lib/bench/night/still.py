"""A still of `velour render`, split into sample ranges and tiles over the nodes of a farm, and merged."""

from __future__ import annotations

import os
import shlex
import subprocess
import time
from pathlib import Path

import numpy as np
from support import slurm
from velour.core import presets
from velour.native import images

from ..project import ROOT, velour
from .shift import NODES

ROUNDING = 1e-6  # documented: parts by samples equal a single run within rounding; relative to the brightest
_MODEL = "midnight_car_paint.velour"
_SPLIT = 2  # light directions a camera ray
_MIB = 5000  # of a node
_SCRIPT = """\
#!/bin/bash
#SBATCH --array=0-{last} --cpus-per-task=1 --output=%a.txt
parts=({parts})
mkdir -p parts
exec {velour} render {scene} ${{parts[$SLURM_ARRAY_TASK_ID]}} --threads 1 -o parts/$SLURM_ARRAY_TASK_ID.exr
"""


def render(folder: Path, size: tuple[int, int], spp: int, seed: int, threads: int) -> dict:
    """Seconds of both ways, and their largest difference, relative to the brightest value."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = _scene(folder, size, spp, seed)
    parts = _parts(size, spp)
    start = time.monotonic()
    _on_farm(folder, scene, parts)
    files = [folder / f"parts/{number}.exr" for number in range(len(parts))]
    velour("merge", *files, "-o", folder / "merged.exr", "--quiet")
    middle = time.monotonic()
    velour("render", *scene, "--threads", threads, "-o", folder / "whole.exr", "--quiet")
    end = time.monotonic()
    merged, whole = images.read(folder / "merged.exr"), images.read(folder / "whole.exr")
    return {
        "parts": len(parts),
        "seconds_farm": middle - start,
        "seconds_whole": end - middle,
        "difference": float(np.abs(merged - whole).max() / whole.max()),
    }


def _parts(size: tuple[int, int], spp: int) -> list[str]:
    """Options of the elements: two sample ranges of each of two tiles."""
    width, height = size
    half = spp // 2 // _SPLIT * _SPLIT
    samples = (f"0:{half}", f"{half}:{spp}")
    tiles = (f"0:{width // 2},0:{height}", f"{width // 2}:{width},0:{height}")
    return [f"--samples {part} --crop {tile}" for tile in tiles for part in samples]


def _scene(folder: Path, size: tuple[int, int], spp: int, seed: int) -> list[str]:
    """Options of the scene: a wavy sheet of car paint under a gradient with a bright light."""
    (folder / "sheet.obj").write_text(_sheet(48))
    height, width = 64, 128
    sky = np.full((height, width, 3), 0.2, np.float32)
    sky[height // 2 :] = np.linspace(0.3, 1.2, height // 2, dtype=np.float32)[:, None, None]
    sky[48:54, 30:38] = 40
    images.write(folder / "sky.exr", sky)
    found = {"mesh": folder / "sheet.obj", "material": presets.folder() / _MODEL, "world": folder / "sky.exr"}
    found |= {"size": "{}x{}".format(*size), "spp": spp, "split": _SPLIT, "seed": seed, "bounces": 2}
    return [f"--{name}={value}" for name, value in found.items()]


def _sheet(cells: int) -> str:
    """A mesh file of a square with waves, without texture coordinates."""
    side = np.linspace(-1, 1, cells + 1)
    lines = [f"v {x:.6f} {0.1 * np.sin(6 * x) * np.cos(5 * z):.6f} {z:.6f}" for z in side for x in side]
    for row in range(cells):
        for column in range(cells):
            corner = row * (cells + 1) + column + 1
            lines.append(f"f {corner} {corner + cells + 1} {corner + cells + 2} {corner + 1}")
    return "\n".join(["s 1", *lines, ""])


def _on_farm(folder: Path, scene: list[str], parts: list[str]) -> None:
    script = _SCRIPT.format(
        last=len(parts) - 1,
        parts=" ".join(map(shlex.quote, parts)),
        velour=shlex.quote(str(ROOT / "scripts/velour")),
        scene=shlex.join(scene),
    )
    (folder / "still.sh").write_text(script)
    farm = slurm.Slurm(NODES, processors=1, mib=_MIB)
    try:
        command = ["sbatch", "--parsable", "--wait", f"--chdir={folder}", folder / "still.sh"]
        subprocess.run(command, env={**os.environ, **farm.environment}, check=True, stdout=subprocess.DEVNULL)
    finally:
        farm.stop()
