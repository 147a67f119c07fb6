"""Persistent Data: keeps the scene of a final render for the next frame, which updates what has changed.

Blender then also keeps the engine and the depsgraph, whose updates are those since the previous frame.
"""

import contextlib
import weakref

import bpy

from ..export import Notes
from ..export.look import scene_key
from ..export.nodes import model_names
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
    def frame(self, depsgraph, strict, asked, moves):
        """The SceneExport of a frame, which is not kept after an error, a cancel, or a frame with motion, of
        which changes between frames say nothing."""
        export = self._followed(depsgraph, strict and not moves, asked) or SceneExport(Notes(), strict, asked)
        try:
            yield export
        except BaseException:
            export.close()
            raise
        # A scene model may replace a material in one frame but not in the next.
        if strict and not moves and _is_persistent(depsgraph) and not export.materials.reduced:
            self._export, self._key = export, _key(depsgraph, asked)
        else:
            export.close()

    def _followed(self, depsgraph, strict, asked):
        """The kept export, updated, if it can be reused; the caller then owns it."""
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
    """State that a kept scene cannot update, or whose changes Blender does not always report."""
    world = shown_world(depsgraph)
    # Render results have no color space; reading it prints a warning.
    images = tuple(_image_key(image) for image in bpy.data.images if image.source != "VIEWER")
    materials = tuple(map(_material_key, bpy.data.materials))
    return scene_key(depsgraph), world and world.original.as_pointer(), frozenset(asked), images, materials


def _image_key(image):
    space = image.colorspace_settings.name
    return image.name_full, image.filepath, image.source, image.alpha_mode, space, image.velour.sha256


def _material_key(material):
    """Includes the images of measured nodes, whose changes are not reported as the nodes are not linked."""
    return material.name_full, material.pass_index, model_names(material)


@bpy.app.handlers.persistent
def _forget(*_arguments):
    """After undo, redo and loading, other datablocks may lie at the addresses of exported ones."""
    for kept in tuple(_all):
        kept.is_stale = True  # not closed: a render thread may be using it


def _handlers():
    handlers = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post, handlers.load_post


def attach():
    for handlers in _handlers():
        handlers.append(_forget)


def detach():
    for handlers in _handlers():
        handlers.remove(_forget)
