"""Queues meshes for the library's scene and adds small ones together."""

from __future__ import annotations

import numpy as np

from ..native.mesh_descs import MESH_ARRAYS
from .mesh_arrays import MeshArrays

_ROOM = 1 << 18  # capacity of a pool, in numbers


class _Pool:
    """Memory for one array each of many meshes, stored back to back."""

    def __init__(self, dtype):
        self._memory = np.empty(_ROOM, dtype)
        self._held = 0
        self._lent_at = 0
        self._meshes, self._sizes = [], []  # queue index of each mesh held, and its count of numbers

    def lend(self, count):
        """Memory after the arrays held, valid until the next lend() unless held; a new array if too large."""
        self._lent_at = self._held
        end = self._held + count
        return self._memory[self._held : end] if end <= _ROOM else np.empty(count, self._memory.dtype)

    def hold(self, mesh, array):
        """Keeps `array`; copies it unless it was read into the memory lent last. False: there is no room."""
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
        """The numbers of the first `meshes` meshes and their counts, valid until another array is read."""
        sizes = np.zeros(meshes + 1, np.int64)
        sizes[self._meshes] = self._sizes
        sizes = sizes[:meshes]  # the mesh after them had no room in another pool
        self._held, self._meshes, self._sizes = 0, [], []
        return self._memory[: sizes.sum()], sizes


class MeshQueue:
    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._pools = {name: _Pool(MESH_ARRAYS[name][0]) for name in MeshArrays._fields}
        self._owners = []  # per queued mesh: name of an object that shows it
        self._triangles = []  # per queued mesh: number of triangles
        self._numbers = []  # scene ids of the meshes added so far; None: no valid triangles

    def empty(self, name, count, _dtype):
        """[count] Memory for the field `name` of the MeshArrays that are added next.

        If they are not added, the next mesh gets the same memory.
        """
        return self._pools[name].lend(count)

    def add(self, arrays, owner):
        """Queues a mesh and returns its queue index. `owner`: name of an object that shows it."""
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
        """Adds all queued meshes. Scene mesh ids by queue index; None for meshes without valid triangles."""
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
        """Scene id of a mesh; None if all of its triangles were dropped."""
        if dropped:
            self._notes.add(
                f"Object '{owner}': {dropped} triangles have NaN coordinates or no area and are left out."
            )
        return None if dropped == triangles else int(number)
