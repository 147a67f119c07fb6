"""Blender's own nodes in a measured material's group: what engines other than Velour render."""

import bpy
import numpy as np

from ..core.approximation import Steps
from ..export.color import rec709_to_working
from ..export.nodes import first_input, measured_nodes
from ..export.shaders.readers import SEPARABLE_SHADOWS
from ..export.uv_maps import placed_by
from ..properties.approximation_state import VIEW_ANGLES
from . import approximation_look, closure_network, group_inputs
from .approximation_image import (
    COLORS,
    FRAME,
    HEIGHT,
    NORMALS,
    ROUGHNESS,
    TileImages,
    add_images,
    add_mapping,
    add_texture,
    images_of,
    is_built,
    is_open,
    shows_behind,
)
from .look_nodes import LookNodes

_NO_IMAGES = TileImages()
DISPLACEMENT = "Displacement"  # output of the group, if its tile has a relief
# Masking and shadowing of this Blender's Glossy BSDFs, as for Model.closures.
MASKING = "separable" if SEPARABLE_SHADOWS else "correlated"


def has_layers():
    """Whether the Principled BSDF has the coat and tints that the library fits; no property reveals it."""
    return bpy.app.version >= (4, 0, 0)


def steps(model):
    """The jobs that approximate a model with this Blender's shaders."""
    return Steps(model, has_layers(), MASKING)


def mismatch(tree):
    """A sentence if the nodes of a group are not right in this Blender; otherwise ""."""
    if not tree.velour.model:
        return ""
    closures = approximation_look.stored(tree).get("closures")
    if closures and closures.get("masking", MASKING) != MASKING:
        return "The nodes were fitted for other versions of Blender."
    if not np.allclose(tree.velour.to_working, rec709_to_working().ravel(), atol=1e-3):
        return "The nodes are in another working color space."
    return ""


def is_editable(material):
    """Whether the material is local; library overrides cannot add nodes."""
    return material.library is None and material.override_library is None


def put(node, material, approximation, info=None, model=""):
    """Replaces the approximation in a MeasuredNode's group.

    info: the model's, None without a model. model: SHA-256 of the model that is approximated.
    """
    tree = node.group.node_tree
    fed = _clear(tree)  # first, to free the names of the images
    images = add_images(tree.name, approximation)
    _remember(tree.velour, approximation, model)
    is_seen_through = images.colors is not None and is_open(approximation.color_map)
    build(node, material, info or {}, images, is_seen_through, fed)


def build(node, material, info, images=_NO_IMAGES, is_seen_through=False, fed=()):
    """Builds the nodes from the state of a MeasuredNode's group.

    images: TileImages. fed: sockets to link to the result, beside those that the former nodes feed.
    """
    fed = {*fed, *_clear(node.group.node_tree)}
    put_inputs(node, material, info)
    _build(node.group.node_tree, material, images, is_seen_through, fed)


def rebuild(node, material):
    """Builds the nodes of a MeasuredNode's group once more, from its state and its images."""
    tree = node.group.node_tree
    images, is_seen_through = images_of(tree), shows_behind(tree)
    _build(tree, material, images, is_seen_through, _clear(tree, keeps_images=True))


def _build(tree, material, images, is_seen_through, fed):
    tree.velour.to_working = rec709_to_working().ravel()
    source, sink = _only(tree, "NodeGroupInput", (-1300, 0)), _only(tree, "NodeGroupOutput", (600, 0))
    others = set(tree.nodes)
    fitted = approximation_look.fitted(tree)
    if fitted.get("closures"):
        shader = _network(tree, source, fitted["closures"])
    else:
        shader = _principled(tree, source, sink, fitted, images, is_seen_through)
    frame = tree.nodes.new("NodeFrame")
    frame.name = frame.label = FRAME
    for added in set(tree.nodes) - others - {frame}:
        added.parent = added.parent or frame
    surface = next(socket for socket in sink.inputs if socket.type == "SHADER")
    for socket in fed if surface.is_linked else {*fed, surface}:
        tree.links.new(shader, socket)
    for user, _node in _users(tree) if is_seen_through else ():
        if hasattr(user, "shadow_method"):  # EEVEE before 4.2 requires it
            user.blend_method = user.shadow_method = "HASHED"
    _follow(tree, material)


def put_inputs(node, material, info):
    """Gives a MeasuredNode's group the inputs of a model."""
    tree = node.group.node_tree
    group_inputs.put(tree, group_inputs.wanted(info))
    for _material, each in _users(tree):
        _link_coordinates(each)
    _follow(tree, material)


def _users(tree):
    """Each local material that uses a group, with its MeasuredNode; once for each of several nodes."""
    return [
        (material, node)
        for material in bpy.data.materials
        if is_editable(material) and material.node_tree is not None
        for node in measured_nodes(material.node_tree)
        if node.group.node_tree == tree and node.group.id_data.library is None
    ]


def _follow(tree, material):
    """Updates the materials that use a group, and `material`."""
    for user, _node in _users(tree):
        approximation_look.follow(user)
    approximation_look.follow(material)


def _network(tree, source, closures):
    """Adds the closures of a BRDF; returns their output."""
    names = {"tint": "Tint", "normal": "Normal", "exposure": "Exposure", "roughness": "Roughness Offset"}
    controls = {key: source.outputs[name] for key, name in names.items()}
    return closure_network.build(tree, closures, rotation=source.outputs.get("Rotation"), **controls)


def _principled(tree, source, sink, fitted, images, is_seen_through):
    """Adds a Principled BSDF, and images of a tile; returns their output."""
    look = LookNodes(tree, source)
    shader, base = tree.nodes.new("ShaderNodeBsdfPrincipled"), None
    shader.distribution = "GGX"  # as fitted: without multiple scattering between facets
    tiles = add_mapping(tree, source, look) if images.colors is not None else None
    rough = (
        add_texture(tree, images.roughness, tiles, ROUGHNESS).outputs["Color"] if images.roughness else None
    )
    _feed_values(tree, shader, fitted, look, rough)
    if max(fitted["diffuse"]) > 0:
        base = tree.nodes.new("ShaderNodeBsdfDiffuse")
        _feed(tree, base.inputs["Color"], fitted["diffuse"], look.color(fitted["diffuse"]))
    relief = source.outputs["Normal"]
    if tiles is not None:
        texture = add_texture(tree, images.colors, tiles, COLORS)
        tree.links.new(look.color(texture.outputs["Color"]), shader.inputs["Base Color"])
        if is_seen_through:
            tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        if images.normals is not None:
            bent = _relief(tree, add_texture(tree, images.normals, tiles, NORMALS), source)
            relief = relief if tree.velour.displaces and images.height is not None else bent
        if images.height is not None:
            height = add_texture(tree, images.height, tiles, HEIGHT)
            _displace(tree, source, sink, height, fitted.get("middle", 0.5))
    for socket in filter(None, map(_normal, (shader, base))):
        tree.links.new(relief, socket)
    tree.links.new(relief, first_input(shader, "Coat Normal", "Clearcoat Normal"))
    return _with_base(tree, shader, base) if base else shader.outputs[0]


def _normal(shader):
    return shader and shader.inputs["Normal"]


def _feed_values(tree, shader, fitted, look, rough=None):
    """Sets the sockets of a Principled BSDF as fitted, and links what the look changes.

    rough: socket of a map that replaces the roughness.
    """
    values = fitted["principled"]
    for name, value in values.items():
        approximation_look.set_value(shader, name, value)
    roughness, amount = values["roughness"], fitted["anisotropic"]
    inputs = {
        "base_color": look.color(values["base_color"]),
        "specular": look.weight(values["specular"]),
        "roughness": look.roughness(roughness if rough is None else rough),
    }
    if values["coat"] > 0:
        inputs["coat"] = look.weight(values["coat"])
        inputs["coat_roughness"] = look.roughness(values["coat_roughness"])
    if has_layers() and values["metallic"] < 1:
        inputs["specular_tint"] = look.tint(values["specular_tint"], values["metallic"])
    shader.inputs["IOR"].default_value = 1.5  # levels are fitted for it; Blender 4.0's default is 1.45
    if amount > 0 and rough is None:
        inputs["roughness"], anisotropic = look.anisotropic(roughness, amount)
        _feed(tree, shader.inputs["Anisotropic"], amount, anisotropic)
        turns = look.turns(0.25 if fitted["turned"] else 0.0)
        tree.links.new(turns, shader.inputs["Anisotropic Rotation"])
        tangent = tree.nodes.new("ShaderNodeTangent")
        tangent.direction_type = "UV_MAP"
        tangent.location = -220, -300
        tree.links.new(tangent.outputs[0], shader.inputs["Tangent"])
    for name, socket in inputs.items():
        tree.links.new(socket, approximation_look.socket_of(shader, name))


def _feed(tree, socket, value, source):
    """Links a socket; its own value is what the look leaves unchanged."""
    socket.default_value = (*value, 1.0) if isinstance(value, (list, tuple)) else value
    tree.links.new(source, socket)


def _relief(tree, texture, source):
    """Adds the normal map, rotated like the tile, since tangents are those of the texture coordinates."""
    turn, relief = tree.nodes.new("ShaderNodeVectorRotate"), tree.nodes.new("ShaderNodeNormalMap")
    turn.rotation_type = "Z_AXIS"
    turn.inputs["Center"].default_value = 0.5, 0.5, 0.5  # color of an untilted normal
    turn.location, relief.location = (-360, -460), (-180, -460)
    tree.links.new(source.outputs["Rotation"], turn.inputs["Angle"])
    tree.links.new(texture.outputs["Color"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], relief.inputs["Color"])
    return relief.outputs["Normal"]


def _displace(tree, source, sink, texture, middle):
    """Adds the relief to the group's output Displacement, for surfaces whose material uses it.

    Its height is in proportion to the width of a tile; approximation_look.follow() sets it for one repeat.
    middle: value of the texture where the surface stays.
    """
    kinds = ("Displacement", "SeparateXYZ", "Math", "Math")
    relief, repeats, size, height = (tree.nodes.new(f"ShaderNode{kind}") for kind in kinds)
    for number, node in enumerate((height, size, repeats, relief)):
        node.location = -720 + 180 * number, -1300
    size.operation, height.operation = "DIVIDE", "MULTIPLY"
    height.label = approximation_look.HEIGHT
    relief.inputs["Midlevel"].default_value = middle
    for output, socket in (
        (source.outputs["Scale"], height.inputs[0]),
        (height.outputs[0], size.inputs[0]),
        (source.outputs["Repeats"], repeats.inputs[0]),
        (repeats.outputs["X"], size.inputs[1]),
        (size.outputs[0], relief.inputs["Scale"]),
        (texture.outputs["Color"], relief.inputs["Height"]),
    ):
        tree.links.new(output, socket)
    group_inputs.put_output(tree, DISPLACEMENT, "Vector")
    tree.links.new(relief.outputs[0], sink.inputs[DISPLACEMENT])


def _with_base(tree, shader, base):
    base.location = 0, 160
    both = tree.nodes.new("ShaderNodeAddShader")
    both.location = 400, 0
    for number, part in enumerate((shader, base)):
        tree.links.new(part.outputs[0], both.inputs[number])
    return both.outputs[0]


def _link_coordinates(node):
    """Links texture coordinates to the Vector of tiles, which has no coordinates of its own."""
    vector = node.group.inputs.get("Vector")
    if vector is None or vector.is_linked:
        return
    tree = node.group.id_data
    uvs = tree.nodes.new("ShaderNodeUVMap")
    uvs.uv_map = placed_by(node)
    uvs.location = node.group.location.x - 200, node.group.location.y - 200
    tree.links.new(uvs.outputs["UV"], vector)


def _only(tree, idname, location):
    found = next((node for node in tree.nodes if node.bl_idname == idname), None)
    if found is None:
        found = tree.nodes.new(idname)
        found.location = location
    return found


def _clear(tree, keeps_images=False):
    """Removes the nodes of an approximation, and images that only they use.

    Returns the sockets that its shader fed.
    """
    found, ours = images_of(tree), {node for node in tree.nodes if is_built(node)}
    leaving = (link for link in tree.links if link.from_node in ours and link.to_node not in ours)
    fed = [link.to_socket for link in leaving if link.from_socket.type == "SHADER"]
    for node in ours:
        tree.nodes.remove(node)
    for image in found:
        if image is not None and image.users == 0 and not keeps_images:
            bpy.data.images.remove(image)
    return fed


def _remember(state, approximation, model):
    state.is_approximation, state.model = True, model
    state.fitted, state.reason = approximation_look.kept(approximation), approximation.reason
    errors = {"": approximation.relative_l2, **approximation.by_view_angle}
    state.relative_l2, *by_angle = (
        -1.0 if errors.get(angle) is None else errors[angle] for angle in ("", *VIEW_ANGLES)
    )
    state.by_view_angle = by_angle
