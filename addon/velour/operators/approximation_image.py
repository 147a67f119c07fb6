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


def add_mapping(group):
    """Adds the nodes that place a group's tiles; returns their output socket."""
    uvs, mapping = group.nodes.new("ShaderNodeUVMap"), group.nodes.new("ShaderNodeMapping")
    for node, x in ((uvs, -1000), (mapping, -800)):
        node.location = x, 0
    mapping.vector_type = "TEXTURE"  # the inverse: its scale is the size of a tile
    group.links.new(uvs.outputs["UV"], mapping.inputs["Vector"])
    return mapping.outputs["Vector"]


def add_texture(group, image, tiles, y=0):
    """Adds the image's node; `tiles` is the socket of add_mapping()."""
    texture = group.nodes.new("ShaderNodeTexImage")
    texture.location = -500, y
    texture.image = image
    group.links.new(tiles, texture.inputs["Vector"])
    return texture


def place(mapping, placement, metres):
    """Sets a Mapping node to a placement. `metres`: sides of a tile in meters, if the model has them."""
    mapping.inputs["Location"].default_value = (*placement.offset, 0.0)
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, placement.rotation)
    mapping.inputs["Scale"].default_value = (*(1.0 / r for r in _repeats(placement, metres)), 1.0)


def _repeats(placement, metres):
    """Repeats per unit of texture coordinates. For real-size tiles that is 1 m, unless a density is set."""
    if placement.mode == "REPEATS":
        return tuple(placement.repeats)
    entered = tuple(1e-3 * side for side in placement.tile_size)
    sides = entered if min(entered) > 0 else metres or (1.0, 1.0)
    density = placement.uv_density if min(placement.uv_density) > 0 else (1.0, 1.0)
    return tuple(1.0 / (side * d) for side, d in zip(sides, density, strict=True))
