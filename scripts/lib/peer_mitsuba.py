"""Compares Mitsuba 3's `measured` material with ours: the same mesh, camera, environment and measurement."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

import data_files
import numpy as np
import silhouette
import sphere
from chart_result import Point, point_of
from curve import Curve, Reading, ratio
from mitsuba_runs import Mitsuba, MitsubaError, Wish
from reference import FIRST_SEED, Batches, Reference
from renders import Picture, Renders
from scenes import BUNNY_CAMERA, Scene

MATERIALS = ("satin_rosaline_rgb", "paper_white_rgb", "cc_iris_purple_gem_rgb")
STRATEGIES = ("mis", "product")
DIRECTIONS = 8  # light directions per camera ray, in both programs
WORLD = "venice_sunset"
_REFERENCES = 4
_CAMERAS = {"bunny": BUNNY_CAMERA, "sphere": "0,-4,0,0,0,0,40"}


@dataclass(frozen=True)
class Difference:
    """Difference of both programs' converged pictures of the sphere, over the pixels that show it."""

    means: float  # ratio of the means, Mitsuba's over ours
    relative: float  # sum of the absolute differences over the sum of our picture
    noise: float  # the value of `relative` that the noise of both alone would cause


@dataclass(frozen=True)
class Comparison:
    material: str
    version: str
    variant: str
    points: dict[str, list[Point]]  # for "mitsuba" and our strategies
    sphere: Difference

    @property
    def level(self) -> float:
        """relmse of Mitsuba's longest render."""
        return self.points["mitsuba"][-1].relmse

    @functools.cached_property
    def curves(self) -> dict[str, Curve]:
        return {name: Curve([(p.seconds, p.relmse) for p in own]) for name, own in self.points.items()}

    def seconds(self, name: str) -> Reading | None:
        return self.curves[name].seconds_at(self.level) if self.level > 0 else None

    def speed_up(self) -> Reading | None:
        """Mitsuba's seconds over those of our faster strategy."""
        ours = [found for found in map(self.seconds, STRATEGIES) if found]
        return ratio(self.seconds("mitsuba"), min(ours, key=lambda found: found.value, default=None))


def compare(data: Path, renders: Renders, extent) -> list[Comparison] | str:
    """One comparison per material, or a sentence if that is impossible."""
    mitsuba = Mitsuba(renders, extent.peer_size, DIRECTIONS)
    if not mitsuba.installed():
        return "Mitsuba is left out: it is not installed and could not be had from PyPI (build/peers.log)."
    _announce(renders, mitsuba, extent)
    bunnies = [_scene("bunny", data, name, renders) for name in MATERIALS[: extent.peer_materials]]
    try:
        mitsuba.choose_variant(bunnies[0], extent.peer_rays[-1])
        return [_compare(data, bunny, mitsuba, renders, extent) for bunny in bunnies]
    except MitsubaError as error:
        return f"Mitsuba is left out: {error}."


def _announce(renders: Renders, mitsuba: Mitsuba, extent) -> None:
    spp = DIRECTIONS * extent.peer_reference_rays
    for _ in MATERIALS[: extent.peer_materials]:
        for wishes in (_ladder(renders, extent), _converged(extent), _converged(extent)):
            renders.progress.expect(mitsuba.cost(wishes))
        renders.expect(spp, extent.peer_size, 2 * _REFERENCES)
        for rays in extent.peer_rays:
            renders.expect(DIRECTIONS * rays, extent.peer_size, len(STRATEGIES))


def _ladder(renders: Renders, extent) -> list[Wish]:
    return [Wish(rays, renders.settings.seed, True) for rays in extent.peer_rays]


def _converged(extent) -> list[Wish]:
    return [Wish(extent.peer_reference_rays, FIRST_SEED + k, False) for k in range(_REFERENCES)]


def _scene(name: str, data: Path, material: str, renders: Renders) -> Scene:
    """The scene in reference mode: Velour evaluates the raw measurement."""
    measurement = data / f"brdf/{material}.bsdf"
    model, _ = renders.fit(measurement)
    mesh, up = data_files.mesh(data, "bunny"), "y"
    if name == "sphere":
        mesh, up = sphere.write(renders.settings.folder / "sphere.obj"), "z"
    world = data_files.world(data, WORLD)
    return Scene(f"{name}, {material}", mesh, up, world, measurement, model, _CAMERAS[name])


def _compare(data: Path, bunny: Scene, mitsuba: Mitsuba, renders: Renders, extent) -> Comparison:
    seed = renders.settings.seed
    pictures, report = mitsuba.render(bunny, _ladder(renders, extent))
    points = {"mitsuba": _points(pictures, _their_reference(bunny, mitsuba, extent), extent, seed)}
    ours = _our_reference(bunny, renders, extent)
    for strategy in STRATEGIES:
        points[strategy] = _points(_our_pictures(bunny, renders, extent, strategy), ours, extent, seed)
    ball = _scene("sphere", data, bunny.material.stem, renders)
    converged = _our_reference(ball, renders, extent), _their_reference(ball, mitsuba, extent)
    difference = _difference(*converged, silhouette.of(ball, renders, extent.peer_size))
    return Comparison(bunny.material.stem, report["version"], report["variant"], points, difference)


def _points(pictures: list[Picture], reference: Batches, extent, seed: int) -> list[Point]:
    mean, noise = reference.mean(), reference.noise()
    return [
        point_of(picture, DIRECTIONS * rays, seed, mean, noise)
        for picture, rays in zip(pictures, extent.peer_rays, strict=True)
    ]


def _our_pictures(scene: Scene, renders: Renders, extent, strategy: str) -> list[Picture]:
    options = {"size": extent.peer_size, "split": DIRECTIONS, "strategy": strategy}
    return [renders.render(scene, DIRECTIONS * rays, **options) for rays in extent.peer_rays]


def _our_reference(scene: Scene, renders: Renders, extent) -> Reference:
    options = {"size": extent.peer_size, "split": DIRECTIONS, "strategy": "product"}
    return Reference(renders, scene, DIRECTIONS * extent.peer_reference_rays, **options).add(_REFERENCES)


def _their_reference(scene: Scene, mitsuba: Mitsuba, extent) -> Batches:
    return Batches(mitsuba.render(scene, _converged(extent))[0])


def _difference(ours: Batches, theirs: Batches, where: np.ndarray) -> Difference:
    a, b = (batches.mean()[where].astype(np.float64) for batches in (ours, theirs))
    # For a normal x, the mean of |x| is sqrt(2 / pi) times its standard deviation.
    deviation = np.hypot(ours.standard_error(), theirs.standard_error())[where]
    noise = np.sqrt(2 / np.pi) * deviation.sum() / a.sum()
    return Difference(float(b.sum() / a.sum()), float(np.abs(a - b).sum() / a.sum()), float(noise))
