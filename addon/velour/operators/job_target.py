"""Where the result of a job goes: found again whatever was done to the file meanwhile."""

import uuid

import bpy

_MOST_MARKS = 4  # on a node: of more jobs than run and wait
_LISTS = {bpy.types.Object: "objects", bpy.types.Collection: "collections", bpy.types.Scene: "scenes"}


def key_of(datablock):
    """Its key in the list of bpy.data: no pointer, for undo replaces datablocks."""
    return (datablock.name, datablock.library.filepath) if datablock.library else datablock.name


class JobTarget:
    """A measured material's node, by one of the marks on it and by names: undo may replace any datablock."""

    def __init__(self, material, node):
        self.material_name, self._node_name = material.name, node.name
        self._mark = uuid.uuid4().hex
        node.velour.job = " ".join([*node.velour.job.split(), self._mark][-_MOST_MARKS:])

    def find(self):
        """The material and its node, also where they were renamed; (None, None) where they are gone."""
        material, node = next(self._marked(), (None, None))
        if node is not None:
            return material, node
        # An undo to what was before the mark takes it away.
        material = bpy.data.materials.get(self.material_name)
        node = material.node_tree.nodes.get(self._node_name) if material and material.node_tree else None
        return (material, node) if node is not None else (None, None)

    def _marked(self):
        """A copy has the mark as well: the original, if it is still called what it was, comes first."""
        for material in sorted(bpy.data.materials, key=lambda m: m.name != self.material_name):
            for node in material.node_tree.nodes if material.node_tree else ():
                if node.bl_idname == "ShaderNodeTexImage" and self._mark in node.velour.job.split():
                    yield material, node


class JobOwner:
    """An object, a collection or a scene, by one of the marks on it and by names: undo may replace any
    datablock."""

    def __init__(self, owner):
        self._list = next(name for kind, name in _LISTS.items() if isinstance(owner, kind))
        self.name, self._names = owner.name, _names(owner)
        self._mark = uuid.uuid4().hex
        if owner.library is not None:  # goes by its names, which nobody changes
            return
        owner.velour.jobs = f"{owner.velour.jobs} {self._mark}".strip()  # others may wait for it as well

    def find(self):
        """The owner, also where it was renamed; None where it is gone."""
        owners = self._owners()
        marked = (owner for owner in owners if self._mark in _marks(owner))
        # An undo to what was before the mark takes it away.
        return next(marked, None) or next((o for o in owners if _names(o) == self._names), None)

    def take(self):
        """The owner as find() does, without its mark."""
        found = self.find()
        for owner in [owner for owner in self._owners() if self._mark in _marks(owner)]:
            rest = [mark for mark in _marks(owner) if mark != self._mark]
            owner.velour.jobs = " ".join(rest)
            if not rest:
                owner.velour.property_unset("jobs")
        return found

    def _owners(self):
        """Copies have the mark as well: the original, if it is called as it was, comes first."""
        return sorted(getattr(bpy.data, self._list), key=lambda owner: _names(owner) != self._names)


def _names(owner):
    """Its own, and of an object its data's: one that was put in its place has others."""
    data = getattr(owner, "data", None)
    return key_of(owner), key_of(data) if data else None


def _marks(owner):
    # Looking into settings makes them.
    return owner.velour.jobs.split() if owner.is_property_set("velour") else ()
