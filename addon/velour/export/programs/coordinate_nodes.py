"""Coordinates, geometry, attributes and kinds of rays."""

import bpy
import numpy as np
from mathutils import Euler, Matrix

from ..corner_colors import GENERATED, corner_colors_of
from ..image_nodes import MAPPED_AXES, UnsupportedError, maps_coordinates
from .draft import CornerSet, UvSet

# Whether Texture Coordinate > Normal changes the height of Bump nodes; no property reveals it.
_SHIFTS_NORMAL = bpy.app.version >= (4, 4)


def generated(c):
    """Coordinates from 0 to 1 over the mesh's texture space; of a world, the direction."""
    return position(c) if c.is_world else c.source("corner", CornerSet(GENERATED))


def position(c):
    """World-space position in Blender's units; of a world, the direction."""
    place = c.source("position")
    return place if c.unit == 1.0 else c.draft.vector_math("scale", place, scale=1.0 / c.unit)[0]


def mapped(c, node, vector):
    """Coordinates of a texture node after the mapping among its own settings."""
    if not maps_coordinates(node):
        return vector
    mapping = node.texture_mapping
    matrix = _texture_matrix(mapping)
    found = c.draft.one("transform", (vector,), 3, (), tuple(matrix[:3].ravel().tolist()))
    if mapping.vector_type == "NORMAL":
        return c.draft.vector_math("normalize", found)[0]
    return found


def _texture_matrix(mapping):
    """[4 x 4] of a texture node's own mapping: its axes are chosen first."""
    axes = np.zeros((4, 4))
    axes[3, 3] = 1.0
    for row, name in enumerate(MAPPED_AXES):
        axis = getattr(mapping, name)
        if axis != "NONE":
            axes[row, "XYZ".index(axis)] = 1.0
    inverts = mapping.vector_type in ("TEXTURE", "NORMAL")
    factors = [_invertible(factor) if inverts else factor for factor in mapping.scale]
    turned = np.array(Euler(mapping.rotation).to_matrix().to_4x4() @ Matrix.Diagonal((*factors, 1.0)))
    placed = np.array(Matrix.Translation(mapping.translation)) @ turned
    found = {
        "POINT": lambda: placed,
        "TEXTURE": lambda: np.linalg.inv(placed),
        "VECTOR": lambda: turned,
        "NORMAL": lambda: np.linalg.inv(turned).T,
    }
    return found[mapping.vector_type]() @ axes


def _invertible(factor):
    return factor if abs(factor) >= 1e-5 else (-1e-5 if factor < 0.0 else 1e-5)


def _object(c, plug):
    other = plug.node.object
    if other is None:
        return c.source("object_position")
    matrix = np.array(other.matrix_world.inverted_safe(), np.float64)[:3]
    return c.draft.one("transform", (position(c),), 3, (), tuple(matrix.ravel().tolist()))


def _reflection(c, _plug):
    incoming, normal = c.draft.source("incoming"), c.surface_normal()
    mirrored = c.draft.vector_math("reflect", incoming, normal)[0]
    return c.draft.vector_math("scale", mirrored, scale=-1.0)[0]


_COORDINATES = {
    "Generated": lambda c, _plug: generated(c),
    "Normal": lambda c, _plug: (
        c.source("object_normal") if _SHIFTS_NORMAL else c.draft.source("object_normal")
    ),
    "UV": lambda c, _plug: c.source("uv", UvSet("")),
    "Object": _object,
    "Reflection": _reflection,
}
_GEOMETRY = {
    "Position": lambda c: position(c),
    "Normal": lambda c: c.surface_normal(),
    "True Normal": lambda c: c.draft.source("geometric_normal"),
    "Incoming": lambda c: c.draft.source("incoming"),
    "Backfacing": lambda c: c.draft.source("backfacing").component(0),
}

_LIGHT_PATH = {"Is Camera Ray": "camera_ray", "Is Shadow Ray": "shadow_ray"}


def _unsupported(plug):
    return UnsupportedError(f"output '{plug.socket.name}' of '{plug.node.name}' is not supported")


def _coordinates(c, plug):
    if plug.node.from_instancer or plug.socket.name not in _COORDINATES:
        raise _unsupported(plug)
    return _COORDINATES[plug.socket.name](c, plug)


def _geometry(c, plug):
    if plug.socket.name not in _GEOMETRY:
        raise _unsupported(plug)
    return _GEOMETRY[plug.socket.name](c)


def _uv_map(c, plug):
    if plug.node.from_instancer:
        raise _unsupported(plug)
    return c.source("uv", UvSet(plug.node.uv_map))


def _attribute(c, plug):
    colors = corner_colors_of(plug, False)
    value = c.source("corner", CornerSet(colors))
    return value.component(0) if colors.part in ("Fac", "Alpha") else value


def _light_path(c, plug):
    if plug.socket.name not in _LIGHT_PATH:
        raise _unsupported(plug)
    return c.draft.source(_LIGHT_PATH[plug.socket.name]).component(0)


NODES = {
    "ShaderNodeTexCoord": _coordinates,
    "ShaderNodeNewGeometry": _geometry,
    "ShaderNodeUVMap": _uv_map,
    "ShaderNodeAttribute": _attribute,
    "ShaderNodeVertexColor": _attribute,
    "ShaderNodeLightPath": _light_path,
}
