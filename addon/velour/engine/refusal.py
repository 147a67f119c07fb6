"""Why a viewport cannot show the scene in real time, and when to try again."""

import bpy

from ..export.changes import Changes
from ..export.nodes import all_measured
from ..realtime import shaders

_MATERIALS = (bpy.types.Material, bpy.types.NodeTree)


class Refusal:
    """`is_curable`: a change of the scene may end it; otherwise only choosing the mode again does."""

    def __init__(self, reason, is_curable, depsgraph):
        self.sentence = f"Not in real time: {reason}"
        self._is_curable = is_curable and shaders.all_compile()
        if self._is_curable:
            self._numbers, self._measurements = _numbers(depsgraph), _measurements(depsgraph)

    def may_be_over(self, depsgraph):
        """Whether a changed scene has another number of objects or lights, or renders another model.

        Movements and colors end no refusal, so they cause neither a try in real time at each step nor a
        count, which would visit each instance.
        """
        if not self._is_curable:
            return False
        updates = depsgraph.updates
        if Changes(updates).everything:
            return True
        some_come = any(map(_may_come_or_go, updates))
        if some_come and self._numbers != _numbers(depsgraph):
            return True
        is_material = any(isinstance(update.id, _MATERIALS) for update in updates)
        return (some_come or is_material) and self._measurements != _measurements(depsgraph)


def _may_come_or_go(update):
    """Whether the update may have added or removed objects or instances."""
    if isinstance(update.id, bpy.types.Object):
        return update.is_updated_geometry and update.id.type != "LIGHT"
    return isinstance(update.id, (bpy.types.Scene, bpy.types.Collection))


def _numbers(depsgraph):
    """Numbers of lights and of all instances."""
    lamps = instances = 0
    for instance in depsgraph.object_instances:
        lamps += instance.object.type == "LIGHT"
        instances += 1
    return lamps, instances


def _measurements(depsgraph):
    """Images and settings that choose what measured materials render from, by material."""
    materials = (block for block in depsgraph.ids if isinstance(block, bpy.types.Material))
    return {material.name_full: tuple(map(_rendered, all_measured(material))) for material in materials}


def _rendered(node):
    settings = node.velour
    names = tuple(image and image.name_full for image in (node.image, settings.scene_model))
    return *names, settings.use_scene_model, settings.use_reference
