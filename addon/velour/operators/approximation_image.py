"""The image of an approximation: base colour, and what of a tile is there."""

import bpy
import numpy as np

_KEPT_OPAQUE = 0.999  # a map of more is opaque but for noise


def add_image(name, pixels):
    """A packed sRGB image of RGBA `pixels` [rows x columns x 4], linear Rec. 709, row 0 at the bottom."""
    rows, columns = pixels.shape[:2]
    image = bpy.data.images.new(name, columns, rows, alpha=True)
    image.alpha_mode = "CHANNEL_PACKED"
    linear = pixels[..., :3]
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    image.pixels.foreach_set(np.dstack([encoded, pixels[..., 3]]).astype(np.float32).ravel())
    image.update()
    image.pack()
    return image


def is_open(pixels):
    """Whether something shows through."""
    return float(pixels[..., 3].mean()) < _KEPT_OPAQUE


def add_texture(group, image):
    """The image's node in a node group, behind those that say where its tiles lie."""
    uvs, mapping = group.nodes.new("ShaderNodeUVMap"), group.nodes.new("ShaderNodeMapping")
    texture = group.nodes.new("ShaderNodeTexImage")
    for node, x in ((uvs, -1000), (mapping, -800), (texture, -500)):
        node.location = x, 0
    texture.image = image
    mapping.vector_type = "TEXTURE"  # the inverse: tiles are as large as this scale
    group.links.new(uvs.outputs["UV"], mapping.inputs["Vector"])
    group.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return texture


def place(mapping, placement, metres):
    """Where the placement says that tiles lie. metres: sides of a tile, where the model knows them."""
    mapping.inputs["Location"].default_value = (*placement.offset, 0.0)
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, placement.rotation)
    mapping.inputs["Scale"].default_value = (*(1.0 / r for r in _repeats(placement, metres)), 1.0)


def _repeats(placement, metres):
    """Over a unit of texture coordinates. Tiles in real size: as if that were a metre, unless it is told."""
    if placement.mode == "REPEATS":
        return tuple(placement.repeats)
    entered = tuple(1e-3 * side for side in placement.tile_size)
    sides = entered if min(entered) > 0 else metres or (1.0, 1.0)
    density = placement.uv_density if min(placement.uv_density) > 0 else (1.0, 1.0)
    return tuple(1.0 / (side * d) for side, d in zip(sides, density, strict=True))
