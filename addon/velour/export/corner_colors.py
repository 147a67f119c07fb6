"""Mesh attributes as corner colors."""

from typing import NamedTuple

import numpy as np

from .color import luminance_weights
from .image_nodes import UnsupportedError
from .newer import UNKNOWN

MOST_SETS = 4  # VLR_MOST_COLOR_SETS
# Attribute types that Cycles reads: property of an element, and number of components.
_READ = {
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),  # Blender returns it decoded
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT2": ("vector", 2),
}


class CornerColors(NamedTuple):
    """Output of a shader node that reads an attribute."""

    name: str | None  # None: the active render color attribute
    part: str  # the node's output: Color, Vector, Fac or Alpha
    is_number: bool  # linked to a float input; stored as gray on the corners
    otherwise: float = 0.0  # value on meshes without the attribute


# Not an attribute: positions before deformation, from 0 to 1 over the mesh's texture space.
GENERATED = CornerColors(None, "Generated", False)


def corner_colors_of(plug, is_number):
    """CornerColors of an attribute node's output. `is_number`: it is linked to a float input, not a color."""
    node, part = plug.node, plug.socket.name
    if node.bl_idname == "ShaderNodeVertexColor":
        return CornerColors(node.layer_name or None, part, is_number)
    if node.attribute_type != "GEOMETRY":
        known = node.bl_rna.properties["attribute_type"].enum_items.get(node.attribute_type)
        kind = f"type '{known.name}'" if known else f"a type that is {UNKNOWN}"
        raise UnsupportedError(f"'{node.name}' reads an attribute of {kind}")
    otherwise = 1.0 if part == "Alpha" else 0.0
    return CornerColors(node.attribute_name, "Fac" if part == "Factor" else part, is_number, otherwise)


def shader_colors(owner, sources, notes):
    """The distinct CornerColors among the sources of a material's layers, at most MOST_SETS."""
    asked = tuple(dict.fromkeys(source for source in sources if isinstance(source, CornerColors)))
    if len(asked) > MOST_SETS:
        notes.add(
            f"{owner}: it uses {len(asked)} mesh attributes, but only {MOST_SETS} are supported; the others"
            " are replaced by the values of the inputs, and in computed inputs by 0 (alpha: 1)."
        )
    return asked[:MOST_SETS]


def colors_of_slots(colors):
    """The `colors` argument of object_arrays() for the sets of each slot of a mesh."""
    return colors if any(colors) else ()


def corner_colors(mesh, arrays, colors):
    """[sets x corners x 3]; None without sets. `arrays`: MeshArrays; `colors`: CornerColors of each slot.

    The last slot stands for all further ones. Missing attributes get the value that Cycles uses.
    """
    count = max(map(len, colors), default=0)
    if count == 0:
        return None
    sets = np.zeros((count, len(arrays.corner_vertices), 3), np.float32)
    slots = np.minimum(arrays.slots, len(colors) - 1)
    for slot, asked in enumerate(colors):
        shown = arrays.triangles[slots == slot]
        for number, each in enumerate(asked):
            values = _corner_values(mesh, arrays, each)
            sets[number, shown] = each.otherwise if values is None else values[shown]
    return sets


def has_attribute(mesh, asked):
    return asked == GENERATED or _attribute(mesh, asked.name) is not None


def missing_colors(obj, asked, material_name):
    """Note for an object without the attribute."""
    what = "color attribute" if asked.name is None else f"attribute '{asked.name}'"
    attributes = getattr(obj.data, "attributes", None)
    found = attributes.get(asked.name) if attributes and asked.name else None
    if found is not None and found.domain not in _SPREAD:
        return (
            f"Object '{obj.name}': attribute '{asked.name}' for material '{material_name}' is stored on"
            f" {found.domain.lower()}s, which is not supported; {asked.otherwise:g} is used instead. Convert"
            " it to points, corners or faces."
        )
    if found is None and asked.name and asked.name in obj.vertex_groups:
        return (
            f"Object '{obj.name}': vertex group '{asked.name}' for material '{material_name}' is not read as"
            f" an attribute; {asked.otherwise:g} is used instead. Store its weights in an attribute."
        )
    return (
        f"Object '{obj.name}': it has no {what} for material '{material_name}';"
        f" {asked.otherwise:g} is used instead."
    )


class _Attribute(NamedTuple):
    data: object  # Blender's collection of elements
    domain: str
    field: str  # property of an element
    size: int  # number of components


def _attribute(mesh, name):
    """The _Attribute of that name; None if it is missing or cannot be read."""
    if name is None:
        colors = getattr(mesh, "color_attributes", ())
        index = colors.render_color_index if len(colors) else -1
        found = colors[index] if 0 <= index < len(colors) else None
    else:
        found = mesh.attributes.get(name)
        if found is None and name in mesh.uv_layers:  # not attributes before Blender 3.5
            return _Attribute(mesh.uv_layers[name].data, "CORNER", "uv", 2)
    if found is None or found.data_type not in _READ or found.domain not in _SPREAD:
        return None
    return _Attribute(found.data, found.domain, *_READ[found.data_type])


def _corner_values(mesh, arrays, asked):
    """[corners x 3], or None."""
    if asked == GENERATED:
        return _generated(mesh)[arrays.corner_vertices]
    attribute = _attribute(mesh, asked.name)
    if attribute is None:
        return None
    values = np.empty((len(attribute.data), attribute.size), np.float32)
    attribute.data.foreach_get(attribute.field, values.reshape(-1))
    return _SPREAD[attribute.domain](mesh, arrays, _shown(values, asked))


def _generated(mesh):
    """[vertices x 3] Generated coordinates, as in Cycles (mesh_texture_space)."""
    places = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places.reshape(-1))
    middle = np.array(mesh.texspace_location, np.float32)
    half = np.array(mesh.texspace_size, np.float32)
    return (places - middle) / np.where(half != 0.0, 2.0 * half, 1.0) + 0.5


def _shown(values, asked):
    """Node output [elements x 3] for attribute values [elements x 1 to 4]."""
    size = values.shape[1]
    color = np.pad(values, ((0, 0), (0, 1))) if size == 2 else values[:, :3]
    if asked.part == "Alpha":
        number = values[:, 3] if size == 4 else np.ones(len(values), np.float32)
    elif asked.part == "Fac":
        number = values[:, 0] if size == 2 else color.mean(axis=1)
    elif not asked.is_number or size == 1:
        return np.broadcast_to(color, (len(values), 3))
    else:
        number = color.mean(axis=1) if asked.part == "Vector" else color @ luminance_weights()
    return np.repeat(number[:, None], 3, axis=1)


def _spread_over_faces(mesh, arrays, values):
    faces = np.empty(len(arrays.triangles), np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    corners = np.empty((len(arrays.corner_vertices), 3), np.float32)
    corners[arrays.triangles] = values[faces][:, None]
    return corners


_SPREAD = {
    "POINT": lambda _mesh, arrays, values: values[arrays.corner_vertices],
    "CORNER": lambda _mesh, _arrays, values: values,
    "FACE": _spread_over_faces,
}
