"""What of a scene is not rendered, told without rendering."""

import bpy

from ..export import ExportError, Notes, export_scene, visitor
from ..export.camera import final_view
from ..export.layer_passes import note_missing_passes
from ..export.unused_settings import note_strokes
from ..native import VelourError
from .scene_fit import ENGINE


class VELOUR_OT_check_scene(bpy.types.Operator):
    bl_idname = "velour.check_scene"
    bl_label = "Check Scene"
    bl_description = (
        "Say what of the scene Velour leaves out in this frame, and what it refuses to render, without"
        " rendering. Takes as long as the export of a render"
    )
    bl_options = {"REGISTER"}

    def execute(self, context):
        ignored, refused = _sentences(context.scene)
        context.window_manager.velour.checked.keep(context.scene, ignored, refused)
        for sentence in (*refused, *ignored):
            self.report({"WARNING"}, sentence)
        if not ignored and not refused:
            self.report({"INFO"}, "Nothing is left out.")
        return {"FINISHED"}


def _sentences(scene):
    """What is ignored, and why there is no picture of the frame, each of all view layers that render."""
    notes, refused = Notes(), Notes()

    def visit(_engine, depsgraph):
        try:
            export_scene(depsgraph, final_view(depsgraph, notes), notes).scene.close()
        except (ExportError, VelourError) as error:
            refused.add(str(error))
        note_missing_passes(depsgraph.view_layer_eval, notes)
        names.add(depsgraph.scene.name)

    names = set()  # of the copy that is looked at
    try:
        visitor.visit_frame(scene, scene.frame_current, visit, ENGINE)
    except ExportError as error:
        refused.add(str(error))
    for layer in scene.view_layers:
        if layer.use:
            note_strokes(scene, layer, notes)
    return tuple([_of_scene(sentence, names, scene) for sentence in each] for each in (notes, refused))


def _of_scene(sentence, copies, scene):
    for name in copies:
        sentence = sentence.replace(f"Scene '{name}'", f"Scene '{scene.name}'")
    return sentence
