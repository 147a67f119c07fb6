"""Displaces surfaces by the relief of a BTF in Cycles."""

import bpy
from bpy.props import BoolProperty

from ..export import ExportError
from ..export.nodes import active_output
from . import approximation_group, measured, measured_group
from .approximation_image import images_of


class VELOUR_OT_displace(measured.OfMaterial, bpy.types.Operator):
    bl_idname = "velour.displace"
    bl_label = "Displace by Relief"
    bl_description = (
        "In Cycles, displace the surface by the relief of the BTF in place of its normal map. The mesh needs"
        " a Subdivision Surface modifier, with adaptive subdivision if possible. Velour itself shows the BTF"
    )
    bl_options = {"REGISTER", "UNDO"}

    enable: BoolProperty(name="Displace", default=True)

    def execute(self, context):
        try:
            material = measured.wanted_material(context, self.material)
            node = measured.modelled_node(material)
            measured.refuse_linked(material)
            measured.refuse_linked_group(material, node)
            if not _can_set(node, self.enable):
                raise ExportError(
                    f"Material '{material.name}' has no relief for other engines; press Refresh under"
                    " Approximation. A flat BTF has none."
                )
            socket = _displacement_socket(material, node)
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        # Materials that share the group keep their normal map: their outputs are not linked here.
        self._displace(material, measured_group.make_single_user(node), socket)
        return {"FINISHED"}

    def _displace(self, material, node, socket):
        node.group.node_tree.velour.displaces = self.enable
        approximation_group.rebuild(node, material)
        ours = node.group.outputs[approximation_group.DISPLACEMENT]
        if self.enable:
            material.node_tree.links.new(ours, socket)
            # Bump shows what the faces of the mesh are too large for.
            _set_method(material, "BOTH")
        else:
            for link in list(socket.links):
                if link.from_socket == ours:
                    material.node_tree.links.remove(link)
            _set_method(material, "BUMP")


def _can_set(node, enable):
    """Whether the group of a MeasuredNode has a relief; one that has lost it in a fit can be disabled."""
    tree = node.group and node.group.node_tree
    return tree and (images_of(tree).height is not None or (tree.velour.displaces and not enable))


def _displacement_socket(material, node):
    """The input that displaces a material; raises ExportError if its MeasuredNode cannot be linked to it."""
    output = active_output(material.node_tree, "ShaderNodeOutputMaterial")
    if output is None:
        raise ExportError(f"Material '{material.name}' has no Material Output node; add one, then try again.")
    if node.group.id_data != material.node_tree:
        raise ExportError(
            f"Material '{material.name}': node '{node.name}' is inside a node group and cannot be linked to"
            " the Material Output; ungroup it, then try again."
        )
    return output.inputs["Displacement"]


def _set_method(material, method):
    owner = material if hasattr(material, "displacement_method") else material.cycles  # 4.1 and newer
    owner.displacement_method = method
