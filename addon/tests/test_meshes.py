"""Meshes of faces with shared corners."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import Scene, Texture, TextureSlot, VelourError, render_job

_COLORS = np.random.default_rng(1).uniform(0.1, 0.9, (4, 4, 3)).astype(np.float32)


def _cube_faces():
    """positions, corner_vertices of six quads, triangles of corners, faces of those, normals of corners."""
    positions = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], np.float32)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    starts = 4 * np.arange(6, dtype=np.uint32)
    triangles = np.concatenate([starts[:, None] + [0, 1, 2], starts[:, None] + [0, 2, 3]]).astype(np.uint32)
    normals = np.array([(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)], np.float32)
    vertices, corner_normals = np.array(quads, np.uint32).ravel(), np.repeat(normals, 4, axis=0)
    return positions, vertices, triangles, triangles[:, 0] // 4, corner_normals


def _picture_of_mesh(**mesh):
    with Scene() as scene, Texture.from_pixels(_COLORS, filter="closest") as texture:
        number, dropped = scene.add_mesh(**mesh)
        assert dropped == 0
        material = scene.add_textured_material({"base_color": TextureSlot(texture)})
        scene.add_instance(number, np.eye(4), [material])
        scene.add_light("sun", (2, 2, 2), _looking_from((3, -4, 5)))
        scene.look_at((3, -5, 4), (0, 0, 0), 0.6, 1.0)
        scene.commit()
        with render_job(scene, width=16, height=16, spp=8) as job:
            job.run()
            return job.read_pass("Combined")


def _looking_from(eye):
    z = np.array(eye, float) / np.linalg.norm(eye)
    x = np.cross((0, 0, 1), z) / np.linalg.norm(np.cross((0, 0, 1), z))
    return np.column_stack((x, np.cross(z, x), z, eye)).astype(np.float32)


@pytest.mark.parametrize("shading", ["flat", "smooth", "mixed", "corners"])
def test_corners_of_faces_need_not_be_spread_over_triangles(shading):
    """The same picture, bit by bit, as of arrays with three of everything for each triangle."""
    positions, vertices, triangles, faces, flat_corners = _cube_faces()
    uvs = np.random.default_rng(2).uniform(0, 1, (24, 2)).astype(np.float32)
    vertex_normals = (positions / np.sqrt(3)).astype(np.float32)
    smooth = np.array([1, 0, 1, 0, 0, 1], np.uint8)
    smooth_corners = vertex_normals[vertices]
    mixed = np.where(np.repeat(smooth, 4)[:, None] != 0, smooth_corners, flat_corners)
    given, corner_normals = {
        "flat": ({"smooth": np.zeros(12, np.uint8)}, flat_corners),
        "smooth": ({"vertex_normals": vertex_normals}, smooth_corners),
        "mixed": ({"vertex_normals": vertex_normals, "smooth": smooth[faces]}, mixed),
        "corners": ({"corner_normals": mixed}, mixed),
    }[shading]
    shared = _picture_of_mesh(
        positions=positions, triangles=triangles, corner_vertices=vertices, corner_uvs=uvs, **given
    )
    spread = _picture_of_mesh(
        positions=positions,
        triangles=vertices[triangles],
        corner_uvs=uvs[triangles],
        corner_normals=np.ascontiguousarray(corner_normals[triangles], np.float32),
    )
    assert spread[..., :3].max() > 0.05
    np.testing.assert_array_equal(shared, spread)


def test_corners_that_are_not_there_are_refused():
    positions, vertices, triangles, _, _ = _cube_faces()
    mesh = {"positions": positions, "triangles": triangles, "corner_vertices": vertices}
    with Scene() as scene:
        with pytest.raises(VelourError, match="has corner index 24, but the mesh has only 24 corners"):
            scene.add_mesh(**{**mesh, "triangles": triangles + np.uint32(1)})
        with pytest.raises(VelourError, match="has vertex index 8, but the mesh has only 8 vertices"):
            scene.add_mesh(**{**mesh, "corner_vertices": vertices + np.uint32(1)})
        with pytest.raises(VelourError, match="smooth has 6 numbers; 12 are needed"):
            scene.add_mesh(**mesh, smooth=np.ones(6, np.uint8))
        with pytest.raises(VelourError, match=r"corner_uvs has shape \(12, 3, 2\)"):
            scene.add_mesh(**mesh, corner_uvs=np.zeros((12, 3, 2), np.float32))


def _bare(positions, vertices, triangles, _faces, _normals, mirror=1):
    return {
        "positions": positions * np.float32((mirror, 1, 1)),
        "triangles": triangles,
        "corner_vertices": vertices,
        "smooth": np.zeros(len(triangles), np.uint8),
    }


def _in_turn(meshes):
    """The argument of Scene.add_meshes."""
    names = {name for mesh in meshes for name in mesh}
    given = {name: [mesh[name].ravel() for mesh in meshes if name in mesh] for name in names}
    sizes = {name: [mesh[name].size if name in mesh else 0 for mesh in meshes] for name in names}
    return {name: (np.concatenate(given[name]), sizes[name]) for name in names}


def _picture_of_meshes(add):
    with Scene() as scene:
        numbers, dropped = add(scene)
        assert list(numbers) == list(range(len(numbers)))
        assert list(dropped) == [0, 0, 2]
        material = scene.add_principled_material(base_color=(0.6, 0.5, 0.4))
        for i, number in enumerate(numbers):
            place = np.eye(4, dtype=np.float32)
            place[:3, 3] = 2.5 * (i - 1), 0.5 * i, 0
            scene.add_instance(int(number), place, [material])
        scene.add_light("sun", (2, 2, 2), _looking_from((3, -4, 5)))
        scene.look_at((3, -9, 6), (0, 0, 0), 0.8, 1.0)
        scene.commit()
        with render_job(scene, width=24, height=24, spp=8) as job:
            job.run()
            return job.read_pass("Combined")


def test_many_meshes_are_those_that_are_added_one_by_one():
    """Meshes with different sets of arrays and with dropped triangles give the same picture, bit by bit."""
    cube = _cube_faces()
    flat = _bare(*cube)
    soft = {name: _bare(*cube, mirror=-1)[name] for name in ("positions", "triangles", "corner_vertices")}
    soft["vertex_normals"] = soft["positions"].copy()
    torn = _bare(*cube)
    torn["triangles"] = flat["triangles"].copy()
    torn["triangles"][:2] = torn["triangles"][0, 0]
    meshes = [flat, soft, torn]
    many = _picture_of_meshes(lambda scene: scene.add_meshes(_in_turn(meshes)))
    single = _picture_of_meshes(lambda scene: zip(*(scene.add_mesh(**mesh) for mesh in meshes), strict=True))
    assert many[..., :3].max() > 0.05
    np.testing.assert_array_equal(many, single)
    other = _picture_of_meshes(lambda scene: scene.add_meshes(_in_turn([soft, flat, torn])))
    assert np.abs(other - single).max() > 0.01


def test_of_many_meshes_all_or_none_are_added():
    flat = _bare(*_cube_faces())
    wrong = {**flat, "corner_vertices": flat["corner_vertices"] + np.uint32(1)}
    with Scene() as scene:
        with pytest.raises(VelourError, match="has vertex index 8, but the mesh has only 8 vertices"):
            scene.add_meshes(_in_turn([flat, wrong]))
        short = {**flat, "smooth": flat["smooth"][:-1]}
        with pytest.raises(VelourError, match="smooth has 11 numbers; 12 are needed"):
            scene.add_meshes(_in_turn([flat, short]))
        with pytest.raises(VelourError, match="The mesh has no positions"):
            scene.add_meshes({"triangles": _in_turn([flat])["triangles"]})
        assert scene.add_mesh(**flat) == (0, 0)
