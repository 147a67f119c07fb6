"""Renders by Mitsuba 3, made by the Python that has it in a separate process, and kept as our own are."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import NamedTuple

from renders import Picture, Renders
from scenes import Scene
from velour_cli import ROOT

PYTHON = ROOT / "build/tools/bin/python"
_PROGRAM = Path(__file__).with_name("mitsuba_render.py")
_VARIANTS = ("llvm_ad_rgb", "scalar_rgb")
_SAMPLER = "multijitter"


class MitsubaError(RuntimeError):
    """Why Mitsuba cannot be compared."""


class Wish(NamedTuple):
    rays: int  # camera rays per pixel
    seed: int  # a timed picture also uses the next seed
    timed: bool


class Mitsuba:
    def __init__(self, renders: Renders, size: tuple[int, int], directions: int):
        """`directions`: light directions per camera ray, half each from the material and the environment."""
        self._renders, self._size, self._directions = renders, size, directions
        self.variant: str | None = None

    def installed(self) -> bool:
        import_it = [PYTHON, "-c", "import mitsuba"]
        return PYTHON.is_file() and subprocess.run(import_it, capture_output=True).returncode == 0

    def choose_variant(self, scene: Scene, rays: int) -> None:
        """Chooses the fastest variant that works here: an LLVM too old for the processor ends the process."""
        seconds = {}
        for variant in _VARIANTS:
            try:
                _, report = self._render(variant, scene, [Wish(rays, 0, True)])
                seconds[variant] = report["seconds"][0]
            except MitsubaError as error:
                print(f"    Mitsuba's {variant}: {error}")
        if not seconds:
            raise MitsubaError("none of its variants works here")
        self.variant = min(seconds, key=seconds.get)

    def cost(self, wishes: list[Wish]) -> float:
        """Cost of the pictures in light directions, for the progress."""
        rays = sum(wish.rays * (2 if wish.timed else 1) for wish in wishes)
        return float(rays * self._directions * self._size[0] * self._size[1])

    def render(self, scene: Scene, wishes: list[Wish]) -> tuple[list[Picture], dict]:
        return self._render(self.variant, scene, wishes)

    def _render(self, variant: str, scene: Scene, wishes: list[Wish]) -> tuple[list[Picture], dict]:
        task = {
            "variant": variant,
            "threads": self._renders.settings.threads,
            "directions": self._directions,
            "sampler": _SAMPLER,
            "size": list(self._size),
            "camera": scene.camera,
            "up": scene.up,
        }
        files = {"mesh": scene.mesh, "world": scene.world, "measurement": scene.material}
        parameters = {**task, **files, "wishes": wishes, "program": _PROGRAM}
        stem = self._renders.stem("mitsuba", parameters)
        outs = [stem.with_name(f"{stem.name}-{k}.exr") for k in range(len(wishes))]
        pictures = [{**wish._asdict(), "out": str(out)} for wish, out in zip(wishes, outs, strict=True)]
        task |= {name: str(path) for name, path in files.items()} | {"pictures": pictures}
        label = f"Mitsuba {variant}, {scene.name}, {', '.join(str(wish.rays) for wish in wishes)} rays"
        cost = self.cost(wishes)
        report = self._renders.keep(label, "mitsuba", parameters, lambda path: self._run(task, path), cost)
        seconds = zip(outs, report["seconds"], strict=True)
        return [Picture(out, {"seconds": taken}) for out, taken in seconds], report

    def _run(self, task: dict, report: Path) -> dict:
        partial = report.with_suffix(".partial")
        log = self._renders.settings.folder / f"mitsuba-{task['variant']}.log"
        with open(log, "w") as file:
            command = [PYTHON, _PROGRAM, json.dumps(task), partial]
            done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT)
        if done.returncode:
            raise MitsubaError(f"it failed with status {done.returncode}; its words are in {log}")
        partial.replace(report)
        return json.loads(report.read_text())
