"""The native node group that approximates a measured material without Velour."""

import bpy

from ..core.approximation import UNFITTED
from ..export.nodes import active_output, approximation_node, first_input
from ..properties.approximation_state import VIEW_ANGLES
from . import approximation_look
from .approximation_image import add_image, add_mapping, add_normals, add_texture, is_open

NAME = "Velour approximation"


def has_layers():
    """Whether the Principled BSDF has the coat and tints that the library fits; no property reveals it."""
    return bpy.app.version >= (4, 0, 0)


def is_editable(material):
    """Whether the material is local; library overrides cannot add nodes."""
    return material.library is None and material.override_library is None


def is_wanted(material):
    """Whether a new model should be approximated: there is an approximation already, or no other shader."""
    outputs = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial"]
    has_shader = any(node.inputs["Surface"].is_linked for node in outputs)
    return is_editable(material) and (approximation_node(material) is not None or not has_shader)


def put(material, approximation=UNFITTED, model=""):
    """Replaces the material's group, and links it if it is the first; does not change other nodes.

    Copies of a material share its group, so it is replaced, never edited. model: SHA-256 of the model that
    it approximates.
    """
    tree, node = material.node_tree, approximation_node(material)
    output = active_output(tree, "ShaderNodeOutputMaterial") or tree.nodes.new("ShaderNodeOutputMaterial")
    is_new, before = node is None, node.node_tree if node else None
    if is_new:
        node = tree.nodes.new("ShaderNodeGroup")
        node.name = node.label = NAME
        node.location = output.location.x - 200, output.location.y
    shown_by = [output.inputs["Surface"]] if is_new else [link.to_socket for link in node.outputs[0].links]
    node.node_tree = None
    _remove(before)  # first, to free its name
    node.node_tree = _group(approximation, material)
    for socket in shown_by:
        tree.links.new(node.outputs[0], socket)
    if not output.inputs["Surface"].is_linked:
        tree.links.new(node.outputs[0], output.inputs["Surface"])
    _remember(node.node_tree.velour, approximation, model)
    approximation_look.follow(material)


def _group(approximation, material):
    group = bpy.data.node_groups.new(NAME, "ShaderNodeTree")
    if hasattr(group, "interface"):  # 4.0 and newer
        group.interface.new_socket(name="BSDF", in_out="OUTPUT", socket_type="NodeSocketShader")
    else:
        group.outputs.new("NodeSocketShader", "BSDF")
    sink = group.nodes.new("NodeGroupOutput")
    sink.location = 600, 0
    shader = group.nodes.new("ShaderNodeBsdfPrincipled")
    shader.distribution = "GGX"  # as fitted: without multiple scattering between facets
    if approximation.anisotropic > 0:
        _turn(group, shader)
    base = group.nodes.new("ShaderNodeBsdfDiffuse") if max(approximation.diffuse) > 0 else None
    if approximation.color_map is not None:
        tiles = add_mapping(group)
        _color(group, shader, tiles, approximation, material)
        if approximation.normal_map is not None:
            image = add_normals(f"{material.name} normals", approximation.normal_map)
            _relief(group, add_texture(group, image, tiles, -320), shader, base)
    last = _with_base(group, shader, base) if base else shader
    group.links.new(last.outputs[0], sink.inputs[0])
    return group


def _color(group, shader, tiles, approximation, material):
    pixels = approximation.color_map
    texture = add_texture(group, add_image(f"{material.name} approximation", pixels), tiles)
    dye = group.nodes.new("ShaderNodeMix")
    dye.location = -180, 160
    dye.data_type, dye.blend_type, dye.clamp_result = "RGBA", "MULTIPLY", True
    factor, color, _dye = (socket for socket in dye.inputs if socket.enabled)
    factor.default_value = 1.0
    group.links.new(texture.outputs["Color"], color)
    group.links.new(next(socket for socket in dye.outputs if socket.enabled), shader.inputs["Base Color"])
    if is_open(pixels):
        group.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        if hasattr(material, "shadow_method"):  # EEVEE before 4.2 requires it
            material.blend_method = material.shadow_method = "HASHED"


def _relief(group, texture, shader, base):
    """Adds the normal map, rotated like the tile, since tangents are those of the texture coordinates."""
    turn, relief = group.nodes.new("ShaderNodeVectorRotate"), group.nodes.new("ShaderNodeNormalMap")
    turn.rotation_type = "Z_AXIS"
    turn.inputs["Center"].default_value = 0.5, 0.5, 0.5  # color of an untilted normal
    turn.location, relief.location = (-360, -460), (-180, -460)
    group.links.new(texture.outputs["Color"], turn.inputs["Vector"])
    group.links.new(turn.outputs["Vector"], relief.inputs["Color"])
    parts = [shader.inputs["Normal"], first_input(shader, "Coat Normal", "Clearcoat Normal")]
    for socket in (*parts, *([base.inputs["Normal"]] if base else ())):
        group.links.new(relief.outputs["Normal"], socket)


def _turn(group, shader):
    """Aligns anisotropy with the texture coordinates, as for measured materials."""
    tangent = group.nodes.new("ShaderNodeTangent")
    tangent.direction_type = "UV_MAP"
    tangent.location = -220, -300
    group.links.new(tangent.outputs[0], shader.inputs["Tangent"])


def _with_base(group, shader, base):
    base.location = 0, 160
    both = group.nodes.new("ShaderNodeAddShader")
    both.location = 400, 0
    for number, part in enumerate((shader, base)):
        group.links.new(part.outputs[0], both.inputs[number])
    return both


def _remove(group):
    """Removes a group and its images, unless copies of the material use them."""
    if group is None or group.users > 0:
        return
    images = [node.image for node in group.nodes if node.bl_idname == "ShaderNodeTexImage" and node.image]
    bpy.data.node_groups.remove(group)
    for image in images:
        if image.users == 0:
            bpy.data.images.remove(image)


def _remember(state, approximation, model):
    state.is_approximation, state.model = True, model
    state.fitted = approximation_look.kept(approximation)
    errors = {"": approximation.relative_l2, **approximation.by_view_angle}
    state.relative_l2, *by_angle = (
        -1.0 if errors.get(angle) is None else errors[angle] for angle in ("", *VIEW_ANGLES)
    )
    state.by_view_angle = by_angle
