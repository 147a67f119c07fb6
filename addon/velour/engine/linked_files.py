"""Files beside the .blend that its scenes read: libraries, images, caches and fonts."""

import glob
import os
import re

import bpy

from ..export.files import absolute_path
from ..export.libraries import library_files
from ..export.sequences import sequence_file, sequence_number

_TILE = re.compile("<UDIM>|<UVTILE>")


def linked_files(frame):
    """Paths in no order, without missing files, and without measured models, which have hashes of their own.
    `frame`: the one whose files of image sequences count."""
    blocks = [*bpy.data.cache_files, *bpy.data.fonts]
    paths = {_path(block.filepath, block) for block in blocks if not getattr(block, "packed_file", None)}
    paths |= {*_mesh_caches(), *_image_files(), *_sequence_files(frame), *library_files()}
    return [path for path in paths if os.path.isfile(path)]


def _path(path, owner):
    return os.path.normpath(bpy.path.abspath(path, library=owner.library))


def _mesh_caches():
    for owner in bpy.data.objects:
        yield from (_path(each.filepath, owner) for each in owner.modifiers if each.type == "MESH_CACHE")


def _image_files():
    for image in bpy.data.images:
        if not image.users or image.packed_file or image.velour.sha256:
            continue
        if image.source == "FILE":
            yield absolute_path(image)
        elif image.source == "TILED":
            yield from glob.iglob(_TILE.sub("*", glob.escape(absolute_path(image))))


def _sequence_files(frame):
    """Worlds alone show image sequences."""
    trees = [*(world.node_tree for world in bpy.data.worlds), *bpy.data.node_groups]
    for node in (node for tree in trees if tree for node in tree.nodes):
        image = node.image if node.bl_idname == "ShaderNodeTexEnvironment" else None
        if image and image.source == "SEQUENCE":
            yield sequence_file(absolute_path(image), sequence_number(node.image_user, frame))
