"""Mitsuba 3's `measured` material beside ours: the same mesh, camera, environment and measurement."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np

from . import data_files
from .reference import FIRST_SEED, Batches, Reference, points, silhouette
from .run import Picture, Run
from .scenes import BUNNY_CAMERA, SUNSET, Scene, made, write_sphere
from .velour_cli import ROOT

MATERIALS = ("satin_rosaline_rgb", "paper_white_rgb", "cc_iris_purple_gem_rgb")
STRATEGIES = ("mis", "product")
DIRECTIONS = 8  # light directions per camera ray, in both programs
_REFERENCES = 4
_CAMERAS = {"bunny": BUNNY_CAMERA, "sphere": "0,-4,0,0,0,0,40"}
_PYTHON, _PROGRAM = ROOT / "build/tools/bin/python", Path(__file__).with_name("mitsuba_render.py")
_VARIANTS = ("llvm_ad_rgb", "scalar_rgb")


class MitsubaError(RuntimeError):
    """Why Mitsuba cannot be compared."""


class Wish(NamedTuple):
    rays: int  # camera rays per pixel
    seed: int  # a timed picture also uses the next seed
    timed: bool


class Mitsuba:
    """Renders by Mitsuba, made by the Python that has it in a separate process, and kept as our own are."""

    def __init__(self, run: Run, size: tuple[int, int]):
        self._run, self._size = run, size
        self.variant = ""

    @staticmethod
    def installed() -> bool:
        import_it = [_PYTHON, "-c", "import mitsuba"]
        return _PYTHON.is_file() and subprocess.run(import_it, capture_output=True).returncode == 0

    def choose_variant(self, scene: Scene, rays: int) -> None:
        """Chooses the fastest variant that works here: an LLVM too old for the processor ends the process."""
        seconds = {}
        for self.variant in _VARIANTS:
            try:
                seconds[self.variant] = self.render(scene, [Wish(rays, 0, True)])[0][0].seconds
            except MitsubaError as error:
                print(f"    Mitsuba's {self.variant}: {error}")
        if not seconds:
            raise MitsubaError("none of its variants works here")
        self.variant = min(seconds, key=seconds.get)

    def cost(self, wishes: list[Wish]) -> float:
        """Cost of the pictures in light directions, for the progress."""
        rays = sum(wish.rays * (2 if wish.timed else 1) for wish in wishes)
        return float(rays * DIRECTIONS * self._size[0] * self._size[1])

    def render(self, scene: Scene, wishes: list[Wish]) -> tuple[list[Picture], dict]:
        """The pictures, and the report with Mitsuba's version."""
        task = {"variant": self.variant, "threads": self._run.threads, "directions": DIRECTIONS}
        task |= {"sampler": "multijitter", "size": list(self._size), "camera": scene.camera, "up": scene.up}
        files = {"mesh": scene.mesh, "world": scene.world, "measurement": scene.material}
        parameters = {**task, **files, "wishes": wishes, "program": _PROGRAM}
        stem = self._run.stem("mitsuba", parameters)
        outs = [stem.with_name(f"{stem.name}-{k}.exr") for k in range(len(wishes))]
        pictures = [{**wish._asdict(), "out": str(out)} for wish, out in zip(wishes, outs, strict=True)]
        task |= {name: str(path) for name, path in files.items()} | {"pictures": pictures}
        label = f"Mitsuba {self.variant}, {scene.name}, {', '.join(str(wish.rays) for wish in wishes)} rays"
        make = lambda: self._make(task, stem.with_suffix(".partial"))  # noqa: E731
        report = self._run.keep(label, "mitsuba", parameters, make, self.cost(wishes))
        taken = zip(outs, report["seconds"], strict=True)
        return [Picture(out, {"seconds": seconds}) for out, seconds in taken], report

    def _make(self, task: dict, report: Path) -> dict:
        log = self._run.kept / f"mitsuba-{self.variant}.log"
        with open(log, "w") as file:
            command = [_PYTHON, _PROGRAM, json.dumps(task), report]
            done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT)
        if done.returncode:
            raise MitsubaError(f"it failed with status {done.returncode}; its words are in {log}")
        found = json.loads(report.read_text())
        report.unlink()
        return found


def compare(run: Run) -> dict | str:
    """Points of Mitsuba's and our curves on the bunny, and the differences of converged pictures of the
    sphere, per material; a sentence if that is impossible.

    `run.settings`: peer_materials, peer_size, peer_rays (camera rays per pixel) and peer_reference_rays.
    """
    own, theirs = run.settings, Mitsuba(run, run.settings.peer_size)
    if not theirs.installed():
        return "Mitsuba is left out: it is not installed and could not be had from PyPI (build/peers.log)."
    ladder = [Wish(rays, run.seed, True) for rays in own.peer_rays]
    converged = [Wish(own.peer_reference_rays, FIRST_SEED + k, False) for k in range(_REFERENCES)]
    materials = MATERIALS[: own.peer_materials]
    for _ in materials:
        for wishes in (ladder, converged, converged):
            run.progress.expect(theirs.cost(wishes))
        run.expect(DIRECTIONS * own.peer_reference_rays, own.peer_size, 2 * _REFERENCES)
        for rays in own.peer_rays:
            run.expect(DIRECTIONS * rays, own.peer_size, len(STRATEGIES))
    found = {"rows": [], "spheres": []}
    try:
        theirs.choose_variant(_scene(run, "bunny", materials[0]), own.peer_rays[-1])
        for material in materials:
            bunny, sphere = (_scene(run, name, material) for name in _CAMERAS)
            pictures, report = theirs.render(bunny, ladder)
            found |= {"version": report["version"], "variant": report["variant"]}
            reference = Batches(theirs.render(bunny, converged)[0])
            found["rows"] += _points(run, pictures, reference, material, "mitsuba")
            ours = _reference(run, bunny)
            for strategy in STRATEGIES:
                renders = [_ours(run, bunny, rays, strategy) for rays in own.peer_rays]
                found["rows"] += _points(run, renders, ours, material, strategy)
            both = _reference(run, sphere), Batches(theirs.render(sphere, converged)[0])
            where = silhouette(run, sphere, own.peer_size)
            found["spheres"].append({"material": material, **_difference(*both, where)})
    except MitsubaError as error:
        return f"Mitsuba is left out: {error}."
    return found


def _scene(run: Run, name: str, material: str) -> Scene:
    """The scene in reference mode: Velour evaluates the raw measurement."""
    measurement, data = run.data / f"brdf/{material}.bsdf", run.data
    model, _ = run.fit(measurement, max_lobes=16)
    mesh, up = data_files.mesh(data, "bunny"), "y"
    if name == "sphere":
        mesh, up = made(run.kept / "sphere.obj", write_sphere), "z"
    world = data_files.world(data, SUNSET)
    return Scene(f"{name}, {material}", mesh, up, world, measurement, model, _CAMERAS[name])


def _ours(run: Run, scene: Scene, rays: int, strategy: str) -> Picture:
    return run.render(
        scene, DIRECTIONS * rays, size=run.settings.peer_size, split=DIRECTIONS, strategy=strategy
    )


def _reference(run: Run, scene: Scene) -> Reference:
    options = {"size": run.settings.peer_size, "split": DIRECTIONS, "strategy": "product"}
    spp = DIRECTIONS * run.settings.peer_reference_rays
    return Reference(run, scene, spp, **options).add(_REFERENCES)


def _points(run: Run, pictures: list[Picture], reference: Batches, material: str, curve: str) -> list[dict]:
    about = {"scene": material, "curve": curve, "seed": run.seed}
    spp = ({**about, "spp": DIRECTIONS * rays} for rays in run.settings.peer_rays)
    return points(list(zip(pictures, spp, strict=True)), reference)


def _difference(ours: Batches, theirs: Batches, where: np.ndarray) -> dict:
    """Over the pixels that show the object: the ratio of the means, Mitsuba's over ours; the sum of the
    absolute differences over the sum of our picture, and what the noise of both alone would make of that."""
    a, b = (batches.mean()[where].astype(np.float64) for batches in (ours, theirs))
    # For a normal x, the mean of |x| is sqrt(2 / pi) times its standard deviation.
    deviation = np.hypot(ours.standard_error(), theirs.standard_error())[where]
    noise = np.sqrt(2 / np.pi) * deviation.sum() / a.sum()
    return {"means": b.sum() / a.sum(), "relative": np.abs(a - b).sum() / a.sum(), "noise": noise}
