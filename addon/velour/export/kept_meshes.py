"""The meshes of an export that goes on: what has not changed is not looked at again."""


class KeptMeshes(dict):
    """What ObjectExport makes of a mesh, by its key; of a single export no more than that."""

    def __init__(self):
        super().__init__()
        self._changed = frozenset()
        self._used = set()

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
        return is_known

    def drop_unused(self):
        """What no object has shown since begin()."""
        return [self.pop(key) for key in set(self) - self._used]
