"""What a capture repeats: an object or a collection, its own axes, its period."""

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
    """In the library's scene: metres."""

    origin: tuple[float, float]
    period: tuple[float, float]


class TileSource(NamedTuple):
    """Lengths in Blender's units."""

    owner: object  # the Object or the Collection
    objects: frozenset  # of the .blend, whose geometry makes the tile
    to_tile: Matrix  # from the world to the tile's own axes: no scale
    origin: Vector  # corner of the cell, in the tile's axes
    period: tuple[float, float]
    stretch: tuple[float, float]  # by the owner's scale, which is in the period

    @property
    def label(self):
        kind = "Object" if isinstance(self.owner, bpy.types.Object) else "Collection"
        return f"{kind} '{self.owner.name}'"


def object_tile(obj, depsgraph):
    """The tile's axes are those of the object, its scale counts."""
    if obj.velour.is_repeat:
        raise ExportError(f"Object '{obj.name}' shows how a tile goes on; choose the tile itself.")
    location, rotation, scale = obj.matrix_world.decompose()
    to_tile = (Matrix.Translation(location) @ rotation.to_matrix().to_4x4()).inverted()
    stretch = (abs(scale.x), abs(scale.y))
    return _tile(obj, frozenset([obj]), to_tile, stretch, depsgraph)


def collection_tile(collection, depsgraph):
    """The tile's axes are those of the world; its cell begins at the world's origin."""
    objects = frozenset(obj for obj in collection.all_objects if not obj.velour.is_repeat)
    return _tile(collection, objects, Matrix(), (1.0, 1.0), depsgraph)


def is_of_tile(instance, source):
    """True for a depsgraph instance that is an object of the tile, or that such an object makes."""
    maker = instance.parent if instance.is_instance else instance.object
    return maker is not None and maker.original in source.objects


def export_tile(source, depsgraph, approximate=False):
    """A committed library scene of the tile alone, metres, in its own axes; and where it repeats in it.

    A material that is not rendered as it is, is refused unless `approximate`. Also returns the notes.
    """
    notes, material_notes, scene = Notes(), Notes(), Scene()
    metres = metres_per_unit(depsgraph.scene)
    try:
        set_working_space(scene)
        materials = MaterialTable(scene, material_notes)
        to_scene = Matrix.Scale(metres, 4) @ source.to_tile
        export = ObjectExport(scene, materials, notes, lambda: None, to_scene)
        export.add_geometry(depsgraph, lambda instance: is_of_tile(instance, source))
        for sentence in materials.beyond_reflection:
            material_notes.add(sentence)
        if len(material_notes) and not approximate:
            sentence = next(iter(material_notes))
            raise ExportError(f"{sentence} Switch on Approximate to capture it all the same.")
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
        for k in (0, 1):  # each axis for itself
            if given[k] == 0:
                origin[k], period[k] = low[k], high[k] - low[k]
    return source._replace(origin=origin, period=tuple(period))


def _bounds(source, depsgraph):
    """Of the evaluated geometry, in the tile's axes."""
    corners = [
        source.to_tile @ instance.matrix_world @ Vector(corner)
        for instance in depsgraph.object_instances
        if is_of_tile(instance, source) and instance.show_self and instance.object.type in GEOMETRY
        for corner in instance.object.bound_box
    ]
    if not corners:
        raise ExportError(f"{source.label} shows no geometry; nothing can be captured of it.")
    columns = list(zip(*corners, strict=True))
    return Vector(map(min, columns)), Vector(map(max, columns))
