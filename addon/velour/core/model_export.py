"""Writes a model as a material of other programs, each with its error against the model."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..native import Model
from ..native.job_state import ProgressCallback
from ..native.version import version_text
from . import files
from .analytic import gltf, materialx, open_pbr
from .analytic.ggx_terms import Geometry
from .analytic.open_pbr_fit import fit_open_pbr
from .analytic.view_samples import ViewSamples, errors, fitted_samples
from .approximation import Approximation, Steps
from .blend_file import write_closures
from .closures import closures_of

_ERROR_KEYS = ("relative_l2", "by_view_angle")


class Request(NamedTuple):
    model: Model  # of a BRDF
    path: Path  # of the file to write
    blender: str  # program that writes .blend files
    progress: ProgressCallback | None

    @property
    def name(self) -> str:
        return self.path.stem


class Target(NamedTuple):
    suffix: str  # of its files
    write: Callable[[Request], dict]  # returns the report: parameters, relative_l2, by_view_angle


def _write_principled(request: Request) -> dict:
    found = _approximation(request)
    parameters = {key: _plain(value) for key, value in found.principled.items()}
    if found.anisotropic > 0:
        parameters |= {"anisotropic": found.anisotropic, "anisotropic_rotation": _turns(found)}
    if max(found.diffuse) > 0:
        parameters["added_diffuse"] = _plain(found.diffuse)
    report = {"parameters": parameters, **{key: getattr(found, key) for key in _ERROR_KEYS}}
    files.write_json(request.path, {"name": request.name, "shader": "Principled BSDF", **report})
    return report


def _write_open_pbr(request: Request) -> dict:
    material, is_turned, report = _open_pbr(request)
    text = materialx.document(request.name, material, is_turned, _note(report))
    files.write_text(request.path, text)
    return report


def _open_pbr(request):
    found = _approximation(request)
    samples, is_isotropic = fitted_samples(request.model), request.model.info().get("isotropic", True)
    is_turned = found.turned and not is_isotropic
    start = open_pbr.OpenPbr.of_principled(found.principled, found.anisotropic)
    material = fit_open_pbr(_along(samples, is_turned), start, is_isotropic)

    def f_cos(of):
        return open_pbr.f_cos(material, _geometry(of, is_turned))

    return material, is_turned, {"parameters": material.inputs(), **errors(request.model, f_cos)}


def _write_gltf(request: Request) -> dict:
    start, is_turned, _report = _open_pbr(request)
    samples, is_isotropic = fitted_samples(request.model), request.model.info().get("isotropic", True)
    material = gltf.fit_gltf(_along(samples, is_turned), gltf.Gltf.of_open_pbr(start), is_isotropic)
    report = errors(request.model, lambda of: gltf.f_cos(material, _geometry(of, is_turned)))
    own = material.material(request.name, 0.25 if is_turned else 0.0, {"velour": report})
    document = {
        "asset": {"version": "2.0", "generator": f"Velour {version_text()}"},
        "extensionsUsed": list(own["extensions"]),
        "materials": [own],
    }
    files.write_json(request.path, document)
    return {"parameters": {key: _plain(value) for key, value in material._asdict().items()}, **report}


def _write_cycles(request: Request) -> dict:
    closures = closures_of(request.model, "correlated", request.progress)
    report = {key: closures[key] for key in _ERROR_KEYS}
    write_closures(request.path, request.name, closures, _note(report), request.blender)
    return {"parameters": {"lobes": [lobe["distribution"] for lobe in closures["lobes"]]}, **report}


TARGETS = {
    "openpbr": Target(".mtlx", _write_open_pbr),
    "principled": Target(".json", _write_principled),
    "gltf": Target(".gltf", _write_gltf),
    "cycles": Target(".blend", _write_cycles),
}


def _approximation(request) -> Approximation:
    steps = Steps(request.model, has_layers=True, masking=None)
    while job := steps.next_job():
        job.start().wait(request.progress)
    return steps.result


def _along(samples, is_turned) -> ViewSamples:
    """The samples in a frame whose x axis is that of the rougher direction."""
    return samples._replace(wv=_turned(samples.wv), wl=_turned(samples.wl)) if is_turned else samples


def _geometry(samples, is_turned):
    frame = _along(samples, is_turned)
    return Geometry.of(frame.wv, frame.wl)


def _turned(directions):
    """By a quarter turn about the normal that moves the y axis to x."""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.stack([y, -x, z], axis=-1)


def _turns(found):
    return 0.25 if found.turned else 0.0


def _note(report):
    views = ", ".join(
        f"{angle} degrees {'-' if error is None else f'{error:.3f}'}"
        for angle, error in report["by_view_angle"].items()
    )
    return (
        f"Fitted by Velour {version_text()}. Relative L2 error against the measured material's model:"
        f" {report['relative_l2']:.3f}; by view angle: {views}."
    )


def _plain(value):
    return [float(each) for each in value] if hasattr(value, "__len__") else float(value)
