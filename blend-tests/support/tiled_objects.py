"""A plane or a cylinder covered with tiles of geometry, and the same objects smooth.

The reference plane of the tile's BTF is `height` above z = 0 of the tile; the smooth objects are made of it.
A black sheet under the tiles absorbs light that falls through, which a BTF of one side loses as well.
"""

import math
from typing import NamedTuple

import bpy
import numpy as np
from bench.inside import scene as build
from mathutils import Matrix, Vector

_REACH = 6  # tiles on each side of the center
_STEPS = 8  # facets of the smooth cylinder per tile


class Plane(NamedTuple):
    period: float
    height: float

    middle = Vector((0, 0, 0))

    def bent(self, points: np.ndarray) -> np.ndarray:
        return points - np.array([0, 0, self.height])

    def place(self, column: int, row: int) -> Matrix:
        return Matrix.Translation((column * self.period, row * self.period, 0))

    @property
    def columns(self) -> range:
        return range(-_REACH, _REACH)


class Cylinder(NamedTuple):
    """A cylinder of `around` tiles about an axis along y; its topmost line goes through the origin."""

    period: float
    height: float
    around: int

    @property
    def radius(self) -> float:
        return self.around * self.period / (2 * math.pi)

    @property
    def middle(self) -> Vector:
        return Vector((0, 0, -self.radius))

    def bent(self, points: np.ndarray) -> np.ndarray:
        angle, distance = points[:, 0] / self.radius, self.radius + points[:, 2] - self.height
        across = distance * np.sin(angle)
        return np.stack([across, points[:, 1], distance * np.cos(angle) - self.radius], axis=1)

    def place(self, column: int, row: int) -> Matrix:
        down = Matrix.Translation((0, row * self.period, -self.radius))
        turn = Matrix.Rotation(column * 2 * math.pi / self.around, 4, "Y")
        return down @ turn @ Matrix.Translation((0, 0, self.radius))

    @property
    def columns(self) -> range:
        return range(-(self.around // 2), self.around - self.around // 2)


def add_tiles(tile: bpy.types.Object, shape: Plane | Cylinder) -> list[bpy.types.Object]:
    """Adds copies of the tile, which share one bent mesh, and the black sheet."""
    mesh = tile.data.copy()
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    bent = shape.bent(points.reshape(-1, 3).astype(float))
    mesh.vertices.foreach_set("co", bent.astype(np.float32).ravel())
    mesh.update()
    objects = [_black_sheet(shape, 1.01 * float(np.ptp(points[2::3])))]
    for column in shape.columns:
        for row in range(-_REACH, _REACH):
            copy = bpy.data.objects.new("Copy", mesh)
            copy.matrix_world = shape.place(column, row)
            objects.append(copy)
    for obj in objects:
        bpy.context.scene.collection.objects.link(obj)
    return objects


def _black_sheet(shape: Plane | Cylinder, thickness: float) -> bpy.types.Object:
    """The smooth object, lowered below the whole tile."""
    sheet = _smooth(shape, depth=shape.height + thickness)
    sheet.data.materials.append(build.material("Black", "BsdfDiffuse", Color=(0, 0, 0)))
    return sheet


def add_smooth(shape: Plane | Cylinder) -> bpy.types.Object:
    """Adds the reference plane as a smooth object; its texture coordinates count tiles."""
    obj = _smooth(shape, depth=0)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _smooth(shape: Plane | Cylinder, depth: float) -> bpy.types.Object:
    """A grid at `depth` below the reference plane, bent like the tiles."""
    columns = np.arange(shape.columns.start * _STEPS, shape.columns.stop * _STEPS + 1) / _STEPS
    u, v = np.meshgrid(columns, [-_REACH, _REACH])
    flat = np.stack([u, v, np.full_like(u, (shape.height - depth) / shape.period)], axis=-1).reshape(-1, 3)
    n = len(columns)
    faces = [(i, i + 1, n + i + 1, n + i) for i in range(n - 1)]
    mesh = bpy.data.meshes.new("Smooth")
    mesh.from_pydata(shape.bent(flat * shape.period).tolist(), [], faces)
    coordinates = flat[np.array(faces).ravel(), :2]
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", coordinates.astype(np.float32).ravel())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    mesh.update()
    return bpy.data.objects.new("Smooth", mesh)
