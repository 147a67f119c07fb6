"""The whole export, in order."""

from ..native import Scene
from .color import set_working_space
from .materials import MaterialTable
from .objects import ObjectExport
from .world import add_world


def export_scene(depsgraph, view, notes, check_break=lambda: None, strict=True):
    """A committed library scene of what the depsgraph shows, seen through `view`, and its MaterialTable.

    `check_break` is called often and raises to stop; `strict` refuses measured materials that cannot be had.
    """
    scene = Scene()
    try:
        set_working_space(scene)
        materials = MaterialTable(scene, notes, strict)
        ObjectExport(scene, materials, notes, check_break).add_all(depsgraph)
        has_sky = depsgraph.view_layer_eval.use_sky
        add_world(scene, depsgraph.scene_eval.world if has_sky else None, notes)
        view.add_to(scene)
        _note_scene(depsgraph.scene_eval, notes)
        check_break()
        scene.commit()
        for warning in scene.info()["warnings"]:
            notes.add(warning)
        return scene, materials
    except BaseException:
        scene.close()
        raise


def _note_scene(scene, notes):
    if scene.render.use_motion_blur:
        notes.add(f"Scene '{scene.name}': motion blur is not supported; ignored.")
