"""The closest match to a model among Blender's own shaders: the library's fits, as a Principled BSDF."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..native import Job, Model, model_peer_job
from .approximation_map import map_job, map_of, size_of
from .closures import closures_of
from .read_job import ReadJob
from .tile_maps import TileMapsJob

_GRAZING = math.cos(math.radians(82))  # cosine at which a metal's tint is specified [KHE21]
_LEAST_DIFFUSE = 0.002  # a base with a smaller albedo is not worth a node


class Approximation(NamedTuple):
    """Colors are linear Rec. 709."""

    # Keys as in the report: base_color, metallic, roughness, specular, specular_tint, coat, coat_roughness.
    principled: dict
    anisotropic: float = 0.0  # Blender's anisotropic
    turned: bool = False  # the rougher direction is y
    diffuse: tuple = (0.0, 0.0, 0.0)  # color of an added diffuse base
    color_map: np.ndarray | None = None  # RGBA of a tile, replaces the base color
    # Further maps of the tile, as in core/tile_maps; None: not worth it.
    normal_map: np.ndarray | None = None
    roughness_map: np.ndarray | None = None
    height_map: np.ndarray | None = None
    tile_metres: tuple | None = None
    closures: dict | None = None  # of a BRDF (core/closures.py), which replace the Principled BSDF in nodes
    relative_l2: float | None = None  # of the nodes, against the model; None: not fitted
    by_view_angle: dict = {}
    reason: str = ""  # why the error is large

    @property
    def color(self):
        """A single color for the viewport's Solid mode."""
        return tuple(
            min(a + b, 1.0) for a, b in zip(self.principled["base_color"], self.diffuse, strict=True)
        )


# Blender's default gray, used until there is a model.
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
    """The jobs of an approximation. Run each one before requesting the next."""

    def __init__(self, model: Model, has_layers: bool, masking: str | None):
        """has_layers: this Blender's Principled BSDF has the coat and the tints of the library's. A material
        with closures always has them, since only exporters use its Principled BSDF.

        masking: of the closures of a BRDF, as for Model.closures; None: without them.
        """
        self.result = None  # the Approximation, after the last job
        self._jobs = self._run(model, has_layers, masking)

    def next_job(self) -> Job | None:
        return next(self._jobs, None)

    def _run(self, model: Model, has_layers: bool, masking: str | None) -> Iterator[Job]:
        info = model.info()
        isotropic, size = info.get("isotropic", True), size_of(info)
        is_layered = has_layers or (masking is not None and not size)
        peer = ("principled" if is_layered else "plain_principled") if isotropic else "ggx"
        making = ReadJob(lambda: model_peer_job(model, peer))  # a ReadJob, because this tabulates the model
        yield making
        with making.result() as job:
            yield job
            report = job.report()
        values = {"principled": report[peer.removeprefix("plain_")]} if isotropic else from_ggx(report["ggx"])
        if size:
            making = ReadJob(lambda: map_job(model, size))
            yield making
            with making.result() as job:
                yield job
                picture = job.read_pass("Combined")
            colors = map_of(picture, values["principled"]["base_color"])
            shown = values["principled"], values.get("diffuse"), colors
            yield (job := TileMapsJob(model, *shown, info.get("tile_metres")))
            maps = job.result()
            values |= {
                "color_map": colors,
                "normal_map": maps.normals,
                "roughness_map": maps.roughness,
                "height_map": maps.height,
                "tile_metres": info.get("tile_metres"),
            }
            report = {"relative_l2": maps.relative_l2, "by_view_angle": maps.by_view_angle}
        elif masking is not None:
            yield (fitting := ReadJob(lambda: closures_of(model, masking)))
            values["closures"] = report = fitting.result()
        errors = {key: report[key] for key in ("relative_l2", "by_view_angle", "reason") if key in report}
        self.result = Approximation(**values, **errors)


def from_ggx(ggx: dict) -> dict:
    """A GGX lobe over a diffuse base, converted to a metal plus a diffuse surface."""
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
    """Factor near grazing that makes a metal's Fresnel term, which rises to 1, rise to `f90`."""
    rise = (1 - _GRAZING) ** 5
    return min(max((f0 + (f90 - f0) * rise) / (f0 + (1 - f0) * rise), 0.0), 1.0)
