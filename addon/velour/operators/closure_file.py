"""Writes a .blend file with a material of Blender's own nodes; Velour need not be enabled."""

import json
from pathlib import Path

import bpy

from .closure_network import build

_INPUTS = {
    "Tint": "NodeSocketColor",
    "Exposure": "NodeSocketFloat",
    "Roughness": "NodeSocketFloat",
    "Normal": "NodeSocketVector",
    "Rotation": "NodeSocketFloat",  # of anisotropic measurements
}
_WHITE = (1.0, 1.0, 1.0, 1.0)


def write_from(order):
    """Calls write() with the keywords in a JSON file."""
    write(**json.loads(Path(order).read_text(encoding="utf-8")))


def write(path, name, closures, note):
    """Writes the material and its node group, both named `name` and marked as an asset; `note` describes it.

    The open file does not change.
    """
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    material = bpy.data.materials.new(name)
    try:
        _fill(group, closures)
        _show(material, group)
        material.asset_mark()
        material.asset_data.description = note
        bpy.data.libraries.write(path, {material}, fake_user=True, compress=True)
    finally:
        bpy.data.materials.remove(material)
        bpy.data.node_groups.remove(group)


def _fill(group, closures):
    names = [name for name in _INPUTS if name != "Rotation" or closures.get("frame") == "surface"]
    _add_socket(group, "BSDF", "NodeSocketShader", "OUTPUT")
    for name in names:
        _add_socket(group, name, _INPUTS[name], "INPUT")
    source, sink = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    controls = {name.lower(): source.outputs[name] for name in names}
    bsdf = build(group, closures, **controls)
    group.links.new(bsdf, sink.inputs[0])
    x, y = bsdf.node.location
    source.location, sink.location = (-300, 0), (x + 250, y)


def _add_socket(group, name, kind, in_out):
    if hasattr(group, "interface"):  # Blender 4.0 and newer
        socket = group.interface.new_socket(name=name, in_out=in_out, socket_type=kind)
    else:
        socket = (group.outputs if in_out == "OUTPUT" else group.inputs).new(kind, name)
    if name == "Tint":
        socket.default_value = _WHITE
    elif name == "Normal":
        socket.hide_value = True


def _show(material, group):
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shown, sink = nodes.new("ShaderNodeGroup"), nodes.new("ShaderNodeOutputMaterial")
    shown.node_tree, shown.name, shown.width = group, group.name, 200
    sink.location = 300, 0
    shown.inputs["Tint"].default_value = _WHITE
    material.node_tree.links.new(shown.outputs[0], sink.inputs["Surface"])
