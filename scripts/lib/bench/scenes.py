"""The scenes that pages share: meshes, environments, and the subjects of the dissertation's figures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from velour.core import files
from velour.core.luminance import LUMINANCE
from velour.native import images

from . import blender, project

if TYPE_CHECKING:
    from .run import Run

STUDIO, SUNSET = "studio_small_03", "venice_sunset"
# The view of Velour's default camera on the bunny at 4:3, for programs with another default camera.
BUNNY_CAMERA = "-0.0168,-0.2817,0.1101,-0.0168,0.0015,0.1101,40"
_SUZANNE_LEVELS = 3  # 62,976 triangles, about as many as the bunny's


@dataclass(frozen=True)
class Scene:
    """Command line options that describe a scene."""

    name: str
    mesh: Path
    up: str
    world: Path
    material: Path  # a model, or a measurement itself
    proposal: Path | None = None  # for a measurement: the model that its directions are sampled from
    camera: str | None = None

    @property
    def options(self) -> dict:
        names = ("mesh", "up", "world", "material", "proposal", "camera")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    def measured(self, measurement: Path) -> Scene:
        """The same scene with the measurement itself; the model only generates samples."""
        return replace(self, name=f"{self.name} measured", material=measurement, proposal=self.material)


@dataclass(frozen=True)
class Subject:
    """One of the dissertation's figures 7.11 to 7.13."""

    figure: str
    name: str
    mesh: Path
    measurement: Path
    model: Path

    @property
    def material(self) -> str:
        return self.measurement.stem.replace("_", "-")

    def scene(self, world: str, data: Path) -> Scene:
        """The scene with the model, which is both evaluated and sampled."""
        return Scene(f"{self.name}, {world}", self.mesh, "y", project.world(data, world), self.model)


def subjects(run: Run) -> list[Subject]:
    """The subjects whose inputs exist. Prints which are omitted."""
    data = run.data
    found = [
        ("7.11", "bunny", project.mesh(data, "bunny"), project.merl(data, "blue-metallic-paint")),
        ("7.12", "buddha", project.mesh(data, "buddha"), data / "brdf/krylon_blue.brdf"),
    ]
    if suzanne := _suzanne(run):
        found.append(("7.13", "Suzanne", suzanne, project.merl(data, "nickel")))
    return [
        Subject(figure, f"{name}, {file.stem.replace('_', '-')}", mesh, file, run.fit(file, max_lobes=16)[0])
        for figure, name, mesh, file in found
    ]


def _suzanne(run: Run) -> Path | None:
    """Blender's own monkey, subdivided, in place of the Venus, which is not available."""
    path = run.stem("suzanne", {"levels": _SUZANNE_LEVELS}).with_suffix(".obj")
    task = {"path": str(path.with_suffix(".partial.obj")), "levels": _SUZANNE_LEVELS}
    if not path.is_file():
        try:
            blender.run("suzanne", task, run.kept / "suzanne.log")
            path.with_suffix(".partial.obj").replace(path)
        except blender.BlenderError as error:
            print(f"Suzanne is left out: {error}")
            return None
    return path


def write_grid(path: Path, points: np.ndarray, normals: np.ndarray, uvs: np.ndarray | None = None) -> Path:
    """Writes a grid of points, [row, column, 3], as OBJ. Triangles without area are left out."""
    rows, columns = points.shape[:2]
    parts = {"v": points, "vn": normals} | ({} if uvs is None else {"vt": uvs})
    lines = [
        " ".join([kind, *(f"{x:.8f}" for x in row)])
        for kind, array in parts.items()
        for row in array.reshape(rows * columns, -1)
    ]
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1, 1)
    corners = (first + np.array([0, columns, columns + 1, 0, columns + 1, 1])).reshape(-1, 3)
    p, q, r = points.reshape(-1, 3)[corners].swapaxes(0, 1)
    corners = corners[np.linalg.norm(np.cross(q - p, r - p), axis=1) > 1e-12] + 1
    middle = "/{0}/" if uvs is not None else "//"
    lines += ["f " + " ".join(f"{c}{middle.format(c)}{c}" for c in triangle) for triangle in corners]
    files.write_text(path, "\n".join(lines) + "\n")
    return path


def write_sphere(path: Path, rings: int = 128, sectors: int = 256) -> Path:
    """The unit sphere with its exact normals, z up."""
    theta = np.linspace(0, np.pi, rings + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, sectors + 1)[None, :]
    x, y = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi)
    points = np.stack([x, y, np.broadcast_to(np.cos(theta), x.shape)], axis=-1)
    return write_grid(path, points, points)


def sky_directions(rows: int) -> np.ndarray:
    """Directions of the texels of an equirectangular picture, z up, [row, column, 3]. Row 0 is at the bottom,
    the middle column toward +x, azimuth increases to the left."""
    elevation = (np.pi * ((np.arange(rows) + 0.5) / rows - 0.5))[:, None]
    azimuth = np.pi * (1 - (np.arange(2 * rows) + 0.5) / rows)[None, :]
    across, up = np.cos(elevation), np.sin(elevation) * np.ones_like(azimuth)
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), up], axis=-1)


# A clear sky with a small sun, which a mixture of lobes loses most easily.
SUN_DIAMETER = np.radians(0.5)
SUN_SHARE = 0.9  # share of the sky's energy
_ELEVATION, _AZIMUTH = np.radians(40.0), np.radians(-60.0)
SUN = np.array(
    [np.cos(_ELEVATION) * np.cos(_AZIMUTH), np.cos(_ELEVATION) * np.sin(_AZIMUTH), np.sin(_ELEVATION)]
)
_SUN_COLOR = np.array([1.05, 1.0, 0.85])


def write_sunny_sky(path: Path, rows: int = 1024) -> Path:
    """Pale at the horizon, blue above, brown below; the sun is three texels across at 1024 rows."""
    directions = sky_directions(rows)
    up = directions[..., 2:]
    above = np.array([0.75, 0.85, 1.0]) * (1 - np.clip(up, 0, 1)) ** 2 + np.array([0.15, 0.3, 0.7])
    sky = np.where(up > 0, above, np.array([0.12, 0.1, 0.08]))
    sun, area = _sun_coverage(directions, np.pi / rows), np.sqrt(1 - up[..., 0] ** 2)  # up to a factor
    energy = (area[..., None] * sky).sum(axis=(0, 1)) @ LUMINANCE
    radiance = SUN_SHARE / (1 - SUN_SHARE) * energy / ((area * sun).sum() * (_SUN_COLOR @ LUMINANCE))
    images.write(path, (sky + radiance * sun[..., None] * _SUN_COLOR).astype(np.float32))
    return path


def _sun_coverage(directions: np.ndarray, side: float, subsamples: int = 32) -> np.ndarray:
    """Share of each texel, `side` radians wide, that the sun's disk covers."""
    covered = np.zeros(directions.shape[:2])
    inner = side * ((np.arange(subsamples) + 0.5) / subsamples - 0.5)
    for row, column in np.argwhere(directions @ SUN > np.cos(2 * SUN_DIAMETER)):
        x, y, z = directions[row, column]
        elevation, azimuth = np.arcsin(z) + inner[:, None], np.arctan2(y, x) - inner[None, :]
        cosine = np.cos(elevation) * (SUN[0] * np.cos(azimuth) + SUN[1] * np.sin(azimuth))
        cosine += SUN[2] * np.sin(elevation)
        covered[row, column] = (cosine > np.cos(SUN_DIAMETER / 2)).mean()
    return covered


# A flat patch seen from 30 to 50 degrees under a soft environment. At 40 degrees from a distance of 3, the
# near edge is seen at 30 degrees, the middle of the far edge at 50.
PATCH_CAMERA = "0,-1.928,2.298,0,0.05,0,27"
MOVED_PATCH_CAMERA = "0,-2.9,0.6,0,0.05,0,27"  # about 75 degrees


def write_patch(path: Path) -> Path:
    """A quad in the plane z = 0, z up."""
    x, y = np.meshgrid([-0.5, 0.5], [0.81, -0.6])
    points = np.stack([x, y, 0 * x], axis=-1)
    return write_grid(path, points, np.broadcast_to([0.0, 0.0, 1.0], points.shape), points[..., :2] + 1)


def write_soft_sky(path: Path, rows: int = 128) -> Path:
    """A dim dome with a bright patch of about 40 degrees radius."""
    axis = np.array([0.30, 0.51, 0.81]) / np.linalg.norm([0.30, 0.51, 0.81])
    light = 0.4 + 2.5 * np.exp(4.0 * (sky_directions(rows) @ axis - 1))
    images.write(path, (light[..., None] * np.array([1.0, 0.95, 0.9])).astype(np.float32))
    return path


# A bent sheet of tiles.
SHEET_CAMERA = "0,-2.6,1.9,0,0,0.307,28"
SHEET_TILES = 6.0  # along the arc and along the axis of the sheet


def write_sheet(path: Path, strips: int = 96, half_angle: float = np.radians(80)) -> Path:
    """Part of a cylinder of radius 1 about the x axis, its top upwards, z up. Texture coordinates preserve
    lengths: one unit is the length of the arc, along the arc and along the axis."""
    angle, length = np.linspace(-half_angle, half_angle, strips + 1), 2 * half_angle
    v, a = np.meshgrid([0.0, 1.0], angle)
    normals = np.stack([0 * a, np.sin(a), np.cos(a)], axis=-1)
    points = normals + np.stack([length * (v - 0.5), 0 * a, 0 * a], axis=-1)
    return write_grid(
        path, points[::-1], normals[::-1], np.stack([v, (a + half_angle) / length], axis=-1)[::-1]
    )
