"""Targets of job results, which are found again after any change of the file."""

import uuid

import bpy

from ..export.nodes import all_measured

_MOST_MARKS = 4  # per node; more than there are running and queued jobs
_LISTS = {bpy.types.Object: "objects", bpy.types.Collection: "collections", bpy.types.Scene: "scenes"}


def key_of(datablock):
    """Key in the list of bpy.data; not a pointer, since undo replaces datablocks."""
    return (datablock.name, datablock.library.filepath) if datablock.library else datablock.name


class JobTarget:
    """A measured material's node, found by a mark on it or by names, since undo may replace any datablock.

    `node`: MeasuredNode.
    """

    def __init__(self, material, node):
        self.material_name, self._node_name = material.name, node.name
        self._mark = uuid.uuid4().hex
        node.velour.job = " ".join([*node.velour.job.split(), self._mark][-_MOST_MARKS:])

    def find(self):
        """The material and its node, even if renamed; (None, None) if they are gone."""
        material, node = next(self._marked(), (None, None))
        if node is not None:
            return material, node
        # Undo to a state before the mark removes it.
        material = bpy.data.materials.get(self.material_name)
        node = next((node for node in all_measured(material) if node.name == self._node_name), None)
        return (material, node) if node is not None else (None, None)

    def _marked(self):
        """Marked nodes. Copies have the mark as well; the original comes first if its name is unchanged."""
        for material in sorted(bpy.data.materials, key=lambda m: m.name != self.material_name):
            for node in all_measured(material):
                if self._mark in node.velour.job.split():
                    yield material, node


class JobOwner:
    """An object, a collection or a scene, found by a mark on it or by names, since undo may replace any
    datablock."""

    def __init__(self, owner):
        self._list = next(name for kind, name in _LISTS.items() if isinstance(owner, kind))
        self.name, self._names = owner.name, _names(owner)
        self._mark = uuid.uuid4().hex
        if owner.library is not None:  # found by its names, which do not change
            return
        owner.velour.jobs = f"{owner.velour.jobs} {self._mark}".strip()  # other jobs may have marked it, too

    def find(self):
        """The owner, even if renamed; None if it is gone."""
        owners = self._owners()
        marked = (owner for owner in owners if self._mark in _marks(owner))
        # Undo to a state before the mark removes it.
        return next(marked, None) or next((o for o in owners if _names(o) == self._names), None)

    def take(self):
        """Like find(), and removes the mark."""
        found = self.find()
        for owner in [owner for owner in self._owners() if self._mark in _marks(owner)]:
            rest = [mark for mark in _marks(owner) if mark != self._mark]
            owner.velour.jobs = " ".join(rest)
            if not rest:
                owner.velour.property_unset("jobs")
        return found

    def _owners(self):
        """Candidates. Copies have the mark as well; the original comes first if its name is unchanged."""
        return sorted(getattr(bpy.data, self._list), key=lambda owner: _names(owner) != self._names)


def _names(owner):
    """Keys of the owner and of its data, which tell an object from one that replaced it."""
    data = getattr(owner, "data", None)
    return key_of(owner), key_of(data) if data else None


def _marks(owner):
    # Accessing the settings would create them.
    return owner.velour.jobs.split() if owner.is_property_set("velour") else ()
