"""Measurements and models made for the tests, kept in build/blend-tests/inputs."""

import importlib
import os
import sys
from pathlib import Path
from unittest import mock

import numpy as np

from .blender import ADDON, folder, library_file

_SCRIPTS = Path(__file__).resolve().parents[2] / "scripts/lib"
MERL_SCALES = (1 / 1500, 1.15 / 1500, 1.66 / 1500)
MERL_SIZE = (90, 90, 180)  # theta_h, theta_d, phi_d


def module(name):
    """A module of the add-on, by the add-on's own name, as users call it."""
    return importlib.import_module(f"{ADDON}.{name}")


def native():
    return module("native")


def script(name):
    """A module of scripts/lib, or one that imports some."""
    with mock.patch.object(sys, "path", [str(_SCRIPTS), *sys.path]):
        return importlib.import_module(name)


def lambert_measurement(albedo=(0.8, 0.5, 0.2)):
    """A MERL file of a diffuse material: the picture under a constant world is its albedo."""
    name = "lambert-" + "-".join(f"{a:g}" for a in albedo) + ".binary"
    return _made(
        name, lambda path: write_merl(path, lambda *_angles: [np.full(1, a / np.pi) for a in albedo])
    )


def glossy_measurement():
    """A MERL file of a broad Phong-like highlight over a diffuse base."""

    def f(theta_h, _theta_d, _phi_d):
        lobe = np.cos(theta_h) ** 40
        return [base / np.pi + 0.8 * lobe for base in (0.1, 0.2, 0.4)]

    return _made("glossy.binary", lambda path: write_merl(path, f))


def plastic_measurement():
    """A MERL file of a blue base under a GGX lobe of alpha 0.16 that rises from 4 % as Schlick says."""

    def f(theta_h, theta_d, phi_d):
        cosines = [
            np.maximum(
                np.cos(theta_h) * np.cos(theta_d) + side * np.sin(theta_h) * np.sin(theta_d) * np.cos(phi_d),
                0.02,
            )
            for side in (-1, 1)
        ]
        alpha_sq = 0.16**2
        d = alpha_sq / (np.pi * (np.cos(theta_h) ** 2 * (alpha_sq - 1) + 1) ** 2)
        g = np.prod([2 * c / (c + np.sqrt(alpha_sq + (1 - alpha_sq) * c**2)) for c in cosines], axis=0)
        fresnel = 0.04 + 0.96 * (1 - np.cos(theta_d)) ** 5
        lobe = fresnel * d * g / (4 * cosines[0] * cosines[1])
        return [base / np.pi + lobe for base in (0.05, 0.15, 0.5)]

    return _made("plastic.binary", lambda path: write_merl(path, f))


def anisotropic_measurement():
    """A table of a micro-surface, far too noisy for anything but being refused."""

    def make(path):
        with native().microsurface_job(path, roughness=0.3, anisotropy=2.0, rays=20000) as job:
            job.run()

    return _made("anisotropic.exr", make)


def brushed_model():
    """A four-lobe model of a metal of roughness 0.25 and anisotropy 4, from the virtual goniometer."""
    return (Path(__file__).parent.parent / "scenes/data/brushed.velour").read_bytes()


def weave_model():
    """A model of the BTF of a weave of two colors, 16 x 16 texels."""
    return (Path(__file__).parent.parent / "scenes/data/weave.velour").read_bytes()


def write_merl(path, f):
    """`f(theta_h, theta_d, phi_d)` gives three channels in 1/sr, broadcast over the table."""
    theta_h = (np.arange(90) / 90) ** 2 * (np.pi / 2)  # the table is square-root spaced in theta_h
    theta_d = np.arange(90) / 90 * (np.pi / 2)
    phi_d = np.arange(180) / 180 * np.pi
    channels = f(theta_h[:, None, None], theta_d[None, :, None], phi_d[None, None, :])
    with open(path, "wb") as file:
        np.array(MERL_SIZE, np.int32).tofile(file)
        for channel, scale in zip(channels, MERL_SCALES, strict=True):
            (np.broadcast_to(channel, MERL_SIZE) / scale).astype(np.float64).tofile(file)


def model_bytes(measurement):
    """A coarse, quick fit of a measurement file. Kept for the library that made it."""
    return _model(measurement, "coarse", tolerance=0.1, max_lobes=4)


def full_model_bytes(measurement):
    """As model_bytes, with the defaults of a fit."""
    return _model(measurement, "full")


def _model(measurement, kind, **options):
    name = f"{measurement.stem}-{kind}-{library_file().stat().st_mtime_ns}.velour"
    return _made(name, lambda path: _fit(measurement, path, options)).read_bytes()


def _fit(measurement, path, options):
    velour = native()
    with velour.Measurement.load(measurement) as loaded, velour.fit_job(loaded, **options) as job:
        job.run()
        with job.result_model() as model:
            path.write_bytes(model.bytes())


def _made(name, make):
    path = folder().parent / "inputs" / name
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = Path(f"{path}.{os.getpid()}")
        make(temporary)
        os.replace(temporary, path)
    return path


# OBJ file with texture coordinates, y up: a rectangle that rises away from the camera that frames it.
SQUARE = "v -1 0 1\nv 1 0 1\nv 1 1 -1\nv -1 1 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
QUARTERS = ((0.8, 0.4), (0.2, 0.1))  # rows from below: albedos of a tile's quarters
QUARTER_TEXELS = 16  # along the tile's side


def quarters_model(metres=0.5, **options):
    """A model of the BTF of a flat, matt tile of four grays, `metres` wide; 0: its size is not known.

    Options are those of compress_job.
    """

    def make(path):
        velour = native()
        with velour.Btf.load(quarters_btf(metres)) as btf, velour.compress_job(btf, **options) as job:
            job.run()
            with job.result_model() as model:
                path.write_bytes(model.bytes())

    name = "-".join(["quarters", f"{metres:g}", *map(str, options.values())])
    return _made(f"{name}-{library_file().stat().st_mtime_ns}.velour", make).read_bytes()


def quarters_btf(metres=0.5):
    """The BTF that it is of."""
    return _made(f"quarters-{metres:g}.btf", lambda path: _capture_quarters(path, metres))


def _capture_quarters(folder_of_btf, metres):
    velour = native()
    x, y = np.meshgrid((0, 0.5, 1), (0, 0.5, 1))
    positions = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3).astype(np.float32)
    corners = [(a, a + 1, a + 4, a + 3) for a in (0, 1, 3, 4)]
    triangles = np.array([t for a, b, c, d in corners for t in ((a, b, c), (a, c, d))], np.uint32)
    with velour.Scene() as scene:
        mesh, _ = scene.add_mesh(positions, triangles, material_slots=np.arange(4, dtype=np.uint32).repeat(2))
        grays = [
            scene.add_principled_material(base_color=(a, a, a), roughness=1.0, specular=0.0)
            for row in QUARTERS
            for a in row
        ]
        scene.add_instance(mesh, np.eye(4), grays)
        scene.commit()
        angles = velour.directions("16")
        options = {"texels": QUARTER_TEXELS, "views": angles, "lights": angles, "samples": 4, "bounces": 0}
        with velour.capture_job(
            scene, folder_of_btf, metres_per_unit=metres, period=(1, 1), sides="one", **options
        ) as job:
            job.run()
