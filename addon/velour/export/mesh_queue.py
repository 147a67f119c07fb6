"""Meshes on their way to the library's scene: small ones are handed on together."""

import numpy as np

from ..native.mesh_descs import MESH_ARRAYS
from .meshes import MeshArrays

_ROOM = 1 << 18  # numbers in a pool


class _Pool:
    """Memory for one array each of many meshes, in turn."""

    def __init__(self, dtype):
        self.memory = np.empty(_ROOM, dtype)
        self.used = 0

    def take(self, count):
        """None: there is no room."""
        begin, end = self.used, self.used + count
        if end > _ROOM:
            return None
        self.used = end
        return self.memory[begin:end]

    def holds(self, array):
        """Puts it there, if it is not; False: there is no room."""
        if array.base is self.memory:
            return True
        room = self.take(array.size)
        if room is not None:
            room[:] = array.reshape(-1)
        return room is not None


class MeshQueue:
    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._pools = {name: _Pool(MESH_ARRAYS[name][0]) for name in MeshArrays._fields}
        self._owners = []  # of those that wait: an object's name
        self._sizes = []  # of those, and of each of its arrays
        self._numbers = []  # in the scene, of all before; None: there is nothing to see

    def empty(self, name, count, dtype):
        """[count] Memory for the field `name` of the MeshArrays that are added next."""
        memory = self._pools[name].take(count)
        return np.empty(count, dtype) if memory is None else memory

    def add(self, arrays, owner):
        """Its place; `owner`: the name of an object that shows it."""
        place = len(self._numbers) + len(self._owners)
        pools = self._pools.values()
        if all(array is None or pool.holds(array) for pool, array in zip(pools, arrays, strict=True)):
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
        if self._owners:
            sizes = np.array(self._sizes).T
            found = zip(self._pools.items(), sizes, strict=True)
            meshes = {name: (pool.memory[: each.sum()], each) for (name, pool), each in found if each.any()}
            triangles = meshes["triangles"][1] // 3
            handed_on = zip(*self._scene.add_meshes(meshes), triangles, self._owners, strict=True)
            self._numbers += [self._seen(*each) for each in handed_on]
        self._owners, self._sizes = [], []
        for pool in self._pools.values():
            pool.used = 0

    def _seen(self, number, dropped, triangles, owner):
        """The number of a mesh; None where nothing of it is left."""
        if dropped:
            self._notes.add(f"Object '{owner}': {dropped} triangles without area or with NaN are left out.")
        return None if dropped == triangles else int(number)
