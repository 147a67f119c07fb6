"""Approximations as other programs see them: the fit, changed by the material's look and placement."""

import json
from typing import NamedTuple

import bpy
import numpy as np

from ..core.approximation_look import Look, dyed, with_look
from ..core.placement import repeats_of
from ..export.color import rec709_color_to_working
from ..export.measured_look import constant_look
from ..export.nodes import (
    active_output,
    approximation_node,
    first_input,
    measured_nodes,
    nodes_of,
    source,
    velour_node,
)
from ..export.units import metres_per_unit
from ..export.uv_maps import linked_uv_map, placed_by
from ..properties import changed
from .approximation_image import built_nodes, height_range, middle_of

# The library's names: names of Blender's sockets across versions.
_SOCKETS = {
    "base_color": ("Base Color",),
    "metallic": ("Metallic",),
    "roughness": ("Roughness",),
    "specular": ("Specular IOR Level", "Specular"),
    "specular_tint": ("Specular Tint",),
    "coat": ("Coat Weight", "Clearcoat"),
    "coat_roughness": ("Coat Roughness", "Clearcoat Roughness"),
}
_WITH_UV_MAP = ("ShaderNodeTangent", "ShaderNodeNormalMap", "ShaderNodeUVMap")
HEIGHT = "Height of Relief"  # label of the node with the height for one repeat, in Blender units
_NEGLIGIBLE = 1e-6


class Placed(NamedTuple):
    """Placement of tiles: uv - offset, rotated clockwise by `rotation` (radians), times `repeats`."""

    uv_map: str  # "": the active render map
    offset: tuple
    rotation: float
    repeats: tuple


class Shown(NamedTuple):
    """A measured material as constants."""

    principled: dict  # as of core/approximation.Approximation, in the working space
    diffuse: tuple
    color: tuple
    gain: tuple
    placed: Placed


def kept(approximation):
    """An approximation as JSON, to be stored in the group; colors are linear Rec. 709."""
    height = approximation.height_map
    return json.dumps(
        {
            "principled": approximation.principled,
            "diffuse": approximation.diffuse,
            "color": approximation.color,
            "anisotropic": approximation.anisotropic,
            "turned": approximation.turned,
            "tile_metres": approximation.tile_metres,
            "height": 0.0 if height is None else height_range(height),
            "middle": 0.5 if height is None else middle_of(height),
            "closures": approximation.closures and _rounded(approximation.closures),
        }
    )


def stored(tree):
    """The values that kept() has stored in a tree."""
    return json.loads(tree.velour.fitted)


def fitted(tree):
    """The values that kept() has stored in a tree, with colors in the working space; closures keep theirs."""
    values = stored(tree)
    for owner, names in (
        (values["principled"], ("base_color", "specular_tint")),
        (values, ("diffuse", "color")),
    ):
        owner.update({name: rec709_color_to_working(owner[name]) for name in names})
    return values


def shown(material):
    """The Shown of a measured material; None if it has no approximation."""
    group, node = approximation_node(material), velour_node(material)
    if group is None or node is None or not group.node_tree.velour.fitted:
        return None
    values, look = fitted(group.node_tree), constant_look(node)
    found = with_look(values, Look(look.gain, look.roughness))
    placement = node.velour.placement
    repeats = tuple(r / look.scale for r in _repeats(placement, values["tile_metres"]))
    placed = Placed(placed_by(node), tuple(placement.offset), look.rotation, repeats)
    color = dyed(values["color"], look.gain)
    return Shown(found["principled"], tuple(found["diffuse"]), color, look.gain, placed)


def is_surface(material):
    """Whether the approximation alone is the surface of a material."""
    output = active_output(material.node_tree, "ShaderNodeOutputMaterial")
    return output is not None and source(output.inputs["Surface"]) == approximation_node(material)


def follow(material):
    """Updates what Blender's nodes cannot: the material in Solid mode, and inputs for its placement."""
    node, values = velour_node(material), shown(material)
    if values is None or node.group is None or not _is_local(material):
        return
    _set(material, "diffuse_color", (*values.color, 1.0))
    for name in ("metallic", "roughness"):
        _set(material, name, values.principled[name])
    for each in measured_nodes(material.node_tree):
        _place(each)


def _place(node):
    """Writes the placement of a MeasuredNode into its inputs, and into nodes that name its UV map."""
    group, placement = node.group, node.velour.placement
    if group.id_data.library is not None:
        return
    if "Repeats" in group.inputs:
        repeats = _repeats(placement, stored(group.node_tree)["tile_metres"])
        for name, value in (("Repeats", (*repeats, 1.0)), ("Offset", (*placement.offset, 0.0))):
            socket = group.inputs[name]
            _set(socket, "default_value", value)
            _set(socket, "hide", not socket.is_linked)  # of Velour, not of the artist
    if group.node_tree.library is None and _leads(group):
        for part in built_nodes(group.node_tree, *_WITH_UV_MAP):
            _set(part, "uv_map", placed_by(node))
        for part in built_nodes(group.node_tree, "ShaderNodeMath"):
            if part.label == HEIGHT:
                height = stored(group.node_tree)["height"] / _density_per_unit(placement)
                _set(part.inputs[1], "default_value", height)


def _leads(group):
    """Whether a node is the first that uses its group. The nodes in the group follow this one alone: each
    time that others changed them, the scene would be updated again, without end."""
    return group.node_tree.users == 1 or nodes_of(group.node_tree)[:1] == [group]


def socket_of(shader, name):
    """The socket of a Principled BSDF by the library's name."""
    return first_input(shader, *_SOCKETS[name])


def set_value(shader, name, value):
    socket = socket_of(shader, name)
    if hasattr(socket.default_value, "__len__"):
        socket.default_value = (*value, 1.0)
    elif name != "specular_tint":  # a number with another meaning before Blender 4.0
        socket.default_value = value


def _repeats(placement, metres):
    """Repeats per unit of texture coordinates."""
    if placement.mode == "REPEATS":
        return tuple(placement.repeats)
    return repeats_of(placement.tile_metres(metres) or (1.0, 1.0), placement.density())


def _density_per_unit(placement):
    """Density of u per Blender unit; 1 unless one was entered."""
    metres = metres_per_unit(bpy.context.scene)
    return metres * placement.density((1 / metres,) * 2)[0]


def _set(owner, name, value):
    """Sets a property only if it changes, since setting one updates the scene again."""
    if not _is_same(value, getattr(owner, name)):
        setattr(owner, name, value)


def _is_same(a, b):
    if isinstance(a, str):
        return a == b
    return bool(np.allclose(a, b, rtol=0, atol=_NEGLIGIBLE))


def _is_local(material):
    return material.library is None and material.override_library is None


def _placement_changed(tree):
    """Called with the tree that contains the node whose placement has changed."""
    for node in measured_nodes(tree):
        _place(node)


def _uv_map_changed(placement):
    """Sets the UV Map node that is linked to the node of a placement."""
    for node in measured_nodes(placement.id_data):
        linked = linked_uv_map(node)
        if linked is not None and node.velour.placement == placement:
            linked.uv_map = placement.uv_map


def attach():
    changed.listeners.append(_placement_changed)
    changed.uv_map_listeners.append(_uv_map_changed)


def detach():
    changed.uv_map_listeners.remove(_uv_map_changed)
    changed.listeners.remove(_placement_changed)


def _rounded(closures):
    """The curves alone, with as many digits as nodes keep."""
    lobes = [{key: _digits(value) for key, value in lobe.items()} for lobe in closures["lobes"]]
    kept = {key: closures[key] for key in ("masking", "frame")}
    return {**kept, "diffuse": _digits(closures["diffuse"]), "lobes": lobes}


def _digits(values):
    if isinstance(values, list):
        return [_digits(value) for value in values]
    return values if isinstance(values, str) else float(f"{values:.6g}")
