"""Export of a whole scene."""

from typing import NamedTuple

from ..core.warning_table import sentences
from ..native import Scene
from .black import refuse_black
from .changes import Changes
from .color import set_working_space
from .kept_meshes import KeptMeshes
from .libraries import refuse_missing_libraries
from .materials import MaterialTable
from .objects import ObjectExport
from .pass_labels import AskedPasses, asked_passes
from .units import metres_per_unit
from .unused_settings import note_layer, note_scene
from .world import WorldLight, add_world, has_moving_picture, layer_world, shown_world

_NAMED_BEFORE = ("triangles_left_out",)  # warnings of the library that MeshQueue gives with the object's name


class Export(NamedTuple):
    scene: Scene  # committed
    materials: MaterialTable
    surroundings: str  # sentence naming the object that the camera is inside of, or empty
    passes: AskedPasses | None  # None: none requested


def export_scene(depsgraph, view, notes, check_break=lambda: None, strict=True):
    """Exports what the depsgraph shows through `view`; the caller must close the Export's scene."""
    export = SceneExport(notes, strict)
    try:
        return export.take(depsgraph, view, check_break)
    except BaseException:
        export.close()
        raise


class SceneExport:
    """The library's scene for renders; for subsequent frames, only changes are exported.

    `strict` refuses missing measured materials and libraries, and scenes that can only be black.
    `asked`: keys of table.PASSES.
    """

    def __init__(self, notes, strict=True, asked=()):
        self.notes = notes
        self._strict, self._asked = strict, asked
        self.scene = Scene()
        self.materials = MaterialTable(self.scene, notes, strict)
        self._meshes = KeptMeshes()
        self._world = WorldLight(self.scene)
        self._changes = None  # since the previous frame; None: first frame
        self._world_shines = False

    def close(self):
        self.scene.close()

    def follow(self, depsgraph):
        """Prepares take() for another frame; False if the changes require a new SceneExport.

        Blender sometimes reports a changed image only as a change of its materials.
        """
        self._changes = changes = Changes(depsgraph.updates)
        has_pictures = any(map(self.materials.has_pictures, changes.changed_materials(depsgraph)))
        return not (changes.everything or has_pictures or self._meshes.are_worn)

    def take(self, depsgraph, view, check_break=lambda: None, motion=None):
        """Returns an Export. `check_break` is called often and raises to cancel. After any error, close().

        `motion`: Motion of the frame, with the depsgraph in its middle; None: nothing moves.
        """
        if self._strict:
            refuse_missing_libraries(depsgraph.scene)
        if self._changes is None:
            set_working_space(self.scene)
        else:
            self._drop_changed(depsgraph)
        for sentence in motion.sentences if motion else ():
            self.notes.add(sentence)
        self._add_world(depsgraph, motion.frame if motion else depsgraph.scene.frame_current)
        objects = self._add_objects(depsgraph, check_break, motion)
        if self._strict:
            refuse_black(depsgraph, objects, self.materials, self._world_shines, self.notes)
        view.add_to(self.scene)
        note_scene(depsgraph.scene_eval, self.notes)
        note_layer(depsgraph.view_layer_eval, self.notes)
        check_break()
        self.scene.commit()
        info = self.scene.info()
        others = [each for each in info["warning_codes"] if each["code"] not in _NAMED_BEFORE]
        for sentence in sentences(others, metres=metres_per_unit(depsgraph.scene)):
            self.notes.add(sentence)
        surroundings = _surroundings(view.camera, objects.owner(info["camera_inside"]))
        if surroundings:
            self.notes.add(surroundings)
        return Export(self.scene, self.materials, surroundings, self._passes(depsgraph, objects))

    def _drop_changed(self, depsgraph):
        for material in self._changes.changed_materials(depsgraph):
            self.materials.renew(material)
        self.scene.clear_instances()
        self.scene.clear_lights()
        self._meshes.begin(self._changes.geometry)

    def _add_objects(self, depsgraph, check_break, motion):
        objects = ObjectExport(
            self.scene,
            self.materials,
            self.notes,
            check_break,
            meshes=self._meshes,
            shows_uvs="uv" in self._asked,
            motion=motion,
        )
        objects.add_all(depsgraph)
        sky_shines = self._world_shines and not self._world.is_even
        objects.note_partial_shadows(sky_shines, self.materials.glows)
        self._world.add_suns()
        if self._changes is not None:
            self._meshes.remove_unused(self.scene)
        return objects

    def _add_world(self, depsgraph, frame):
        world = shown_world(depsgraph)
        if self._changes is None or self._changes.world or has_moving_picture(world):
            self._world_shines = add_world(self._world, world, frame, self.notes)

    def _passes(self, depsgraph, objects):
        if not self._asked:
            return None
        layer = depsgraph.view_layer_eval
        world = layer_world(depsgraph.scene_eval, layer)
        return asked_passes(self._asked, layer, world, objects, self.materials)


def _surroundings(camera, owner):
    if owner is None:
        return ""
    return (
        f"Camera '{camera}': it is inside object '{owner}' and sees nothing else; move it out, hide"
        " the object from renders, or raise the camera's Clip Start."
    )
