"""The library's scene for a viewport, updated incrementally with changes of the .blend."""

import numpy as np
from mathutils import Matrix

from ..native import Scene
from .changes import Changes
from .color import set_working_space
from .kept_meshes import KeptMeshes
from .materials import MaterialTable
from .notes import Notes
from .objects import ObjectExport
from .world import WorldLight, add_world, shown_world


class LiveExport:
    """The renderer commits the scene and sets its camera."""

    def __init__(self, depsgraph, look, scene=None):
        """`scene`: replacement for the library's Scene with the same interface."""
        self.scene = Scene() if scene is None else scene
        try:
            set_working_space(self.scene)
            self._materials = MaterialTable(self.scene, Notes(), False)
            self._meshes = KeptMeshes()
            self._world = WorldLight(self.scene, waits=False)
            self._look = look.key()
            self._add_world(depsgraph, look)
            self._add_objects(depsgraph, look)
        except BaseException:
            self.scene.close()
            raise

    def close(self):
        self.scene.close()

    def changes(self, depsgraph, look):
        """Changes reported by depsgraph and viewport; `everything` asks for a new export."""
        changes = Changes(depsgraph.updates)
        objects, world, scene = look.key()
        changes.objects |= objects != self._look[0]
        changes.world |= world != self._look[1]
        changes.everything |= scene != self._look[2] or self._meshes.are_worn
        return changes

    def update(self, changes, depsgraph, look):
        self._look = look.key()
        has_new_suns = changes.world and self._add_world(depsgraph, look)
        if self._renew(changes.changed_materials(depsgraph)) or changes.objects:
            self._add_objects(depsgraph, look, changes.geometry)
        elif changes.lights or has_new_suns:
            self._add_lights(depsgraph, look)

    def _renew(self, materials):
        """Updates materials; returns whether their objects must be exported again for texture coordinates."""
        return any([self._materials.renew(material) for material in materials])

    def _add_objects(self, depsgraph, look, changed=frozenset()):
        self.scene.clear_instances()
        self.scene.clear_lights()
        self._meshes.begin(changed)
        self._export().add_shown(depsgraph, look.shows)
        self._world.add_suns()
        self._meshes.remove_unused(self.scene)

    def _add_lights(self, depsgraph, look):
        self.scene.clear_lights()
        self._export().add_shown(depsgraph, lambda i: i.object.type == "LIGHT" and look.shows(i))
        self._world.add_suns()

    def _export(self):
        return ObjectExport(self.scene, self._materials, Notes(), lambda: None, meshes=self._meshes)

    def _add_world(self, depsgraph, look):
        """Returns whether the suns of the sky have changed."""
        suns, light = self._world.suns, look.studio_light
        if light:
            turn = np.array(Matrix.Rotation(light.turn, 3, "Z"), np.float32)
            self._world.set_file(light.path, light.strength, turn)
        else:
            add_world(self._world, shown_world(depsgraph), depsgraph.scene.frame_current, Notes())
        return self._world.suns != suns
