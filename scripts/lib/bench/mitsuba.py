"""Mitsuba 3's `measured` material beside ours: the same mesh, camera, environment and measurement."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np

from . import project
from .reference import FIRST_SEED, Batches, Reference, points, silhouette
from .run import Picture, Run
from .scenes import BUNNY_CAMERA, SUNSET, Scene, write_sphere

MATERIALS = ("satin_rosaline_rgb", "paper_white_rgb", "cc_iris_purple_gem_rgb")
STRATEGIES = ("mis", "product")
DIRECTIONS = 8  # light directions per camera ray, in both programs
_REFERENCES = 4
_CAMERAS = {"bunny": BUNNY_CAMERA, "sphere": "0,-4,0,0,0,0,40"}
_PYTHON, _PROGRAM = project.ROOT / "build/tools/bin/python", Path(__file__).with_name("mitsuba_render.py")
_VARIANTS = ("llvm_ad_rgb", "scalar_rgb")


class MitsubaError(RuntimeError):
    """Why Mitsuba cannot be compared."""


class Wish(NamedTuple):
    rays: int  # camera rays per pixel
    seed: int  # a timed picture also uses the next seed
    timed: bool


def installed() -> bool:
    import_it = [_PYTHON, "-c", "import mitsuba"]
    return _PYTHON.is_file() and subprocess.run(import_it, capture_output=True).returncode == 0


def compare(run: Run) -> dict | str:
    """Points of Mitsuba's and our curves on the bunny, and the differences of converged pictures of the
    sphere, per material; a sentence if that is impossible.

    `run.settings`: peer_materials, peer_size, peer_rays (camera rays per pixel) and peer_reference_rays.
    """
    own = run.settings
    if not installed():
        return "Mitsuba is left out: it is not installed and could not be had from PyPI (build/peers.log)."
    ladder = [Wish(rays, run.seed, True) for rays in own.peer_rays]
    converged = [Wish(own.peer_reference_rays, FIRST_SEED + k, False) for k in range(_REFERENCES)]
    materials, spp = MATERIALS[: own.peer_materials], [DIRECTIONS * rays for rays in own.peer_rays]
    for _ in materials:
        for wishes in (ladder, converged, converged):
            run.progress.expect(_cost(run, wishes))
        run.expect(DIRECTIONS * own.peer_reference_rays, own.peer_size, 2 * _REFERENCES)
        for count in spp:
            run.expect(count, own.peer_size, len(STRATEGIES))
    found = {"rows": [], "spheres": []}
    try:
        variant = _fastest(run, _scene(run, "bunny", materials[0]), own.peer_rays[-1])
        for material in materials:
            bunny, sphere = (_scene(run, name, material) for name in _CAMERAS)
            pictures, report = _render(run, variant, bunny, ladder)
            found |= {"version": report["version"], "variant": report["variant"]}
            curves = {"mitsuba": (pictures, Batches(_render(run, variant, bunny, converged)[0]))}
            ours, how = _reference(run, bunny), {"size": own.peer_size, "split": DIRECTIONS}
            for strategy in STRATEGIES:
                curves[strategy] = [run.render(bunny, n, strategy=strategy, **how) for n in spp], ours
            for curve, (rendered, reference) in curves.items():
                about = {"scene": material, "curve": curve, "seed": run.seed}
                found["rows"] += points(
                    [(p, {**about, "spp": n}) for p, n in zip(rendered, spp, strict=True)], reference
                )
            both = _reference(run, sphere), Batches(_render(run, variant, sphere, converged)[0])
            where = silhouette(run, sphere, own.peer_size)
            found["spheres"].append({"material": material, **_difference(*both, where)})
    except MitsubaError as error:
        return f"Mitsuba is left out: {error}."
    return found


def _fastest(run: Run, scene: Scene, rays: int) -> str:
    """The fastest variant that works here: an LLVM too old for the processor ends the process."""
    seconds = {}
    for variant in _VARIANTS:
        try:
            seconds[variant] = _render(run, variant, scene, [Wish(rays, 0, True)])[0][0].seconds
        except MitsubaError as error:
            print(f"    Mitsuba's {variant}: {error}")
    if not seconds:
        raise MitsubaError("none of its variants works here")
    return min(seconds, key=seconds.get)


def _cost(run: Run, wishes: list[Wish]) -> float:
    """In light directions, for the progress."""
    rays, (width, height) = (
        sum(wish.rays * (2 if wish.timed else 1) for wish in wishes),
        run.settings.peer_size,
    )
    return float(rays * DIRECTIONS * width * height)


def _render(run: Run, variant: str, scene: Scene, wishes: list[Wish]) -> tuple[list[Picture], dict]:
    """The pictures, made in the Python that has Mitsuba and kept, and the report with Mitsuba's version."""
    task = {"variant": variant, "threads": run.threads, "directions": DIRECTIONS}
    task |= {
        "sampler": "multijitter",
        "size": list(run.settings.peer_size),
        "camera": scene.camera,
        "up": scene.up,
    }
    files = {"mesh": scene.mesh, "world": scene.world, "measurement": scene.material}
    parameters = {**task, **files, "wishes": wishes, "program": _PROGRAM}
    stem = run.stem("mitsuba", parameters)
    outs = [stem.with_name(f"{stem.name}-{k}.exr") for k in range(len(wishes))]
    pictures = [{**wish._asdict(), "out": str(out)} for wish, out in zip(wishes, outs, strict=True)]
    task |= {name: str(path) for name, path in files.items()} | {"pictures": pictures}
    partial, log = stem.with_suffix(".partial"), run.kept / f"mitsuba-{variant}.log"

    def make() -> dict:
        with open(log, "w") as file:
            command = [_PYTHON, _PROGRAM, json.dumps(task), partial]
            done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT)
        if done.returncode:
            raise MitsubaError(f"it failed with status {done.returncode}; its words are in {log}")
        found = json.loads(partial.read_text())
        partial.unlink()
        return found

    label = f"Mitsuba {variant}, {scene.name}, {', '.join(str(wish.rays) for wish in wishes)} rays"
    report = run.keep(label, "mitsuba", parameters, make, _cost(run, wishes))
    return list(map(Picture, outs, report["seconds"])), report


def _scene(run: Run, name: str, material: str) -> Scene:
    """The scene in reference mode: Velour evaluates the raw measurement."""
    measurement = run.data / f"brdf/{material}.bsdf"
    model, _ = run.fit(measurement, max_lobes=16)
    mesh, up = project.mesh(run.data, "bunny"), "y"
    if name == "sphere":
        mesh, up = run.made("sphere.obj", write_sphere), "z"
    return Scene(f"{name}, {material}", mesh, up, run.world(SUNSET), measurement, model, _CAMERAS[name])


def _reference(run: Run, scene: Scene) -> Reference:
    options = {"size": run.settings.peer_size, "split": DIRECTIONS, "strategy": "product"}
    return Reference(run, scene, DIRECTIONS * run.settings.peer_reference_rays, **options).add(_REFERENCES)


def _difference(ours: Batches, theirs: Batches, where: np.ndarray) -> dict:
    """Over the pixels that show the object: the ratio of the means, Mitsuba's over ours; the sum of the
    absolute differences over the sum of our picture, and what the noise of both alone would make of that."""
    a, b = (batches.mean()[where].astype(np.float64) for batches in (ours, theirs))
    # For a normal x, the mean of |x| is sqrt(2 / pi) times its standard deviation.
    deviation = np.hypot(ours.standard_error(), theirs.standard_error())[where]
    noise = np.sqrt(2 / np.pi) * deviation.sum() / a.sum()
    return {"means": b.sum() / a.sum(), "relative": np.abs(a - b).sum() / a.sum(), "noise": noise}
