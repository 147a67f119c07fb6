"""Mesh cache of a live export: unchanged meshes are not exported again."""

from ..core.mesh_queue import MeshQueue

_MOST_REMOVED = 4096


class KeptMeshes(dict):
    """Results of ObjectExport by mesh key. A single export uses it as a plain dictionary."""

    def __init__(self):
        super().__init__()
        self._changed = frozenset()
        self._used = set()
        self._replaced = []  # entries whose objects have new geometry
        self._queue = None
        self._removed = 0

    def queue(self, scene, notes):
        """The MeshQueue that all exports share; they go into the same scene."""
        if self._queue is None:
            self._queue = MeshQueue(scene, notes)
        return self._queue

    def begin(self, changed):
        """Starts an export. `changed`: pointers of original objects whose geometry may have changed."""
        self._changed = changed
        self._used = set()

    def has(self, key, obj):
        """Whether the entry under `key` is the current mesh of the evaluated object `obj`.

        Blender reuses the memory of evaluated meshes, so the key alone is not enough.
        """
        is_known = key in self and (key in self._used or obj.original.as_pointer() not in self._changed)
        self._used.add(key)
        if not is_known and key in self:
            self._replaced.append(self.pop(key))
        return is_known

    def remove_unused(self, scene):
        """Removes meshes that no object has used since begin() from the library's scene."""
        dropped = self._replaced + [self.pop(key) for key in set(self) - self._used]
        self._replaced = []
        numbers = [self._queue.numbers()[mesh.place] for mesh in dropped if mesh]
        removed = [number for number in numbers if number is not None]
        for number in removed:
            scene.remove_mesh(number)
        self._removed += len(removed)

    @property
    def are_worn(self):
        """Whether so many meshes were removed, whose ids stay allocated, that a full export is due."""
        return self._removed > _MOST_REMOVED
