"""Updates the color of measured materials in Solid mode, since inputs of nodes call no callback."""

import bpy
from bpy.app.handlers import persistent

from ..operators.approximation_look import follow


def attach():
    bpy.app.handlers.depsgraph_update_post.append(_follow)


def detach():
    bpy.app.handlers.depsgraph_update_post.remove(_follow)


@persistent
def _follow(_scene, depsgraph):
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Material):
            follow(update.id.original)
