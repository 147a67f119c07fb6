"""What of Blender's own shaders comes closest to a model: the library's fits, as a Principled BSDF."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..native import Job, Model, model_peer_job
from .approximation_map import map_job, map_of, size_of
from .normal_map import NormalMapJob
from .read_job import ReadJob

_GRAZING = math.cos(math.radians(82))  # where a metal's tint is told: [KHE21]
_LEAST_DIFFUSE = 0.002  # albedo below which a base is not worth a node


class Approximation(NamedTuple):
    """Colours are linear Rec. 709."""

    # As the library's report: base_color, metallic, roughness, specular, specular_tint, coat, coat_roughness.
    principled: dict
    anisotropic: float = 0.0  # Blender's
    turned: bool = False  # the rougher direction is y
    diffuse: tuple = (0.0, 0.0, 0.0)  # of a diffuse base that is added
    color_map: np.ndarray | None = None  # RGBA of a tile in place of the base colour
    normal_map: np.ndarray | None = None  # unit normals along the tile; None: not worth it
    tile_metres: tuple | None = None
    relative_l2: float | None = None  # against the model; None: it is no fit
    by_view_angle: dict = {}

    @property
    def color(self):
        """All in one, for the viewport's Solid mode."""
        return tuple(
            min(a + b, 1.0) for a, b in zip(self.principled["base_color"], self.diffuse, strict=True)
        )


# A grey: Blender's own, until there is a model.
UNFITTED = Approximation(
    {
        "base_color": (0.8, 0.8, 0.8),
        "metallic": 0.0,
        "roughness": 0.5,
        "specular": 0.5,
        "specular_tint": (1.0, 1.0, 1.0),
        "coat": 0.0,
        "coat_roughness": 0.03,
    }
)


class Steps:
    """The jobs of an approximation; each is to be run before the next one is asked for."""

    def __init__(self, model: Model, has_layers: bool):
        """has_layers: the Principled BSDF has a coat and tints as the library knows them."""
        self.result = None  # the Approximation, after the last job
        self._jobs = self._run(model, has_layers)

    def next_job(self) -> Job | None:
        return next(self._jobs, None)

    def _run(self, model: Model, has_layers: bool) -> Iterator[Job]:
        info = model.info()
        isotropic = info.get("isotropic", True)
        peer = ("principled" if has_layers else "plain_principled") if isotropic else "ggx"
        making = ReadJob(lambda: model_peer_job(model, peer))  # it tabulates the model
        yield making
        with making.result() as job:
            yield job
            report = job.report()
        values = {"principled": report[peer.removeprefix("plain_")]} if isotropic else from_ggx(report["ggx"])
        if size := size_of(info):
            making = ReadJob(lambda: map_job(model, size))
            yield making
            with making.result() as job:
                yield job
                picture = job.read_pass("Combined")
            colors = map_of(picture, values["principled"]["base_color"])
            yield (job := NormalMapJob(model, values["principled"], values.get("diffuse"), colors))
            values |= {
                "color_map": colors,
                "normal_map": job.result().normals,
                "tile_metres": info.get("tile_metres"),
            }
        self.result = Approximation(
            **values, relative_l2=report["relative_l2"], by_view_angle=report["by_view_angle"]
        )


def from_ggx(ggx: dict) -> dict:
    """A GGX lobe over a diffuse base as a metal to which a diffuse surface is added."""
    smooth, rough = sorted(ggx["alpha"])
    return {
        "principled": {
            **UNFITTED.principled,
            "base_color": tuple(min(f0, 1.0) for f0 in ggx["f0"]),
            "metallic": 1.0,
            "roughness": min((smooth * rough) ** 0.25, 1.0),
            "specular_tint": tuple(map(_tint, ggx["f0"], ggx["f90"])),
        },
        # Blender's alphas are r^2 / a and r^2 a with a^2 = 1 - 0.9 anisotropic.
        "anisotropic": min((1 - smooth / rough) / 0.9, 1.0),
        "turned": ggx["alpha"][1] > ggx["alpha"][0],
        "diffuse": tuple(ggx["diffuse"]) if max(ggx["diffuse"]) > _LEAST_DIFFUSE else (0.0, 0.0, 0.0),
    }


def _tint(f0: float, f90: float) -> float:
    """What a metal's Fresnel term that rises to 1 is dimmed by near grazing, to rise to `f90`."""
    rise = (1 - _GRAZING) ** 5
    return min(max((f0 + (f90 - f0) * rise) / (f0 + (1 - f0) * rise), 0.0), 1.0)
