"""The whole export, in order."""

from typing import NamedTuple

from ..native import Scene
from .black import refuse_black
from .color import set_working_space
from .libraries import refuse_missing_libraries
from .materials import MaterialTable
from .objects import ObjectExport
from .pass_labels import AskedPasses, asked_passes
from .world import add_world, layer_world, shown_world


class Export(NamedTuple):
    scene: Scene  # committed
    materials: MaterialTable
    surroundings: str  # a sentence on what the camera is inside of; empty: it is not
    passes: AskedPasses | None  # None: none was asked for


def export_scene(depsgraph, view, notes, check_break=lambda: None, strict=True, asked=()):
    """What the depsgraph shows, seen through `view`, as an Export.

    `check_break` is called often and raises to stop; `strict` refuses measured materials and libraries that
    cannot be had, and what can only be black. `asked`: of table.PASSES.
    """
    if strict:
        refuse_missing_libraries(depsgraph.scene)
    scene = Scene()
    try:
        set_working_space(scene)
        materials = MaterialTable(scene, notes, strict)
        objects = ObjectExport(scene, materials, notes, check_break, shows_uvs="uv" in asked)
        objects.add_all(depsgraph)
        world_shines = add_world(scene, shown_world(depsgraph), notes)
        if strict:
            refuse_black(depsgraph, objects, materials, world_shines, notes)
        view.add_to(scene)
        _note_scene(depsgraph.scene_eval, notes)
        check_break()
        scene.commit()
        info = scene.info()
        for warning in info["warnings"]:
            notes.add(warning)
        surroundings = _surroundings(depsgraph.scene.camera, objects.owner(info["camera_inside"]))
        if surroundings:
            notes.add(surroundings)
        layer = depsgraph.view_layer_eval
        world = layer_world(depsgraph.scene_eval, layer)
        passes = asked_passes(asked, layer, world, objects, materials) if asked else None
        return Export(scene, materials, surroundings, passes)
    except BaseException:
        scene.close()
        raise


def _surroundings(camera, owner):
    if owner is None:
        return ""
    return (
        f"Camera '{camera.name}': it is inside of object '{owner}' and sees nothing else; move it out, hide"
        " the object from renders, or raise the camera's Clip Start."
    )


def _note_scene(scene, notes):
    if scene.render.use_motion_blur:
        notes.add(f"Scene '{scene.name}': motion blur is not supported; ignored.")
