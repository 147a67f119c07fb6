"""Where the result of a job goes: found again whatever was done to the file meanwhile."""

import uuid

import bpy


def key_of(datablock):
    """Its key in the list of bpy.data: no pointer, for undo replaces datablocks."""
    return (datablock.name, datablock.library.filepath) if datablock.library else datablock.name


class JobTarget:
    """A measured material's node, by a mark on it and by names: undo may replace any datablock."""

    def __init__(self, material, node):
        self.material_name, self._node_name = material.name, node.name
        self._mark = node.velour.job = uuid.uuid4().hex

    def find(self):
        """The material and its node, also where they were renamed; (None, None) where they are gone."""
        material, node = next(self._marked(), (None, None))
        if node is not None:
            return material, node
        # An undo to what was before the mark takes it away.
        material = bpy.data.materials.get(self.material_name)
        node = material.node_tree.nodes.get(self._node_name) if material and material.node_tree else None
        return (material, node) if node is not None else (None, None)

    def _marked(self):
        """A copy has the mark as well: the original, if it is still called what it was, comes first."""
        for material in sorted(bpy.data.materials, key=lambda m: m.name != self.material_name):
            for node in material.node_tree.nodes if material.node_tree else ():
                if node.bl_idname == "ShaderNodeTexImage" and node.velour.job == self._mark:
                    yield material, node
