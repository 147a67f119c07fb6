"""Images of a tile's approximation: base color with opacity, normals, roughness and height."""

from typing import NamedTuple

import bpy
import numpy as np

from ..core import srgb
from ..core.tile_maps import encoded
from ..export.measured_look import constant_look
from ..export.nodes import approximation_node, velour_node

COLORS, NORMALS, ROUGHNESS, HEIGHT = ROLES = (
    "Colors",
    "Normals",
    "Roughness",
    "Height",
)  # labels of their nodes
FRAME = "Other Engines"  # contains the nodes that are replaced; an artist's own nodes are outside of it
_KEPT_OPAQUE = 0.999  # mean alpha from which on a map counts as opaque except for noise


class TileImages(NamedTuple):
    """None: there is no such image."""

    colors: bpy.types.Image | None = None
    normals: bpy.types.Image | None = None
    roughness: bpy.types.Image | None = None
    height: bpy.types.Image | None = None  # 0 to 1; the Displacement node has the scale


def is_built(node):
    """Whether a node is in the frame."""
    while node is not None and not node.name.startswith(FRAME):
        node = node.parent
    return node is not None


def built_nodes(tree, *idnames):
    """The nodes of these types in the frame; all of them in groups of the former layout, without a frame."""
    found = [node for node in tree.nodes if node.bl_idname in idnames]
    return [node for node in found if is_built(node)] if any(map(is_built, tree.nodes)) else found


def shows_behind(tree):
    """Whether the nodes of a group are transparent in places."""
    return any(node.inputs["Alpha"].is_linked for node in built_nodes(tree, "ShaderNodeBsdfPrincipled"))


def images_of(tree):
    """The TileImages of a group's nodes."""
    textures = built_nodes(tree, "ShaderNodeTexImage")
    found = {_role(node): node.image for node in textures if node.image and not node.velour.enabled}
    return TileImages(*(found.get(role) for role in ROLES))


def images_to_export(material):
    """The TileImages of a measured material for other programs.

    They cannot spread the highlights of a roughness map: with a roughness offset there is none.
    """
    images = images_of(approximation_node(material).node_tree)
    is_spread = constant_look(velour_node(material)).roughness > 0
    return images._replace(roughness=None) if is_spread else images


def _role(node):
    """Nodes of the first files have no label; they have images of colors and normals only."""
    if node.label in ROLES:
        return node.label
    return NORMALS if node.image.colorspace_settings.is_data else COLORS


def add_images(name, approximation):
    """The TileImages of an approximation; `name`: their prefix."""
    found = approximation
    if found.color_map is None:
        return TileImages()
    height = found.height_map
    return TileImages(
        add_image(f"{name} approximation", found.color_map),
        None if found.normal_map is None else add_normals(f"{name} normals", found.normal_map),
        None if found.roughness_map is None else _add_numbers(f"{name} roughness", found.roughness_map),
        None if height is None else _add_numbers(f"{name} height", _normalized(height), is_float=True),
    )


def height_range(height):
    """Height of 1 in the image, in widths of the tile."""
    return float(np.ptp(height))


def middle_of(height):
    """Value in the image of the undisplaced surface, at the mean height."""
    return float(_normalized(height).mean())


def _normalized(height):
    return (height - height.min()) / max(height_range(height), 1e-12)


def _add_numbers(name, values, is_float=False):
    """A packed image of numbers [rows x columns] from 0 to 1; in floats where 256 steps would be seen."""
    return _packed(name, np.dstack([values] * 3 + [np.ones_like(values)]), is_data=True, is_float=is_float)


def add_image(name, pixels):
    """A packed sRGB image of RGBA `pixels` [rows x columns x 4], linear Rec. 709, row 0 at the bottom."""
    return _packed(name, np.dstack([srgb.encoded(pixels[..., :3]), pixels[..., 3]]), alpha=True)


def add_normals(name, normals):
    """A packed 8-bit image of unit `normals` [rows x columns x 3], as in glTF files.

    Its steps are a quarter of a degree, finer than the accuracy of normals estimated from images.
    """
    return _packed(name, np.dstack([encoded(normals), np.ones(normals.shape[:2])]), is_data=True)


def _packed(name, pixels, alpha=False, is_data=False, is_float=False):
    rows, columns = pixels.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=alpha, is_data=is_data, float_buffer=is_float)
    if alpha:
        image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    image.update()
    image.pack()
    return image


def is_open(pixels):
    """Whether the image is partly transparent."""
    return float(pixels[..., 3].mean()) < _KEPT_OPAQUE


def add_mapping(tree, source, look):
    """Adds the nodes that place a tile by the group's inputs; returns their output.

    source: the Group Input node. look: LookNodes.
    """
    turn, mapping = tree.nodes.new("ShaderNodeCombineXYZ"), tree.nodes.new("ShaderNodeMapping")
    turn.location, mapping.location = (-1000, -160), (-800, 0)
    mapping.vector_type = "TEXTURE"  # the inverse: its scale is the size of a tile
    size = look.vector("DIVIDE", (1.0,) * 3, source.outputs["Repeats"])
    given, offset, uvs = source.outputs["Vector"], source.outputs["Offset"], tree.nodes.new("ShaderNodeUVMap")
    uvs.location = -1000, -1000
    missing = look.math("LESS_THAN", look.vector("DOT_PRODUCT", given, given, output="Value"), 1e-12)
    # Added to the location, since exporters follow the link of the vector to the UV Map node outside.
    unlinked = look.vector("SCALE", uvs.outputs["UV"], scale=missing)
    links = {
        "Vector": given,
        "Location": look.vector("SUBTRACT", offset, unlinked),
        "Rotation": turn.outputs["Vector"],
        "Scale": look.vector("SCALE", size, scale=source.outputs["Scale"]),
    }
    tree.links.new(source.outputs["Rotation"], turn.inputs["Z"])
    for name, socket in links.items():
        tree.links.new(socket, mapping.inputs[name])
    return mapping.outputs["Vector"]


def add_texture(group, image, tiles, role):
    """Adds the image's node; `tiles` is the socket of add_mapping()."""
    texture = group.nodes.new("ShaderNodeTexImage")
    texture.label, texture.location = role, (-500, -320 * ROLES.index(role))
    texture.image = image
    group.links.new(tiles, texture.inputs["Vector"])
    return texture
