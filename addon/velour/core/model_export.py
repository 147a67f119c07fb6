"""Writes a model as a material of other programs, each with its error against the model."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from ..native import Model
from ..native.job_state import ProgressCallback
from ..native.version import version_text
from . import files
from .analytic import gltf, materialx
from .analytic.ggx_terms import Geometry
from .analytic.open_pbr_fit import along_tangent, fitted_open_pbr
from .analytic.view_samples import errors, fitted_samples
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
    material, is_turned, errors_of = _open_pbr(request)
    files.write_text(
        request.path, materialx.document(request.name, material, is_turned, error_note(errors_of))
    )
    return {"parameters": material.inputs(), **errors_of}


def _open_pbr(request):
    found = _approximation(request)
    return fitted_open_pbr(request.model, found.principled, found.anisotropic, found.turned)


def _write_gltf(request: Request) -> dict:
    start, is_turned, _errors = _open_pbr(request)
    samples, is_isotropic = fitted_samples(request.model), request.model.info().get("isotropic", True)
    material = gltf.fit_gltf(along_tangent(samples, is_turned), gltf.Gltf.of_open_pbr(start), is_isotropic)

    def f_cos(of):
        own = along_tangent(of, is_turned)
        return gltf.f_cos(material, Geometry.of(own.wv, own.wl))

    report = errors(request.model, f_cos)
    own = material.material(request.name, 0.25 if is_turned else 0.0, {"velour": report})
    document = {
        "asset": {"version": "2.0", "generator": f"Velour {version_text()}"},
        "extensionsUsed": list(own["extensions"]),
        "materials": [own],
    }
    files.write_json(request.path, document)
    return {"parameters": {key: _plain(value) for key, value in material._asdict().items()}, **report}


def _write_cycles(request: Request) -> dict:
    closures = closures_of(request.model, "correlated")
    report = {key: closures[key] for key in _ERROR_KEYS}
    write_closures(request.path, request.name, closures, error_note(report), request.blender)
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


def _turns(found):
    return 0.25 if found.turned else 0.0


def error_note(report: dict) -> str:
    """A sentence on relative_l2 and by_view_angle, for files."""
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
