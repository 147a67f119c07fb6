"""Meshes that wait for others arrive as they were read, whatever came between."""

from __future__ import annotations

import numpy as np
import pytest
from velour.core import mesh_queue
from velour.core.mesh_arrays import MeshArrays
from velour.native.mesh_descs import MESH_ARRAYS


class RecordingScene:
    """Keeps copies of what is added, as the keywords of Scene.add_mesh."""

    def __init__(self):
        self.meshes = []

    def add_mesh(self, **arrays):
        self.meshes.append({n: a.reshape(-1).copy() for n, a in arrays.items() if a is not None})
        return len(self.meshes) - 1, 0

    def add_meshes(self, meshes):
        first, count = len(self.meshes), len(meshes["triangles"][1])
        for i in range(count):
            ends = {name: np.cumsum(sizes) for name, (_, sizes) in meshes.items()}
            self.add_mesh(
                **{
                    name: joined[ends[name][i] - sizes[i] : ends[name][i]]
                    for name, (joined, sizes) in meshes.items()
                    if sizes[i]
                }
            )
        return range(first, first + count), [0] * count


@pytest.fixture
def scene():
    return RecordingScene()


@pytest.fixture
def queue(scene):
    return mesh_queue.MeshQueue(scene, set())


def read(queue, triangles, seed, names=("positions", "triangles", "corner_vertices", "material_slots")):
    """MeshArrays of random numbers; those of vertices and faces as large as those of triangles."""
    random = np.random.default_rng(seed)
    found = dict.fromkeys(MeshArrays._fields)
    for name in names:
        dtype, _, shape = MESH_ARRAYS[name]
        memory = queue.empty(name, triangles * int(np.prod(shape)), dtype)
        memory[:] = random.integers(0, 1 << 20, memory.shape)
        found[name] = memory.reshape(-1, *shape)
    return MeshArrays(**found)


def added(queue, *arrays):
    """What each of them holds, as it is put into the queue."""
    expected = []
    for each in arrays:
        fields = each._asdict().items()
        expected.append({n: a.reshape(-1).copy() for n, a in fields if a is not None})
        queue.add(each, "owner")
    return expected


def assert_same(found, expected):
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        assert one.keys() == other.keys()
        for name in one:
            np.testing.assert_array_equal(one[name], other[name])


def test_meshes_arrive_as_they_were_read(queue, scene):
    expected = [held for seed in range(5) for held in added(queue, read(queue, 3 + seed, seed))]
    assert scene.meshes == []  # they wait for one another
    assert queue.numbers() == [0, 1, 2, 3, 4]
    assert_same(scene.meshes, expected)


@pytest.mark.parametrize("names", [("positions",), ("positions", "triangles", "vertex_normals")])
def test_what_is_read_but_not_added_leaves_no_gap(queue, scene, names):
    expected = added(queue, read(queue, 4, 0))
    read(queue, 7, 1, names)
    expected += added(queue, read(queue, 5, 2))
    read(queue, 2, 3, names)
    expected += added(queue, read(queue, 6, 4))
    queue.numbers()
    assert_same(scene.meshes, expected)


def test_a_mesh_may_be_read_before_the_others_are_handed_on(queue, scene):
    expected = added(queue, read(queue, 4, 0))
    late = read(queue, 5, 1)
    queue.numbers()
    expected += added(queue, late)
    expected += added(queue, read(queue, 3, 2))
    queue.numbers()
    assert_same(scene.meshes, expected)


def test_a_mesh_without_room_beside_others_comes_behind_them(queue, scene, monkeypatch):
    monkeypatch.setattr(mesh_queue, "_ROOM", 40)
    small = mesh_queue.MeshQueue(scene, set())
    expected = added(small, read(small, 4, 0))
    expected += added(small, read(small, 11, 1))  # has room by itself, but for less than all that it has
    expected += added(small, read(small, 100, 2))
    expected += added(small, read(small, 3, 3))
    assert small.numbers() == [0, 1, 2, 3]
    assert_same(scene.meshes, expected)
