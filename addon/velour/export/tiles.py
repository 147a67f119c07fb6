"""The tile that a capture repeats: an object or a collection, its axes and its period."""

from typing import NamedTuple

import bpy
from mathutils import Matrix, Vector

from ..native import Scene
from .color import set_working_space
from .materials import MaterialTable
from .notes import ExportError, Notes
from .objects import GEOMETRY, ObjectExport
from .units import metres_per_unit


class TilePlace(NamedTuple):
    """A tile's cell in the library's scene, in meters."""

    origin: tuple[float, float]
    period: tuple[float, float]


class TileSource(NamedTuple):
    """A tile in Blender's scene; lengths in Blender units."""

    owner: object  # the Object or the Collection
    objects: frozenset  # original objects whose geometry forms the tile
    to_tile: Matrix  # from world space to the tile's axes, without scale
    origin: Vector  # corner of the cell, in the tile's axes
    period: tuple[float, float]
    stretch: tuple[float, float]  # the owner's scale, which the period includes

    @property
    def label(self):
        kind = "Object" if isinstance(self.owner, bpy.types.Object) else "Collection"
        return f"{kind} '{self.owner.name}'"


def object_tile(obj, depsgraph):
    """Tile with the axes of the object, whose scale counts."""
    if obj.velour.is_repeat:
        raise ExportError(f"Object '{obj.name}' is only a repeat of a tile; choose the tile itself.")
    location, rotation, scale = obj.matrix_world.decompose()
    to_tile = (Matrix.Translation(location) @ rotation.to_matrix().to_4x4()).inverted()
    stretch = (abs(scale.x), abs(scale.y))
    return _tile(obj, frozenset([obj]), to_tile, stretch, depsgraph)


def collection_tile(collection, depsgraph):
    """Tile with the world's axes; its cell begins at the world's origin."""
    objects = frozenset(obj for obj in collection.all_objects if not obj.velour.is_repeat)
    return _tile(collection, objects, Matrix(), (1.0, 1.0), depsgraph)


def is_of_tile(instance, source):
    """Whether a depsgraph instance is an object of the tile, or instanced by one."""
    maker = instance.parent if instance.is_instance else instance.object
    return maker is not None and maker.original in source.objects


def export_tile(source, depsgraph, approximate=False):
    """Committed library scene of the tile alone, in meters along its own axes; its TilePlace; the notes.

    Unless `approximate`, raises ExportError if a material is not rendered exactly.
    """
    notes, material_notes, scene = Notes(), Notes(), Scene()
    metres = metres_per_unit(depsgraph.scene)
    try:
        set_working_space(scene)
        materials = MaterialTable(scene, material_notes, unit=metres)
        to_scene = Matrix.Scale(metres, 4) @ source.to_tile
        export = ObjectExport(scene, materials, notes, lambda: None, to_scene)
        export.add_geometry(depsgraph, lambda instance: is_of_tile(instance, source))
        for sentence in materials.beyond_reflection:
            material_notes.add(sentence)
        if len(material_notes) and not approximate:
            sentence = next(iter(material_notes))
            raise ExportError(f"{sentence} Enable Approximate to capture it anyway.")
        scene.commit()
    except BaseException:
        scene.close()
        raise
    place = TilePlace(
        origin=(metres * source.origin.x, metres * source.origin.y),
        period=(metres * source.period[0], metres * source.period[1]),
    )
    return scene, place, [*material_notes, *notes]


def _tile(owner, objects, to_tile, stretch, depsgraph):
    source = TileSource(owner, objects, to_tile, Vector(), (0.0, 0.0), stretch)
    given = owner.velour.period
    period = [given[k] * stretch[k] for k in (0, 1)]
    origin = Vector((0, 0, 0))
    if min(given) == 0:
        low, high = _bounds(source, depsgraph)
        for k in (0, 1):  # each axis separately
            if given[k] == 0:
                origin[k], period[k] = low[k], high[k] - low[k]
    return source._replace(origin=origin, period=tuple(period))


def _bounds(source, depsgraph):
    """Bounds of the evaluated geometry, in the tile's axes."""
    corners = [
        source.to_tile @ instance.matrix_world @ Vector(corner)
        for instance in depsgraph.object_instances
        if is_of_tile(instance, source) and instance.show_self and instance.object.type in GEOMETRY
        for corner in instance.object.bound_box
    ]
    if not corners:
        raise ExportError(
            f"{source.label} has no visible geometry to use as a tile; show or add an object with faces."
        )
    columns = list(zip(*corners, strict=True))
    return Vector(map(min, columns)), Vector(map(max, columns))
