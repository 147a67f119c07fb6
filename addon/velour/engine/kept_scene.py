"""Persistent Data: the scene of a final render is kept for the next frame, which takes what has changed.

With it Blender keeps the engine and the depsgraph, too, whose updates then are those since the frame before.
"""

import contextlib
import weakref

import bpy

from ..export import Notes
from ..export.look import scene_key
from ..export.nodes import velour_node
from ..export.scene import SceneExport
from ..export.world import shown_world

_all = weakref.WeakSet()


class KeptScene:
    def __init__(self):
        self._export = None
        self._key = None
        self.is_stale = False
        _all.add(self)

    def close(self):
        if self._export:
            self._export.close()
        self._export = None

    @contextlib.contextmanager
    def frame(self, depsgraph, strict, asked):
        """The SceneExport of a frame; what goes wrong, or is cancelled, leaves nothing to go on with."""
        export = self._followed(depsgraph, strict, asked) or SceneExport(Notes(), strict, asked)
        try:
            yield export
        except BaseException:
            export.close()
            raise
        # A model for the scene takes a material's place in one frame, and maybe not in the next.
        if strict and _is_persistent(depsgraph) and not export.materials.reduced:
            self._export, self._key = export, _key(depsgraph, asked)
        else:
            export.close()

    def _followed(self, depsgraph, strict, asked):
        """What was kept, if it can go on; it belongs to the caller then."""
        export, self._export = self._export, None
        is_stale, self.is_stale = self.is_stale, False
        if export is None:
            return None
        is_wanted = strict and _is_persistent(depsgraph) and self._key == _key(depsgraph, asked)
        if is_wanted and not is_stale and export.follow(depsgraph):
            return export
        export.close()
        return None


def _is_persistent(depsgraph):
    return depsgraph.scene.render.use_persistent_data


def _key(depsgraph, asked):
    """What a scene that is kept cannot be changed in, or Blender does not always tell of."""
    world = shown_world(depsgraph)
    images = tuple(map(_image_key, bpy.data.images))
    materials = tuple(map(_material_key, bpy.data.materials))
    return scene_key(depsgraph), world and world.original.as_pointer(), frozenset(asked), images, materials


def _image_key(image):
    space = image.colorspace_settings.name
    return image.name_full, image.filepath, image.source, image.alpha_mode, space, image.velour.sha256


def _material_key(material):
    """A measured node is not linked, so nobody hears of another image in it."""
    node = velour_node(material)
    chosen = node and node.image and node.image.name_full
    return material.name_full, material.pass_index, chosen


@bpy.app.handlers.persistent
def _forget(*_arguments):
    """After undo, redo and loading, datablocks of other things may lie where those lay that were exported."""
    for kept in tuple(_all):
        kept.is_stale = True  # a render may be at it, in a thread of its own


def _handlers():
    handlers = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post, handlers.load_post


def attach():
    for handlers in _handlers():
        handlers.append(_forget)


def detach():
    for handlers in _handlers():
        handlers.remove(_forget)
