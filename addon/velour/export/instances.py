"""Instances that differ in nothing but where they are, handed on together."""

from array import array

import numpy as np


class InstanceGroups:
    """Collects matrices, and adds the instances of each group to `scene` by one call."""

    def __init__(self, scene):
        self._scene = scene
        self._groups = {}

    def add(self, look, matrix):
        """`look`: (mesh, materials, hidden), as of Scene.add_instances."""
        rows = self._groups.get(look)
        if rows is None:
            rows = self._groups[look] = array("f")
        for row in matrix[:3]:
            rows.extend(row)

    def add_to_scene(self):
        for (mesh, materials, hidden), rows in self._groups.items():
            matrices = np.frombuffer(rows, np.float32).reshape(-1, 3, 4)
            self._scene.add_instances(mesh, matrices, materials, hidden)
        self._groups = {}
