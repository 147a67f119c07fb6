"""Missing linked .blend files."""

import os

import bpy

from .files import FIND
from .notes import ExportError
from .world import layer_world


def refuse_missing_libraries(scene):
    """Raises ExportError if an original scene uses a missing library, whose data would not render."""
    missing = {library.as_pointer() for library in bpy.data.libraries if not _is_there(library)}
    for block in _shown_by(scene) if missing else ():
        library = block.library
        if library is not None and library.as_pointer() in missing:
            kind, path = block.bl_rna.name, _path(library)
            raise ExportError(f"{kind} '{block.name}': its library {path!r} is missing; {FIND}.")


def library_files():
    """Paths of the libraries that are files, those of missing ones left out."""
    paths = [
        _path(library)
        for library in bpy.data.libraries
        if not (library.packed_file or getattr(library, "is_archive", False))  # Blender 5 packs data-blocks
    ]
    return [path for path in paths if os.path.isfile(path)]


def _is_there(library):
    return library.packed_file is not None or os.path.isfile(_path(library))


def _path(library):
    # Relative to the open file, also of libraries of libraries.
    return os.path.normpath(bpy.path.abspath(library.filepath))


def _shown_by(scene):
    """Datablocks that a render of the scene uses, each once; for missing ones Blender keeps empty ones."""
    worlds = [layer_world(scene, layer) for layer in scene.view_layers]
    materials = [layer.material_override for layer in scene.view_layers]
    waiting, seen = [scene.collection, *worlds, *materials, *_background_collections(scene)], set()
    while waiting:
        block = waiting.pop()
        if block is None or block.as_pointer() in seen:
            continue
        seen.add(block.as_pointer())
        yield block
        waiting += _parts(block)


def _background_collections(scene):
    found = set()
    while (scene := scene.background_set) is not None and scene.name_full not in found:
        found.add(scene.name_full)
        yield scene.collection


def _parts(block):
    if isinstance(block, bpy.types.Collection):
        return [*block.objects, *block.children]
    if isinstance(block, bpy.types.Object):
        slots = [slot.material for slot in block.material_slots]
        override = block.override_library
        groups = [getattr(modifier, "node_group", None) for modifier in block.modifiers]
        reference = override.reference if override else None
        return [block.data, block.instance_collection, *slots, *groups, reference]
    if isinstance(block, bpy.types.NodeTree):
        return [getattr(node, name, None) for node in block.nodes for name in ("node_tree", "image")]
    return [getattr(block, "node_tree", None)]
