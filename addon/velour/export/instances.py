"""Instances that differ in nothing but what and where they are, handed on together."""

from array import array

import numpy as np


class InstanceGroups:
    """Collects them, and adds the instances of each group to `scene` by one call."""

    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._groups = {}

    def add(self, mesh, look, matrix, owner):
        """`look`: (materials, hidden), as of Scene.add_instances; `owner`: the object's name."""
        group = self._groups.get(look)
        if group is None:
            group = self._groups[look] = (array("I"), array("f"), [])
        meshes, rows, owners = group
        meshes.append(mesh)
        owners.append(owner)
        for row in matrix[:3]:
            rows.extend(row)

    def add_to_scene(self):
        """The owners, in the order of the instances in the scene."""
        all_owners = []
        for (materials, hidden), (meshes, rows, owners) in self._groups.items():
            numbers = np.frombuffer(meshes, np.uint32)
            matrices = np.frombuffer(rows, np.float32).reshape(-1, 3, 4)
            finite = np.isfinite(matrices).all(axis=(1, 2))
            if not finite.all():
                numbers, matrices, owners = self._with_a_place(finite, numbers, matrices, owners)
            self._scene.add_instances(numbers, matrices, materials, hidden)
            all_owners += owners
        self._groups = {}
        return all_owners

    def _with_a_place(self, finite, numbers, matrices, owners):
        for i in np.flatnonzero(~finite):
            self._notes.add(f"Object '{owners[i]}': its transform is not a finite number; left out.")
        return numbers[finite], matrices[finite], [owners[i] for i in np.flatnonzero(finite)]
