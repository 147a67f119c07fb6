"""Node values of an approximation: the fit, modified by the material's look and placement."""

import json
import math

import bpy

from ..core.approximation_look import Look, dyed, with_look
from ..export.color import rec709_to_working
from ..export.measured_materials import gain
from ..export.nodes import approximation_node, first_input, velour_node
from ..properties import changed
from .approximation_image import place

# The library's names: names of Blender's sockets across versions. The tint is set on color sockets only:
# before Blender 4.0 it is a number with another meaning.
_SOCKETS = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "coat": ("Coat Weight", "Clearcoat"),
    "coat_roughness": ("Coat Roughness", "Clearcoat Roughness"),
}


def kept(approximation):
    """Input of `follow` as JSON, to be stored in the group; colors are in the working space."""
    principled = {**approximation.principled, "base_color": _working(approximation.principled["base_color"])}
    return json.dumps(
        {
            "principled": principled,
            "diffuse": _working(approximation.diffuse),
            "color": _working(approximation.color),
            "anisotropic": approximation.anisotropic,
            "turned": approximation.turned,
            "tile_metres": approximation.tile_metres,
        }
    )


def follow(material):
    """Updates the nodes of the material's approximation, and its look in Solid mode, from its settings."""
    node, measured = approximation_node(material), velour_node(material)
    if node is None or measured is None or not _can_write(material, node.node_tree):
        return
    if node.node_tree.users > 1:  # a copy of the material uses it, too
        node.node_tree = node.node_tree.copy()
    settings, group = measured.velour, node.node_tree
    fitted = json.loads(group.velour.fitted)
    look = Look(gain(settings), settings.roughness)
    shown = with_look(fitted, look)
    nodes = {part.bl_idname: part for part in group.nodes}
    for idname, show in _SHOW.items():
        if idname in nodes:
            show(nodes[idname], shown, settings.placement, look)
    material.diffuse_color = _rgba(dyed(fitted["color"], look.gain))
    material.metallic, material.roughness = (shown["principled"][k] for k in ("metallic", "roughness"))


def _show_principled(shader, shown, placement, _look):
    for name, value in shown["principled"].items():
        socket = first_input(shader, *_SOCKETS[name])
        if hasattr(socket.default_value, "__len__"):
            socket.default_value = _rgba(value)
        elif name != "specular_tint":
            socket.default_value = value
    shader.inputs["IOR"].default_value = 1.5  # levels are fitted for it; Blender 4.0's default is 1.45
    turns = placement.rotation / math.tau + (0.25 if shown["turned"] else 0.0)
    shader.inputs["Anisotropic"].default_value = shown["anisotropic"]
    shader.inputs["Anisotropic Rotation"].default_value = turns % 1.0 if shown["anisotropic"] > 0 else 0.0


def _show_base(base, shown, _placement, _look):
    base.inputs["Color"].default_value = _rgba(shown["diffuse"])


def _show_dye(dye, _shown, _placement, look):
    colors = [socket for socket in dye.inputs if socket.enabled and socket.type == "RGBA"]
    colors[1].default_value = _rgba(look.gain)


def _show_uv_map(node, _shown, placement, _look):
    node.uv_map = placement.uv_map


def _show_mapping(mapping, shown, placement, _look):
    place(mapping, placement, shown["tile_metres"])


def _show_turn(turn, _shown, placement, _look):
    turn.inputs["Angle"].default_value = placement.rotation


# A group has at most one node of each type.
_SHOW = {
    "ShaderNodeBsdfPrincipled": _show_principled,
    "ShaderNodeBsdfDiffuse": _show_base,
    "ShaderNodeMix": _show_dye,
    "ShaderNodeUVMap": _show_uv_map,
    "ShaderNodeTangent": _show_uv_map,
    "ShaderNodeNormalMap": _show_uv_map,
    "ShaderNodeMapping": _show_mapping,
    "ShaderNodeVectorRotate": _show_turn,
}


def _can_write(material, group):
    """Whether both are local, and the group stores its fitted values."""
    libraries = material.library, material.override_library, group.library
    return not any(libraries) and group.velour.fitted != ""


def _follow_tree(tree):
    material = next((material for material in bpy.data.materials if material.node_tree == tree), None)
    if material is not None:
        follow(material)


def attach():
    changed.listeners.append(_follow_tree)


def detach():
    changed.listeners.remove(_follow_tree)


def _working(color):
    """Converts linear Rec. 709 to Blender's scene-linear space."""
    return [float(c) for c in rec709_to_working() @ color]


def _rgba(color):
    return (*color, 1.0)
