"""Batches of instances that differ only in mesh and transform."""

from array import array

import numpy as np

_NOTHING = 2**32 - 1  # stands for a missing mesh


class InstanceGroups:
    """Collects instances and adds each group to `scene` with one call."""

    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._groups = {}

    def add(self, mesh, look, matrix, owner, motion=None):
        """`mesh`: index in a MeshQueue; `look`: (materials, hidden, terminator) of Scene.add_instances.

        `owner`: the object's Owner. `motion`: matrices [steps x 3 x 4] in place of `matrix`.
        """
        key = (look, 0 if motion is None else len(motion))
        group = self._groups.get(key)
        if group is None:
            group = self._groups[key] = (array("I"), array("f"), [])
        places, rows, owners = group
        places.append(mesh)
        owners.append(owner)
        if motion is None:
            rows.fromlist([*matrix[0], *matrix[1], *matrix[2]])
        else:
            rows.frombytes(motion.tobytes())

    def add_to_scene(self, numbers):
        """Adds the groups; returns the owners in the order of the instances in the scene.

        `numbers`: scene mesh ids by queue index; instances of meshes without one are left out.
        """
        all_owners = []
        numbers = np.array([_NOTHING if number is None else number for number in numbers], np.uint32)
        for (look, steps), (places, rows, owners) in self._groups.items():
            meshes = numbers[np.frombuffer(places, np.uint32)]
            matrices = np.frombuffer(rows, np.float32).reshape(-1, *([steps] if steps else []), 3, 4)
            finite = np.isfinite(matrices.reshape(len(matrices), -1)).all(axis=1)
            self._note_endless(finite, owners)
            shown = finite & (meshes != _NOTHING)
            if not shown.all():
                meshes, matrices = meshes[shown], matrices[shown]
                owners = [owners[i] for i in np.flatnonzero(shown)]
            self._scene.add_instances(meshes, matrices, *look)
            all_owners += owners
        self._groups = {}
        return all_owners

    def _note_endless(self, finite, owners):
        for i in np.flatnonzero(~finite):
            self._notes.add(f"Object '{owners[i].name}': its transform is not finite; left out.")
