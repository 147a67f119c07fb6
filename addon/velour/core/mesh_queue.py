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

    def lend(self, count):
        """Memory behind what is held, until another asks or hold() makes it last; None: there is no room."""
        self._lent_at = self._held
        end = self._held + count
        return self._memory[self._held : end] if end <= _ROOM else None

    def hold(self, array):
        """Puts it there, if it was not read into what was lent last; False: there is no room."""
        end = self._held + array.size
        if end > _ROOM:
            return False
        if array.base is not self._memory or self._lent_at != self._held:
            self._memory[self._held : end] = array.reshape(-1)
        self._held = end
        return True

    def take_all(self):
        """What is held, which stays until another array is read."""
        held, self._held = self._memory[: self._held], 0
        return held


class MeshQueue:
    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._pools = {name: _Pool(MESH_ARRAYS[name][0]) for name in MeshArrays._fields}
        self._owners = []  # of those that wait: an object's name
        self._sizes = []  # of those, and of each of its arrays
        self._numbers = []  # in the scene, of all before; None: there is nothing to see

    def empty(self, name, count, dtype):
        """[count] Memory for the field `name` of the MeshArrays that are added next.

        What is not added leaves nothing behind: the next mesh is given the same memory.
        """
        memory = self._pools[name].lend(count)
        return np.empty(count, dtype) if memory is None else memory

    def add(self, arrays, owner):
        """Its place; `owner`: the name of an object that shows it."""
        place = len(self._numbers) + len(self._owners)
        pools = self._pools.values()
        if all(array is None or pool.hold(array) for pool, array in zip(pools, arrays, strict=True)):
            self._owners.append(owner)
            self._sizes.append([0 if array is None else array.size for array in arrays])
        else:
            self._hand_on()
            number, dropped = self._scene.add_mesh(**arrays._asdict())
            self._numbers.append(self._seen(number, dropped, len(arrays.triangles), owner))
        return place

    def numbers(self):
        """By place: in the scene, where all are by now; None of what has no triangle with an area."""
        self._hand_on()
        return self._numbers

    def _hand_on(self):
        held = [pool.take_all() for pool in self._pools.values()]
        if self._owners:
            sizes = np.array(self._sizes).T
            found = zip(self._pools, held, sizes, strict=True)
            meshes = {name: (memory[: each.sum()], each) for name, memory, each in found if each.any()}
            triangles = meshes["triangles"][1] // 3
            handed_on = zip(*self._scene.add_meshes(meshes), triangles, self._owners, strict=True)
            self._numbers += [self._seen(*each) for each in handed_on]
        self._owners, self._sizes = [], []

    def _seen(self, number, dropped, triangles, owner):
        """The number of a mesh; None where nothing of it is left."""
        if dropped:
            self._notes.add(f"Object '{owner}': {dropped} triangles without area or with NaN are left out.")
        return None if dropped == triangles else int(number)
