"""Meshes on their way to the library's scene: small ones are handed on together."""

from __future__ import annotations

import numpy as np

from ..native.mesh_descs import MESH_ARRAYS
from .mesh_arrays import MeshArrays

_ROOM = 1 << 18  # numbers in a pool


class _Pool:
    """Memory for one array each of many meshes, one behind the other without a gap."""

    def __init__(self, dtype):
        self._memory = np.empty(_ROOM, dtype)
        self._held = 0
        self._lent_at = 0
        self._meshes, self._sizes = [], []  # which of those that wait hold how many numbers

    def lend(self, count):
        """Memory behind what is held, until another asks or hold() makes it last; else memory of its own."""
        self._lent_at = self._held
        end = self._held + count
        return self._memory[self._held : end] if end <= _ROOM else np.empty(count, self._memory.dtype)

    def hold(self, mesh, array):
        """Puts it there, if it was not read into what was lent last; False: there is no room."""
        end = self._held + array.size
        if end > _ROOM:
            return False
        if array.base is not self._memory or self._lent_at != self._held:
            self._memory[self._held : end] = array.reshape(-1)
        self._meshes.append(mesh)
        self._sizes.append(end - self._held)
        self._held = end
        return True

    def take(self, meshes):
        """What that many hold, which stays until another array is read, and how much of it each."""
        sizes = np.zeros(meshes + 1, np.int64)
        sizes[self._meshes] = self._sizes
        sizes = sizes[:meshes]  # the one beyond had no room in another pool
        self._held, self._meshes, self._sizes = 0, [], []
        return self._memory[: sizes.sum()], sizes


class MeshQueue:
    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._pools = {name: _Pool(MESH_ARRAYS[name][0]) for name in MeshArrays._fields}
        self._owners = []  # of those that wait: an object's name
        self._triangles = []  # of those, how many
        self._numbers = []  # in the scene, of all before; None: there is nothing to see

    def empty(self, name, count, _dtype):
        """[count] Memory for the field `name` of the MeshArrays that are added next.

        What is not added leaves nothing behind: the next mesh is given the same memory.
        """
        return self._pools[name].lend(count)

    def add(self, arrays, owner):
        """Its place; `owner`: the name of an object that shows it."""
        waiting = len(self._owners)
        for pool, array in zip(self._pools.values(), arrays, strict=True):
            if array is not None and not pool.hold(waiting, array):
                return self._add_alone(arrays, owner)
        self._owners.append(owner)
        self._triangles.append(len(arrays.triangles))
        return len(self._numbers) + waiting

    def _add_alone(self, arrays, owner):
        self._hand_on()
        number, dropped = self._scene.add_mesh(**arrays._asdict())
        self._numbers.append(self._seen(number, dropped, len(arrays.triangles), owner))
        return len(self._numbers) - 1

    def numbers(self):
        """By place: in the scene, where all are by now; None of what has no triangle with an area."""
        self._hand_on()
        return self._numbers

    def _hand_on(self):
        held = {name: pool.take(len(self._owners)) for name, pool in self._pools.items()}
        if self._owners:
            meshes = {name: each for name, each in held.items() if len(each[0])}
            handed_on = zip(*self._scene.add_meshes(meshes), self._triangles, self._owners, strict=True)
            self._numbers += [self._seen(*each) for each in handed_on]
        self._owners, self._triangles = [], []

    def _seen(self, number, dropped, triangles, owner):
        """The number of a mesh; None where nothing of it is left."""
        if dropped:
            self._notes.add(f"Object '{owner}': {dropped} triangles without area or with NaN are left out.")
        return None if dropped == triangles else int(number)
