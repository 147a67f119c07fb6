"""Why a viewport is not in real time though it should be, and when that is worth another look."""

import bpy

from ..export.changes import Changes
from ..export.nodes import velour_node
from ..realtime import shaders

_MATERIALS = (bpy.types.Material, bpy.types.NodeTree)


class Refusal:
    """`is_curable`: by the scene; else by choosing the mode anew alone."""

    def __init__(self, reason, is_curable, depsgraph):
        self.sentence = f"Not in real time: {reason}"
        self._is_curable = is_curable and shaders.all_compile()
        if self._is_curable:
            self._numbers, self._measurements = _numbers(depsgraph), _measurements(depsgraph)

    def may_be_over(self, depsgraph):
        """Of a changed scene: whether it has another number of objects or lamps, or another measurement.

        What moves or is coloured cures nothing, and is not tried in real time at each step; nor counted, for
        that looks at each instance.
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
    """Whether there may be other objects or instances since."""
    if isinstance(update.id, bpy.types.Object):
        return update.is_updated_geometry and update.id.type != "LIGHT"
    return isinstance(update.id, (bpy.types.Scene, bpy.types.Collection))


def _numbers(depsgraph):
    """Of lamps and of all instances."""
    lamps = instances = 0
    for instance in depsgraph.object_instances:
        lamps += instance.object.type == "LIGHT"
        instances += 1
    return lamps, instances


def _measurements(depsgraph):
    """Names of the images of measured materials, by material."""
    materials = (block for block in depsgraph.ids if isinstance(block, bpy.types.Material))
    nodes = {material.name_full: velour_node(material) for material in materials}
    return {name: node.image and node.image.name_full for name, node in nodes.items() if node}
