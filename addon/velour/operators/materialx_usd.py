"""Exports a measured material to USD as an OpenPBR surface of MaterialX, beside the UsdPreviewSurface."""

import contextlib
import math

from ..core.analytic.open_pbr import OpenPbr
from ..core.analytic.open_pbr_fit import fitted_open_pbr
from ..core.approximation_uv import affine
from ..core.model_export import error_note
from ..export.color import working_to_rec709
from ..export.files import read_model
from ..export.measured_look import constant_look
from ..export.nodes import approximation_node, velour_node
from ..properties.approximation_state import VIEW_ANGLES
from .approximation_image import images_to_export, shows_behind
from .approximation_look import is_surface, shown, stored
from .usd_nodes import add, coordinate_name, exported, value_type

READER = "Velour_Geomprop"  # prim of the texture coordinates; its input "geomprop" is their name
_RENDER_CONTEXT = "mtlx"


def write(context, material, usd_material):
    """Writes the surface of the MaterialX render context, unless there is one; returns whether it did.

    context: Blender's export context.
    """
    values = shown(material) if material.node_tree else None
    if values is None or not is_surface(material):
        return False
    output = usd_material.CreateSurfaceOutput(_RENDER_CONTEXT)
    if output.HasConnectedSource():
        return False
    tree = approximation_node(material).node_tree
    shader = add(usd_material, "Velour_OpenPBR", "ND_open_pbr_surface_surfaceshader")
    pictures = images_to_export(material)
    if pictures.colors:
        _write_values(shader, OpenPbr.of_principled(values.principled), _stored_errors(tree))
        _write_images(context, usd_material, shader, tree, values, pictures)
    else:
        _write_brdf(usd_material, shader, material, tree)
    output.ConnectToSource(shader.CreateOutput("out", value_type("Token")))
    return True


def _write_values(shader, material, errors):
    for name, value in material.inputs().items():
        kind = "Color3f" if isinstance(value, list) else "Float"
        shader.CreateInput(name, value_type(kind)).Set(tuple(value) if kind == "Color3f" else value)
    shader.GetPrim().SetDocumentation(error_note(errors))


def _stored_errors(tree):
    """Errors of the nodes in the group, whose images are those of the file."""
    state = tree.velour
    by_angle = (None if error < 0 else error for error in state.by_view_angle)
    return {"relative_l2": state.relative_l2, "by_view_angle": dict(zip(VIEW_ANGLES, by_angle, strict=True))}


def _write_brdf(usd_material, shader, material, tree):
    """Writes OpenPBR fitted to the model with the look of the material."""
    node, values = velour_node(material), stored(tree)
    look = constant_look(node)
    with contextlib.ExitStack() as opened:
        model = opened.enter_context(read_model(node.image, f"Material '{material.name}'"))
        if look.roughness > 0:
            model = opened.enter_context(model.roughened(look.roughness))
        gain = working_to_rec709(look.gain)
        found = fitted_open_pbr(model, values["principled"], values["anisotropic"], values["turned"], gain)
    _write_values(shader, found.material, found.errors)
    turn = look.rotation + (math.pi / 2 if found.is_turned else 0.0)
    if found.material.specular_roughness_anisotropy > 0 and turn != 0:
        _write_tangent(usd_material, shader, turn)


def _write_tangent(usd_material, shader, turn):
    """Connects the tangent, turned counterclockwise by `turn` radians."""
    directions = _directions(usd_material)
    tangent = _sum(usd_material, "Tangent", directions, (math.cos(turn), math.sin(turn)))
    _connect(shader, "geometry_tangent", "Float3", tangent)


def _directions(usd_material):
    """The tangent and the bitangent of the mesh, in the space of OpenPBR's and of normal maps."""
    found = [add(usd_material, f"Velour_{n.title()}", f"ND_{n}_vector3") for n in ("tangent", "bitangent")]
    for direction in found:
        direction.CreateInput("space", value_type("String")).Set("world")
    return found


def _sum(usd_material, name, directions, shares):
    """The sum of shares of the tangent and the bitangent."""
    both = add(usd_material, f"Velour_Turned_{name}", "ND_add_vector3")
    for number, (direction, share) in enumerate(zip(directions, shares, strict=True), start=1):
        scaled = add(usd_material, f"Velour_{name}_Part_{number}", "ND_multiply_vector3FA")
        _connect(scaled, "in1", "Float3", direction)
        scaled.CreateInput("in2", value_type("Float")).Set(share)
        _connect(both, f"in{number}", "Float3", scaled)
    return both


def _write_images(context, usd_material, shader, tree, values, pictures):
    """Connects images of colors, opacity, roughness and normals."""
    uvs = _write_uvs(usd_material, values.placed)
    color = _texture(usd_material, "Color", "color3", exported(context, pictures.colors), uvs, "srgb_texture")
    dyed = add(usd_material, "Velour_Tint", "ND_multiply_color3")
    _connect(dyed, "in1", "Color3f", color)
    dyed.CreateInput("in2", value_type("Color3f")).Set(tuple(working_to_rec709(values.gain)))
    _connect(shader, "base_color", "Color3f", dyed)
    if shows_behind(tree):
        both = _texture(usd_material, "Opacity", "color4", exported(context, pictures.colors), uvs)
        alpha = add(usd_material, "Velour_Alpha", "ND_separate4_color4")
        _connect(alpha, "in", "Color4f", both)
        _connect(shader, "geometry_opacity", "Float", alpha, "outa")
    if pictures.roughness:
        roughness = _texture(usd_material, "Roughness", "float", exported(context, pictures.roughness), uvs)
        _connect(shader, "specular_roughness", "Float", roughness)
    if pictures.normals:
        texels = _texture(usd_material, "Normals", "vector3", exported(context, pictures.normals), uvs)
        relief = add(usd_material, "Velour_Relief", "ND_normalmap_float")
        _connect(relief, "in", "Float3", texels)
        if values.placed.rotation != 0:
            _turn_frame(usd_material, relief, values.placed.rotation)
        _connect(shader, "geometry_normal", "Float3", relief)


def _turn_frame(usd_material, relief, turn):
    """Turns the frame of a normal map counterclockwise, as the tiles are."""
    directions, cos, sin = _directions(usd_material), math.cos(turn), math.sin(turn)
    for name, shares in (("Tangent", (cos, sin)), ("Bitangent", (-sin, cos))):
        _connect(relief, name.lower(), "Float3", _sum(usd_material, name, directions, shares))


def _texture(usd_material, name, kind, path, uvs, color_space="raw"):
    texture = add(usd_material, f"Velour_MaterialX_{name}", f"ND_image_{kind}")
    file = texture.CreateInput("file", value_type("Asset"))
    file.Set(path)
    file.GetAttr().SetColorSpace(color_space)
    _connect(texture, "texcoord", "Float2", uvs)
    return texture


def _write_uvs(usd_material, placed):
    """Adds the nodes that place the image; returns the last one."""
    reader = add(usd_material, READER, "ND_geompropvalue_vector2")
    reader.CreateInput("geomprop", value_type("String")).Set(coordinate_name(placed))
    both = add(usd_material, "Velour_Placed", "ND_combine2_vector2")
    for axis, name, (u, v, start) in zip("XY", ("in1", "in2"), affine(placed), strict=True):
        product = add(usd_material, f"Velour_{axis}_Turned", "ND_dotproduct_vector2")
        _connect(product, "in1", "Float2", reader)
        product.CreateInput("in2", value_type("Float2")).Set((u, v))
        moved = add(usd_material, f"Velour_{axis}_Moved", "ND_add_float")
        _connect(moved, "in1", "Float", product)
        moved.CreateInput("in2", value_type("Float")).Set(start)
        _connect(both, name, "Float", moved)
    return both


def _connect(shader, name, kind, source, output="out"):
    """Connects an input to the output of another shader."""
    found = source.CreateOutput(output, value_type(kind))
    shader.CreateInput(name, value_type(kind)).ConnectToSource(found)
