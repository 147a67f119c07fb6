"""Placement of BTF tiles on objects: a map of texture coordinates for each slot of an instance."""

import math
from typing import NamedTuple

import numpy as np

from ..core.placement import (
    LARGEST_STRETCH,
    Lie,
    Surface,
    UvMetric,
    lie_of,
    repeats_of,
    texture_map,
    whole,
)
from .measured_look import MeasuredLook
from .meshes import has_uv_maps, object_arrays
from .notes import ExportError
from .uv_maps import placed_maps

_LEAST_SCALE = 1e-3  # of tiles, as the input allows; a linked value may be smaller


class Tile(NamedTuple):
    """Placement data of a material that repeats over surfaces."""

    material: str  # its name
    settings: object  # node.velour.placement
    look: MeasuredLook
    texels: tuple[int, int]  # points of the VOTF if there is no texture
    own_metres: tuple[float, float] | None  # size stored in the BTF, if any

    @classmethod
    def of(cls, material, node, look, info):
        """`node`: MeasuredNode of the material, `info`: info of its model or BTF.

        None if that has neither texels nor a VOTF.
        """
        points = info.get("texels") or info.get("shell", {}).get("points")
        if points is None:
            return None
        metres = info.get("tile_metres")
        own = tuple(metres) if metres else None
        return cls(material.name, node.velour.placement, look, tuple(points[:2]), own)

    @property
    def metres(self):
        """Entered size, or the BTF's own, in meters; None if unknown."""
        return self.settings.tile_metres(self.own_metres)

    @property
    def place(self):
        """Key that is equal for equal placements."""
        settings, look = self.settings, self.look
        sizes = (settings.repeats, settings.tile_size, settings.uv_density, settings.offset)
        placed = look.rotation, look.scale, look.mapping, self.metres
        return settings.mode, settings.keeps_size, *map(tuple, sizes), *placed

    @property
    def aspect(self):
        """Width divided by height in the unit in which tiles are rotated."""
        if self.settings.mode == "REAL_SIZE" and self.metres:
            return self.metres[0] / self.metres[1]
        return self.settings.repeats[1] / self.settings.repeats[0]

    @property
    def shape(self):
        """Width and height scaled to a product of 1; if the size is unknown, texels are square."""
        width, height = self.metres or self.texels
        return math.sqrt(width / height), math.sqrt(height / width)


class Metrics(NamedTuple):
    """Metrics of a surface in meters: without the object's scale, and in world space."""

    local: UvMetric
    world: UvMetric
    projected: float | None  # meters per unit of projected coordinates; None: from a UV map

    @classmethod
    def of(cls, surface, matrix, metres_per_unit, is_projected):
        projected = metres_per_unit if is_projected else None
        local = UvMetric.of(surface, metres_per_unit * np.eye(3))
        linear = np.array(matrix, float)[:3, :3]
        if np.abs(linear.T @ linear - np.eye(3)).max() < 1e-6:
            return cls(local, local, projected)
        return cls(local, UvMetric.of(surface, metres_per_unit * linear), projected)

    def growth(self, keeps_size):
        """Factors on u and v for the object's scale; 1 unless tiles keep their size."""
        if not keeps_size:
            return np.ones(2)
        return np.array(self.local.density()) / self.world.density()


def tile_map(tile, metrics):
    """[2 x 3]: maps the mesh's texture coordinates, which must have an extent, to tiles."""
    settings, lengths = tile.settings, metrics.growth(tile.settings.keeps_size)
    if settings.mode == "REAL_SIZE":
        if tile.metres is None:
            raise ExportError(
                f"Material '{tile.material}': its model does not store the size of its tile; enter Tile Size"
                " in its Placement panel, or choose Repeats there."
            )
        if metrics.projected is None:
            density = settings.density(metrics.local.density())
        else:
            density = np.full(2, 1 / metrics.projected)
        repeats, lengths = 1 / np.array(tile.metres), lengths / density
    elif metrics.projected is None:
        repeats = settings.repeats
    else:  # projected coordinates have no unit square: repeats of the real tile size
        repeats = np.array(settings.repeats) / (tile.metres or (1.0, 1.0))
        lengths = lengths * metrics.projected
    look = tile.look
    repeats = np.array(repeats) / max(look.scale, _LEAST_SCALE)
    placed = texture_map(repeats, look.rotation, settings.offset, lengths)
    return placed if look.mapping is None else _composed(placed, look.mapping)


def _composed(after, before):
    """[2 x 3]: the map `before`, then the map `after`."""
    after, before = (np.vstack([each, (0.0, 0.0, 1.0)]) for each in (after, before))
    return np.ascontiguousarray((after @ before)[:2])


def place_tiles(tile, metrics, side):
    """Sets the Repeats with which tiles on a surface have their aspect ratio and sides of a geometric mean of
    `side` meters, whatever else places them."""
    settings = tile.settings
    settings.mode = "REPEATS"
    density = np.array(_placed(tile, metrics).density()) / settings.repeats
    settings.repeats = whole(repeats_of(side * np.array(tile.shape), density))


def placed_side(tile, metrics):
    """Geometric mean of the sides of tiles on a surface, in meters."""
    return 1 / math.sqrt(math.prod(_placed(tile, metrics).density()))


def _placed(tile, metrics):
    """UvMetric of tile coordinates on a surface."""
    return metrics.world.placed(tile_map(tile, metrics))


def lie_on(tile, metrics, uv_map):
    """The Lie of tiles under a map, for tiles of their aspect ratio and unit area."""
    return lie_of(metrics.world.placed(np.diag(tile.shape) @ uv_map))


def surface_of(arrays, slots):
    """The Surface of the given slots of MeshArrays; None without texture coordinates."""
    if arrays is None or arrays.corner_uvs is None:
        return None
    shown = np.isin(arrays.slots, slots)
    return Surface.of(arrays.positions, arrays.vertices(shown), arrays.uvs(shown))


def missing_coordinates(obj, material_name):
    return (
        f"Object '{obj.name}': its UV map is missing or has no extent, so one point of material"
        f" '{material_name}' covers all of it. Unwrap it, or choose another material."
    )


def uv_problem(obj, shown, material_name):
    """What a ShownSurface lacks to place tiles as its user wants; "" if nothing."""
    if shown.metrics is None:
        return missing_coordinates(obj, material_name)
    return projected_onto(obj, material_name) if shown.is_projected else ""


def projected_onto(obj, material_name):
    return (
        f"Object '{obj.name}': it has no UV map; material '{material_name}' is projected onto it along its"
        " local axes. Unwrap it to control the placement."
    )


def stretch_sentence(obj, tile, lie, surface):
    x, y, z = surface.centers[lie.worst]
    most = f"up to {lie.stretch:.1f}:1" if math.isfinite(lie.stretch) else "infinitely in places"
    return (
        f"Object '{obj.name}': tiles of material '{tile.material}' are stretched by more than"
        f" {LARGEST_STRETCH:g}:1 on {lie.stretched:.0%} of it, {most}, worst near ({x:.3g}, {y:.3g}, {z:.3g})"
        " in local coordinates."
    )


class _Placed(NamedTuple):
    uv_map: np.ndarray
    lie: Lie


class Placements:
    """Placements of an export's instances; notes what is stretched or cannot be placed."""

    def __init__(self, materials, notes):
        self._materials = materials
        self._notes = notes
        self._surfaces = {}
        self._placed = {}

    def of(self, instance, key, slots, metres_per_unit):
        """A map for each material in `slots`; None: texture coordinates remain unchanged.

        `key`: equal for instances of one mesh.
        """
        maps, is_placed = [], False
        for material in slots:
            uv_map = self._map(instance, slots, material, key, metres_per_unit)
            is_placed = is_placed or uv_map is not None
            maps.append(texture_map((1, 1)) if uv_map is None else uv_map)
        return maps if is_placed else None

    def _surface(self, obj, slots, material, mesh):
        """The Surface that shows the material, and whether its texture coordinates are projected."""
        key = (mesh, _slots_that_show(slots, material))
        if key not in self._surfaces:
            surface = surface_of(object_arrays(obj, placed_maps(slots)), key[1])
            self._surfaces[key] = surface, not has_uv_maps(obj)
        return self._surfaces[key]

    def _map(self, instance, slots, material, key, metres_per_unit):
        turn, tile = self._materials.turn(material), self._materials.tile(material)
        if turn:
            return texture_map((1, 1), turn)
        if tile is None:
            return None
        surface, is_projected = self._surface(instance.object, slots, material, key)
        shown = _slots_that_show(slots, material)
        shape = (key, shown, material.original.as_pointer(), _size_of(instance.matrix_world))
        if shape not in self._placed:
            metrics = Metrics.of(surface, instance.matrix_world, metres_per_unit, is_projected)
            self._placed[shape] = self._place(tile, metrics)
        placed = self._placed[shape]
        self._warn(instance.object, tile, surface, placed)
        return placed.uv_map if placed else None

    def _place(self, tile, metrics):
        """The _Placed tile; None if texture coordinates have no extent."""
        if metrics.world.is_flat:
            return None
        try:
            uv_map = tile_map(tile, metrics)
        except ExportError as error:
            if self._materials.strict:
                raise
            self._notes.add(str(error))
            uv_map = texture_map((1, 1))
        return _Placed(uv_map, lie_on(tile, metrics, uv_map))

    def _warn(self, obj, tile, surface, placed):
        if placed is None:
            self._notes.add(missing_coordinates(obj, tile.material))
        elif placed.lie.is_stretched:
            self._notes.add(stretch_sentence(obj, tile, placed.lie, surface))


def _slots_that_show(slots, material):
    return tuple(slot for slot, other in enumerate(slots) if other == material)


def _size_of(matrix):
    """Matrix invariants under rotation, rounded, so that rotated copies share their metrics."""
    linear = np.array(matrix, float)[:3, :3]
    gram = linear.T @ linear
    size = np.trace(gram) or 1.0
    return (f"{size:.5g}", *np.round(gram / size, 5).ravel().tolist())
