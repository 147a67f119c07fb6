"""Evaluated geometry as numpy arrays."""

import contextlib
from typing import NamedTuple

import numpy as np


class MeshArrays(NamedTuple):
    """The keywords of Scene.add_mesh."""

    positions: np.ndarray
    triangles: np.ndarray
    corner_normals: np.ndarray
    corner_uvs: np.ndarray | None
    material_slots: np.ndarray


def object_arrays(obj, uv_maps=()):
    """MeshArrays of an evaluated object; None where it has no face.

    `uv_maps`: for each material slot, of which the last stands for all beyond, the UV map of its faces.
    Empty, or where there is none of that name: the one that renders.
    """
    with _mesh_of(obj) as mesh:
        return mesh_arrays(mesh, uv_maps) if mesh else None


def has_uv_map(obj, name):
    with _mesh_of(obj) as mesh:
        return mesh is not None and name in mesh.uv_layers


def triangle_faces(obj):
    """[triangles] The face of an evaluated object that each triangle of object_arrays() is a part of."""
    with _mesh_of(obj) as mesh:
        mesh.calc_loop_triangles()
        return _read(mesh.loop_triangles, "polygon_index", len(mesh.loop_triangles), np.uint32)


@contextlib.contextmanager
def _mesh_of(obj):
    # Only what is not a mesh yet, or is being edited, needs a converted copy.
    convert = obj.type != "MESH" or obj.mode == "EDIT"
    try:
        yield obj.to_mesh() if convert else obj.data
    finally:
        if convert:
            obj.to_mesh_clear()


def mesh_arrays(mesh, uv_maps=()):
    """`mesh` in its local space, split into Blender's own triangles; None where it has no face."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    corners = _read(mesh.loop_triangles, "loops", count * 3, np.uint32).reshape(count, 3)
    slots = _material_slots(mesh, count)
    return MeshArrays(
        positions=_read(mesh.vertices, "co", len(mesh.vertices) * 3).reshape(-1, 3),
        # What triangles say of vertices and materials they look up one by one, many times slower.
        triangles=_read(mesh.loops, "vertex_index", len(mesh.loops), np.uint32)[corners],
        corner_normals=_corner_normals(mesh)[corners],
        corner_uvs=_corner_uvs(mesh, corners, slots, uv_maps),
        material_slots=slots,
    )


def _material_slots(mesh, count):
    """[triangles]; without an attribute that says otherwise all faces are of the first slot."""
    if len(mesh.materials) <= 1 and "material_index" not in mesh.attributes:
        return np.zeros(count, np.uint32)
    of_faces = _read(mesh.polygons, "material_index", len(mesh.polygons), np.uint32)
    return of_faces[_read(mesh.loop_triangles, "polygon_index", count, np.uint32)]


def _read(collection, attribute, size, dtype=np.float32):
    """Indices as uint32: what Blender calls unsigned is copied item by item into anything else."""
    values = np.empty(size, dtype)
    collection.foreach_get(attribute, values)
    return values


def _corner_normals(mesh):
    """[loops x 3]: custom, sharp and auto-smooth normals as Blender shades them."""
    size = len(mesh.loops) * 3
    if hasattr(mesh, "corner_normals"):  # 4.1 and newer
        return _read(mesh.corner_normals, "vector", size).reshape(-1, 3)
    mesh.calc_normals_split()
    normals = _read(mesh.loops, "normal", size).reshape(-1, 3)
    mesh.free_normals_split()
    return normals


def _corner_uvs(mesh, corners, slots, uv_maps):
    """[triangles x 3 x 2] of the UV map that renders, or of that of a triangle's slot; None without maps."""
    rendered = next((uv for uv in mesh.uv_layers if uv.active_render), None)
    if rendered is None:
        return None
    uvs = _layer_uvs(mesh, rendered)[corners]
    for slot, name in enumerate(uv_maps):
        layer = mesh.uv_layers.get(name) if name else None
        if layer is not None:
            shown = np.minimum(slots, len(uv_maps) - 1) == slot  # beyond the last slot the last one shows
            uvs[shown] = _layer_uvs(mesh, layer)[corners[shown]]
    return uvs


def _layer_uvs(mesh, layer):
    return _read(layer.data, "uv", len(mesh.loops) * 2).reshape(-1, 2)
