"""Processor time of Cycles and Velour at the same noise, in one run: docs/results/equal_noise.md."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
import markdown_table
import palette
import plots
import provenance
from display import display
from velour.core.luminance import LUMINANCE
from velour.native import images
from velour_cli import ROOT

WORK = ROOT / "build/equal-noise"
SCENES = (
    "floor of 9 m",
    "floor of 20 m",
    "floor of 200 m",
    "room",
    "hundred lamps",
    "metals",
    "corridor",
    "signs",
    "copper",
    "clamped copper",
)  # names in equal_noise_scenes.py
THREADS = 2
_CELL = 2.2  # width of a picture in inches
DENOISED_TO = 0.01  # relmse
_FIREFLY = 0.25  # luminance above the median of 3 x 3 pixels that makes a firefly


@dataclass(frozen=True)
class Effort:
    size: tuple[int, int]
    seeds: int
    cycles: int  # samples per pixel: each one direction of the material and one of the light
    velour: int  # light directions per pixel


# Both take about the same time; noise falls with time in the same way for both.
WHOLE = Effort((320, 180), 4, 64, 256)
QUICK = Effort((96, 54), 2, 16, 64)


@dataclass(frozen=True)
class Side:
    seconds: float  # processor time of one render
    noise: float  # relmse of one render, from the spread of the seeds
    mean: np.ndarray  # mean picture of all seeds
    fireflies: float  # mean number per render
    denoised: float | None = None  # seconds to a denoised picture of DENOISED_TO; None: no denoiser

    @property
    def cost(self) -> float:
        """Seconds to a relmse of 1: noise falls with the inverse of time."""
        return self.seconds * self.noise


def main() -> int:
    parser = argparse.ArgumentParser(prog="equal_noise")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", metavar="SCENE,...", type=lambda text: text.split(","))
    parser.add_argument("--blender", metavar="VERSION")
    arguments = parser.parse_args()
    unknown = set(arguments.only or ()) - set(SCENES)
    if unknown:
        parser.error(f"There is no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}.")
    effort = QUICK if arguments.quick else WHOLE
    conditions = provenance.conditions(0, THREADS)
    load = provenance.busy_threads()
    results, version = {}, ""
    for name in arguments.only or SCENES:
        results[name], version = _measure(name, effort, arguments.blender)
        print(_line(name, *results[name]), flush=True)
    page = _page(results, version, effort, conditions, load)
    if arguments.only or arguments.blender:
        print(page)
        return 0
    folder = WORK if arguments.quick else ROOT / "docs/results"
    (folder / "equal_noise.md").write_text(page, encoding="utf-8")
    _draw((WORK if arguments.quick else ROOT / "docs/results/images") / "equal_noise.png", results)
    print(folder / "equal_noise.md")
    return 0


def _measure(name: str, effort: Effort, blender: str | None) -> tuple[tuple[Side, Side], str]:
    """Cycles' side, Velour's side, and the version of Blender."""
    folder = WORK / name.replace(" ", "-")
    folder.mkdir(parents=True, exist_ok=True)
    report = folder / "report.json"
    task = {
        "scene": name,
        "size": effort.size,
        "seeds": effort.seeds,
        "samples": {"CYCLES": effort.cycles, "VELOUR": effort.velour},
        "folder": str(folder),
        "report": str(report),
        "relmse": DENOISED_TO,
    }
    _run(task, folder / "blender.log", blender)
    said = json.loads(report.read_text(encoding="utf-8"))
    cycles, velour = (_side(folder, engine, said["seconds"][engine]) for engine in ("CYCLES", "VELOUR"))
    denoised = min(said["denoised"], default=None)
    return (cycles, replace(velour, denoised=denoised)), said["blender"]


def _run(task: dict, log: Path, blender: str | None) -> None:
    threads = ["-t", str(THREADS)]
    if blender is None:
        return headless_blender.run("equal_noise_scenes.py", task, log, threads)
    script = str(Path(__file__).with_name("equal_noise_scenes.py"))
    stage = ROOT / "build/package/blender"
    command = [
        ROOT / "scripts/blenders",
        "--run",
        blender,
        "env",
        f"BLENDER_USER_SCRIPTS={stage}",
        "blender",
        "-b",
    ]
    command += ["--factory-startup", "-noaudio", "--python-exit-code", "7", *threads, "--python", script]
    with open(log, "w", encoding="utf-8") as file:
        subprocess.run([*command, "--", json.dumps(task)], stdout=file, stderr=file, check=True)
    return None


def _side(folder: Path, engine: str, seconds: list[float]) -> Side:
    pictures = np.stack(
        [
            images.read(folder / f"{engine}{seed}.exr")[..., :3].astype(np.float64)
            for seed in range(len(seconds))
        ]
    )
    mean, variance = pictures.mean(0), pictures.var(0, ddof=1)
    noise = (variance / (mean**2 + 0.01 * mean.mean() ** 2)).mean()
    return Side(min(seconds), float(noise), mean, _fireflies(pictures, mean))


def _fireflies(pictures: np.ndarray, mean: np.ndarray) -> float:
    """Mean number of pixels of a render that are far brighter than their neighbors while the mean is not."""

    def stand_out(picture: np.ndarray) -> np.ndarray:
        luminance = picture @ LUMINANCE
        return luminance - median_filter(luminance, 3) > _FIREFLY

    own = stand_out(mean)
    return float(np.mean([np.count_nonzero(stand_out(picture) & ~own) for picture in pictures]))


def _ratio(cycles: Side, velour: Side) -> float:
    return velour.cost / cycles.cost


def _apart(cycles: Side, velour: Side) -> float:
    """Relative difference of the mean radiance: both should render the same picture."""
    return float(velour.mean.mean() / cycles.mean.mean() - 1)


def _line(name: str, cycles: Side, velour: Side) -> str:
    return f"{name}: {_ratio(cycles, velour):.2f} of Cycles' time to equal noise"


def _page(results: dict, version: str, effort: Effort, conditions: dict, load: float) -> str:
    header = ["scene", "Cycles: s", "relmse", "Velour: s", "relmse", "time to equal noise", "mean light"]
    header += ["fireflies: Cycles", "Velour"]
    rows = [
        [
            name,
            f"{cycles.seconds:.1f}",
            markdown_table.small(cycles.noise),
            f"{velour.seconds:.1f}",
            markdown_table.small(velour.noise),
            f"{_ratio(cycles, velour):.2f}",
            f"{100 * _apart(cycles, velour):+.1f} %",
            f"{cycles.fireflies:.0f}",
            f"{velour.fireflies:.0f}",
        ]
        for name, (cycles, velour) in results.items()
    ]
    width, height = effort.size
    return f"""# Equal noise: Velour beside Cycles

Written by `scripts/equal_noise`. {provenance.sentence(conditions)}
Blender {version}; other programs kept {load:.2f} processors busy before.

Scenes of Principled and diffuse materials, built by `scripts/lib/equal_noise_scenes.py`,
{width} x {height} pixels, four bounces, without clamping, adaptive sampling and denoising, with a filter
of one pixel. Both engines render in the same Blender, {effort.seeds} seeds each: Cycles
{effort.cycles} samples a pixel, Velour {effort.velour} light directions with its default settings.
Seconds are processor time of the fastest render, with export and hierarchies; relmse is that of one
render, from the spread of the seeds. *Time to equal noise* is Velour's seconds times relmse over Cycles'.
*Mean light* is how much brighter Velour's picture is. *Fireflies*: pixels of one render more than
{_FIREFLY} above the median of their 3 x 3 neighbors, where the mean of all seeds is not; *clamped*:
indirect light, at 10.

{markdown_table.table(header, rows)}
{_denoised(results)}![Each scene by Cycles and by Velour](images/equal_noise.png)
"""


def _denoised(results: dict) -> str:
    header = ["scene", "s", "without: s", "times less"]
    rows = []
    for name, (_, velour) in results.items():
        if velour.denoised is None:
            return ""
        without = velour.cost / DENOISED_TO
        rows.append([name, f"{velour.denoised:.1f}", f"{without:.1f}", f"{without / velour.denoised:.1f}"])
    return f"""Processor time until the denoised picture's relmse is certain to be at most {DENOISED_TO}
(*Denoise*, *Noise Threshold* {DENOISED_TO**0.5:g}), and what the picture without it takes to that relmse:

{markdown_table.table(header, rows)}
"""


def _draw(path: Path, results: dict) -> None:
    figure, axes = plots.sheet(2, len(results), (_CELL * len(results), 2 * _CELL * 0.62))
    for column, (name, sides) in enumerate(results.items()):
        for row, (engine, side) in enumerate(zip(("Cycles", "Velour"), sides, strict=True)):
            axis = axes[row, column]
            axis.imshow(display(side.mean.astype(np.float32)), interpolation="nearest")
            axis.set_axis_off()
            axis.set_title(f"{name}, {engine}", fontsize=7)
    palette.save(figure, path)


if __name__ == "__main__":
    sys.exit(main())
