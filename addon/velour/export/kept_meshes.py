"""The meshes of an export that goes on: what has not changed is not looked at again."""

from ..core.mesh_queue import MeshQueue

_MOST_REMOVED = 4096


class KeptMeshes(dict):
    """What ObjectExport makes of a mesh, by its key; of a single export no more than that."""

    def __init__(self):
        super().__init__()
        self._changed = frozenset()
        self._used = set()
        self._replaced = []  # by other geometry of the same objects
        self._queue = None
        self._removed = 0

    def queue(self, scene, notes):
        """The MeshQueue of all exports, which are into the same scene."""
        if self._queue is None:
            self._queue = MeshQueue(scene, notes)
        return self._queue

    def begin(self, changed):
        """Another export; `changed`: pointers of objects of the .blend whose geometry may be another one."""
        self._changed = changed
        self._used = set()

    def has(self, key, obj):
        """Whether what is kept under `key` is the mesh of the evaluated object `obj` that shows it now.

        Memory of evaluated meshes is used again, so the key alone does not tell.
        """
        is_known = key in self and (key in self._used or obj.original.as_pointer() not in self._changed)
        self._used.add(key)
        if not is_known and key in self:
            self._replaced.append(self.pop(key))
        return is_known

    def remove_unused(self, scene):
        """From the library's scene, what no object shows since begin()."""
        dropped = self._replaced + [self.pop(key) for key in set(self) - self._used]
        self._replaced = []
        numbers = [self._queue.numbers()[mesh.place] for mesh in dropped if mesh]
        removed = [number for number in numbers if number is not None]
        for number in removed:
            scene.remove_mesh(number)
        self._removed += len(removed)

    @property
    def are_worn(self):
        """Whether so many were removed, whose numbers stay in the scene, that all had better begin anew."""
        return self._removed > _MOST_REMOVED
