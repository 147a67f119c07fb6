"""The tile of an operator, and its capture options."""

import glob
import os
import re
import shutil

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from ..export.tiles import collection_tile, object_tile
from ..native import directions

CAPTURE_NUMBERS = ("texels", "views", "lights", "samples", "bounces")


class OfTile:
    """Mixin for an operator that works on a tile."""

    collection: StringProperty(
        name="Collection",
        description="Collection that is the tile, instead of an object",
        options={"SKIP_SAVE"},
    )


def find_tile(context, collection_name):
    """The TileSource of the collection of that name, or of the active object if the name is empty."""
    depsgraph = context.evaluated_depsgraph_get()
    if collection_name:
        collection = bpy.data.collections.get(collection_name)
        if collection is None:
            raise ExportError(f"There is no collection '{collection_name}' to use as a tile; check its name.")
        return collection_tile(collection, depsgraph)
    if context.object is None:
        raise ExportError("There is no active object to use as a tile; select one.")
    return object_tile(context.object, depsgraph)


def tile_of(context, owner):
    """The TileSource of an object or a collection."""
    make = object_tile if isinstance(owner, bpy.types.Object) else collection_tile
    return make(owner, context.evaluated_depsgraph_get())


def capture_folder(owner):
    """Absolute folder of the BTF of a tile, which may not exist yet. Safe in draw().

    A capture from before the file was saved counts until there is one beside the file."""
    folder, earlier = output_folder(owner), _temporary_folder(owner)
    is_lacking = not owner.velour.directory and not os.path.exists(folder)
    return earlier if is_lacking and os.path.isdir(earlier) else folder


def output_folder(owner):
    """Absolute folder that the BTF of a tile is captured into. Safe in draw()."""
    if not owner.velour.directory and not bpy.data.filepath and owner.library is None:
        return _temporary_folder(owner)
    folder = owner.velour.directory or f"//{_folder_name(owner)}"
    return os.path.normpath(bpy.path.abspath(folder, library=owner.library))


def is_temporary(owner):
    """Whether the BTF of a tile is deleted when the file is closed. Safe in draw()."""
    return capture_folder(owner).startswith(os.path.join(bpy.app.tempdir, ""))


def _temporary_folder(owner):
    return os.path.join(bpy.app.tempdir, _folder_name(owner))


def remove_temporary():
    """Removes all temporary BTFs: those of a file that is closed would be taken for those of the next one."""
    for folder in glob.glob(os.path.join(glob.escape(bpy.app.tempdir), "*.btf")):
        shutil.rmtree(folder, ignore_errors=True)


def _folder_name(owner):
    return f"{bpy.path.clean_name(owner.name)}.btf"


def held_out_folder(tile):
    """Folder of the held-out pairs, beside the tile's BTF."""
    return held_out_beside(capture_folder(tile.owner))


def held_out_beside(folder):
    """Folder of the held-out pairs of the BTF in a folder."""
    return folder.removesuffix(".btf") + ".held-out.btf"


def new_folder(tile):
    """Value for the tile's setting: the first unused folder, numbered as in Blender."""
    owner = tile.owner
    folder = output_folder(owner)
    name = re.sub(r"\.\d{3,}$", "", folder.removesuffix(".btf"))
    number = 0
    while os.path.exists(folder) or os.path.exists(held_out_beside(folder)):
        number += 1
        folder = f"{name}.{number:03}.btf"
    blend_folder = bpy.path.abspath("//", library=owner.library)
    return bpy.path.relpath(folder, start=blend_folder) if bpy.data.filepath else folder


def capture_options(context, tile, place):
    """Options of capture_job() from the tile's settings. `place`: TilePlace from export_tile()."""
    settings = tile.owner.velour
    return {
        "origin": place.origin,
        "period": place.period,
        "source": tile.owner.name,
        "texels": settings.texels,
        "views": directions(str(settings.views)),
        "lights": directions(str(settings.lights)),
        "samples": settings.samples,
        "bounces": settings.bounces,
        "sides": settings.sides.lower(),
        "threads": context.scene.render.threads,
    }


def captured_as(owner):
    """Key that changes with the parameters of a capture, and with the tile. Safe in draw()."""
    return repr((asked_of(owner), _geometry(owner)))


def asked_of(owner):
    """Parameters of the tile's capture. Safe in draw()."""
    settings = owner.velour
    names = (*CAPTURE_NUMBERS, "held_out", "sides", "use_approximate")
    return owner.name, *settings.period, *(getattr(settings, name) for name in names)


def _geometry(owner):
    """Properties of the tile's geometry that are known without reading its vertices."""
    if isinstance(owner, bpy.types.Object):
        return _object_geometry(owner)  # its location does not matter
    parts = (obj for obj in owner.all_objects if not obj.velour.is_repeat)
    return [(_object_geometry(obj), [*map(tuple, obj.matrix_world)]) for obj in parts]


def _object_geometry(obj):
    depsgraph = bpy.context.view_layer.depsgraph
    data = obj.evaluated_get(depsgraph).data if depsgraph else obj.data
    counts = [len(getattr(data, name, ())) for name in ("vertices", "polygons")]
    materials = [slot.material and slot.material.name for slot in obj.material_slots]
    return obj.name, *obj.dimensions, *counts, materials
