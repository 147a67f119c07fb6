"""Images of an approximation: base color with opacity, and normals."""

import bpy
import numpy as np

from ..core import srgb
from ..core.normal_map import encoded

_KEPT_OPAQUE = 0.999  # mean alpha from which on a map counts as opaque except for noise


def add_image(name, pixels):
    """A packed sRGB image of RGBA `pixels` [rows x columns x 4], linear Rec. 709, row 0 at the bottom."""
    return _packed(name, np.dstack([srgb.encoded(pixels[..., :3]), pixels[..., 3]]), alpha=True)


def add_normals(name, normals):
    """A packed 8-bit image of unit `normals` [rows x columns x 3], as in glTF files.

    Its steps are a quarter of a degree, finer than the accuracy of normals estimated from images.
    """
    return _packed(name, np.dstack([encoded(normals), np.ones(normals.shape[:2])]), is_data=True)


def _packed(name, pixels, alpha=False, is_data=False):
    rows, columns = pixels.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=alpha, is_data=is_data)
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
    links = {
        "Vector": source.outputs["Vector"],
        "Location": source.outputs["Offset"],
        "Rotation": turn.outputs["Vector"],
        "Scale": look.vector("SCALE", size, scale=source.outputs["Scale"]),
    }
    tree.links.new(source.outputs["Rotation"], turn.inputs["Z"])
    for name, socket in links.items():
        tree.links.new(socket, mapping.inputs[name])
    return mapping.outputs["Vector"]


def add_texture(group, image, tiles, y=0):
    """Adds the image's node; `tiles` is the socket of add_mapping()."""
    texture = group.nodes.new("ShaderNodeTexImage")
    texture.location = -500, y
    texture.image = image
    group.links.new(tiles, texture.inputs["Vector"])
    return texture
