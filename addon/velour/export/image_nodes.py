"""Image and Environment Texture nodes that drive a parameter of a shader."""

from typing import NamedTuple

import numpy as np
from mathutils import Euler, Matrix

from .conversions import own_numbers
from .newer import UNKNOWN, choice
from .nodes import is_model_texture
from .plugs import fed_by

_WRAPS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}
_SOURCES = ("FILE", "GENERATED")
_NODES = ("ShaderNodeTexImage", "ShaderNodeTexEnvironment")
_CUBIC = ("Cubic", "Smart")
_IDENTITY = np.eye(2, 3, dtype=np.float32)
MAPPED_AXES = ("mapping_x", "mapping_y", "mapping_z")


class Picture(NamedTuple):
    """Data of an Image or Environment Texture node, without the pixels."""

    image: object  # bpy.types.Image, or None: magenta, as in Cycles
    alpha: bool  # use alpha instead of color
    beside_alpha: bool  # the node's alpha output is linked
    wrap: str
    filter: str
    uv_map: np.ndarray  # [2 x 3]: maps the mesh's (u, v, 1) to image coordinates
    coordinates: str  # name of the mesh's UV map; empty: the active render map


class Coordinates(NamedTuple):
    """Texture coordinates that are used without an image."""

    coordinates: str  # as Picture.coordinates


class UnsupportedError(Exception):
    """Why a node cannot be rendered, as the end of a sentence."""


def picture_of(plug, owner, notes):
    """The Picture at an Image Texture's output; raises UnsupportedError unless it is on a UV map."""
    picture = unplaced_picture(plug, owner, notes)
    uv_map, coordinates = uv_placement(plug)
    return picture._replace(uv_map=uv_map, coordinates=coordinates)


def unplaced_picture(plug, owner, notes):
    """Like picture_of(), whatever the coordinates are; those of the Picture are the mesh's own."""
    node = plug.node
    if node.bl_idname not in _NODES:
        raise UnsupportedError(f"'{node.name}' is not an Image Texture")
    if is_model_texture(node):
        raise UnsupportedError(f"'{node.name}' holds a measured material")
    _check(node)
    if node.image is None:
        notes.add(f"{owner}: node '{node.name}' has no image and is magenta, as in Cycles; choose an image.")
    if node.interpolation in _CUBIC:
        notes.add(f"{owner}: node '{node.name}': cubic interpolation is not supported; linear is used.")
    return Picture(
        node.image,
        plug.socket.name == "Alpha",
        any(output.name == "Alpha" and output.is_linked for output in node.outputs),
        _wrap(node, owner, notes),
        "closest" if node.interpolation == "Closest" else "linear",
        _IDENTITY,
        "",
    )


def _wrap(node, owner, notes):
    if node.bl_idname == "ShaderNodeTexEnvironment":
        return "repeat"
    return choice(_WRAPS, node.extension, "REPEAT", f"{owner}: node '{node.name}'", "extension", notes)


def _check(node):
    if node.image is not None and node.image.source not in _SOURCES:
        raise UnsupportedError(f"the image '{node.image.name}' is not a single image")
    if node.bl_idname == "ShaderNodeTexImage" and node.projection != "FLAT":
        raise UnsupportedError(f"'{node.name}' is not projected with Flat")


def is_identity(uv_map):
    return bool((uv_map == _IDENTITY).all())


def uv_placement(plug):
    """`uv_map` and `coordinates` of an Image Texture; without a link, the mesh's own.

    Raises UnsupportedError for other coordinates.
    """
    if maps_coordinates(plug.node):
        raise UnsupportedError(f"'{plug.node.name}' maps its coordinates")
    matrix, name = uv_map_of(plug.input("Vector"))
    return matrix, name or ""


def maps_coordinates(node):
    """Whether a texture node maps its coordinates by settings of its own, which only its sidebar shows."""
    mapping = getattr(node, "texture_mapping", None)
    if mapping is None:
        return False
    values = (*mapping.translation, *mapping.rotation, *(factor - 1.0 for factor in mapping.scale))
    return any(values) or [getattr(mapping, name) for name in MAPPED_AXES] != ["X", "Y", "Z"]


def uv_map_of(vector):
    """A map [2 x 3] and the name of the UV map that a Vector input gets; the name is None if it is unlinked.

    Raises UnsupportedError for other coordinates.
    """
    fed = fed_by(vector)
    if fed is None:
        return _IDENTITY, None
    if fed.node.bl_idname != "ShaderNodeMapping":
        return _IDENTITY, _coordinates(fed)
    coordinates = fed_by(fed.input("Vector"))
    if coordinates is None:
        raise UnsupportedError(f"'{fed.node.name}' has no coordinates linked to it")
    return _mapping_matrix(fed), _coordinates(coordinates)


def _coordinates(plug):
    node = plug.node
    if getattr(node, "from_instancer", False):
        raise UnsupportedError(f"'{node.name}' reads the coordinates of the instancer")
    if node.bl_idname == "ShaderNodeUVMap":
        return node.uv_map
    if node.bl_idname != "ShaderNodeTexCoord" or plug.socket.name != "UV":
        raise UnsupportedError(f"the coordinates of '{node.name}' are not UV coordinates")
    return ""


def _mapping_matrix(plug):
    node = plug.node
    # Newer Blender versions have a location only for types that use it.
    location, turn, size = inputs = [plug.input(name) for name in ("Location", "Rotation", "Scale")]
    if any(map(fed_by, inputs)):
        raise UnsupportedError(f"'{node.name}' has linked inputs")
    rotation = Euler(own_numbers(turn)).to_matrix().to_4x4()
    scale = Matrix.Diagonal((*own_numbers(size), 1.0))
    shift = Matrix.Translation(own_numbers(location)) if location else Matrix()
    kinds = {
        "POINT": lambda: shift @ rotation @ scale,
        "TEXTURE": lambda: (shift @ rotation @ scale).inverted_safe(),
        "VECTOR": lambda: rotation @ scale,
    }
    if node.vector_type not in kinds:
        kind = "normals" if node.vector_type == "NORMAL" else f"by a type that is {UNKNOWN}"
        raise UnsupportedError(f"'{node.name}' maps {kind}")
    matrix = np.array(kinds[node.vector_type](), np.float32)
    return np.ascontiguousarray(matrix[:2][:, (0, 1, 3)])  # texture coordinates have no z
