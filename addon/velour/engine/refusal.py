"""Why a viewport is not in real time though it should be, and when that is worth another look."""

import bpy

from ..export.changes import Changes
from ..export.nodes import velour_node
from ..realtime import shaders


class Refusal:
    """`is_curable`: by the scene; else by choosing the mode anew alone."""

    def __init__(self, reason, is_curable, depsgraph):
        self.sentence = f"Not in real time: {reason}"
        self._known = _what_counts(depsgraph) if is_curable and shaders.all_compile() else None

    def may_be_over(self, depsgraph):
        """Of a changed scene: whether it has another number of objects or lamps, or another measurement.

        What moves or is coloured cures nothing, and is not tried in real time at each step.
        """
        if self._known is None:
            return False
        return Changes(depsgraph.updates).everything or self._known != _what_counts(depsgraph)


def _what_counts(depsgraph):
    lamps = instances = 0
    for instance in depsgraph.object_instances:
        lamps += instance.object.type == "LIGHT"
        instances += 1
    return lamps, instances, _measurements(depsgraph)


def _measurements(depsgraph):
    """Names of the images of measured materials, by material."""
    materials = (block for block in depsgraph.ids if isinstance(block, bpy.types.Material))
    nodes = {material.name_full: velour_node(material) for material in materials}
    return {name: node.image and node.image.name_full for name, node in nodes.items() if node}
