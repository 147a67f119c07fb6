"""Converts materials of the former layout, whose model and settings are in a muted Image Texture node."""

import bpy
from bpy.props import StringProperty

from ..export import ExportError
from ..export.files import StoredFile
from ..export.measured_look import INPUTS, former_look
from ..export.nodes import active_output, approximation_node, former_node, source
from ..native import VelourError
from . import approximation_group, approximation_look, measured_group
from .approximation_image import TileImages, images_of, shows_behind

# Settings of the former node that are inputs now, or belong to the model.
_ELSEWHERE = ("enabled", "tint", "exposure", "roughness", "rotation", "neighbors", "job")


class VELOUR_OT_convert_materials(bpy.types.Operator):
    bl_idname = "velour.convert_materials"
    bl_label = "Convert to Node Group"
    bl_description = (
        "Make the model a node group that can be mixed with other shaders. Renders by Velour do not change"
    )
    bl_options = {"REGISTER", "UNDO"}

    material: StringProperty(
        name="Material",
        description="Name of the material. Empty: all local materials of the file",
        options={"SKIP_SAVE"},
    )

    def execute(self, _context):
        if self.material and self.material not in bpy.data.materials:
            self.report({"ERROR"}, f"There is no material {self.material!r}.")
            return {"CANCELLED"}
        asked = [bpy.data.materials[self.material]] if self.material else bpy.data.materials
        former = [material for material in asked if former_node(material) is not None]
        local = [material for material in former if approximation_group.is_editable(material)]
        for material in set(former) - set(local):
            self.report(
                {"ERROR" if self.material else "WARNING"},
                f"Material '{material.name}' is linked from another file; convert it there or make it local.",
            )
        for material in local:
            shader = _own_shader(material)
            convert(material)
            if shader:
                self.report(
                    {"WARNING"}, f"Material '{material.name}': node '{shader}' is kept, but no longer linked."
                )
        self.report({"INFO"}, f"Converted {len(local)} of {len(former)} materials of the former layout.")
        return {"FINISHED"} if local or not former else {"CANCELLED"}


def convert(material):
    """Replaces the node of a local material of the former layout by a group; returns the MeasuredNode."""
    former, approximation = former_node(material), approximation_node(material)
    tree, settings, name = material.node_tree, former.velour, former.name
    node = measured_group.add(material)
    node.image = former.image
    node.texture.velour.neighbors = settings.neighbors
    _copy_settings(settings, node.velour)
    _build(node, material, approximation)
    look = former_look(settings)
    for field, socket in _inputs_of(node).items():
        value = getattr(look, field)
        socket.default_value = (*value, 1.0) if field == "tint" else value
    former.texture.name, node.group.name = "Former", name  # F-curves follow the names
    _follow_animation(tree, former.name, node)
    tree.nodes.remove(former.texture)  # with F-curves that still point to it
    if approximation is not None:
        _remove(tree, approximation)
    approximation_look.follow(material)
    return node


def _copy_settings(given, target):
    """Copies the set properties of a material's settings, with the groups in them."""
    for prop in given.bl_rna.properties:
        name = prop.identifier
        if name == "rna_type" or name in _ELSEWHERE:
            continue
        value = getattr(given, name)
        if isinstance(value, bpy.types.PropertyGroup):
            _copy_settings(value, getattr(target, name))
        elif given.is_property_set(name):
            setattr(target, name, value)


def _build(node, material, approximation):
    """Gives the group the inputs of its model, and the nodes of the former group."""
    tree, found, is_seen_through = node.group.node_tree, TileImages(), False
    if approximation is not None and approximation.node_tree.velour.fitted:
        before = approximation.node_tree
        _copy_settings(before.velour, tree.velour)
        found, is_seen_through = images_of(before), shows_behind(before)
    approximation_group.build(node, material, _info(node, found.colors), found, is_seen_through)


def _info(node, colors):
    """Info of the model; if its file is missing, what is known without it."""
    try:
        return StoredFile.of(node.image, "The material").model_info() if node.image else {}
    except (ExportError, VelourError):
        return {"texels": None} if colors else {"isotropic": False}


def _inputs_of(node):
    sockets = {field: node.group.inputs.get(name) for field, name in INPUTS.items()}
    return {field: socket for field, socket in sockets.items() if socket is not None}


def _follow_animation(tree, name, node):
    """Points F-curves and drivers of the node called `name` to another; those of the look to its inputs."""
    animation = tree.animation_data
    if animation is None:
        return
    before, after = (f'nodes["{bpy.utils.escape_identifier(n)}"].' for n in (name, node.name))
    paths = {}
    for field, socket in _inputs_of(node).items():
        place = "placement.rotation" if field == "rotation" else field
        number = list(node.group.inputs).index(socket)
        paths[f"{before}velour.{place}"] = f"{after}inputs[{number}].default_value"
    for curve in (*_curves(animation), *animation.drivers):
        path = curve.data_path
        if path.startswith(before):
            curve.data_path = paths.get(path, after + path.removeprefix(before))


def _curves(animation):
    """The F-curves of an AnimData; those of other slots of its action animate other datablocks."""
    if animation.action is None:
        return ()
    if not hasattr(animation, "action_slot"):  # before 4.4
        return animation.action.fcurves
    strips = (strip for layer in animation.action.layers for strip in layer.strips)
    bags = (strip.channelbag(animation.action_slot) for strip in strips if animation.action_slot)
    return [curve for bag in bags if bag for curve in bag.fcurves]


def _own_shader(material):
    """Name of the node of a surface that is not the approximation; "" if there is none."""
    output = active_output(material.node_tree, "ShaderNodeOutputMaterial")
    shader = output and source(output.inputs["Surface"])
    return shader.name if shader and shader != approximation_node(material) else ""


def _remove(tree, approximation):
    """Removes a former group, unless copies of the material use it."""
    group = approximation.node_tree
    tree.nodes.remove(approximation)
    if group.users == 0:
        bpy.data.node_groups.remove(group)
