"""Lists the unsupported features of a scene without rendering."""

import bpy

from ..export import ExportError, Notes, export_scene, visitor
from ..export.camera import final_view
from ..export.layer_passes import note_missing_passes
from ..export.scene_models import served
from ..export.unused_settings import note_strokes, refuse_settings
from ..native import VelourError
from .scene_fit import ENGINE


class VELOUR_OT_check_scene(bpy.types.Operator):
    bl_idname = "velour.check_scene"
    bl_label = "Check Scene"
    bl_description = (
        "List what Velour does not support in this frame, and scene models that were not fitted for it,"
        " without rendering"
    )
    bl_options = {"REGISTER"}

    def execute(self, context):
        check = _Check(context.scene)
        ignored, refused = check.sentences(check.notes), check.sentences(check.refused)
        context.window_manager.velour.checked.keep(context.scene, ignored, refused, check.served)
        for sentence in (*refused, *ignored):
            self.report({"WARNING"}, sentence)
        if not ignored and not refused:
            self.report({"INFO"}, "All features of this frame are supported.")
        return {"FINISHED"}


class _Check:
    """Findings for all enabled view layers: what is ignored, why the frame is refused, and whether scene
    models are valid in it (`served`)."""

    def __init__(self, scene):
        self._scene, self._copies = scene, set()
        self.notes, self.refused, self.served = Notes(), Notes(), []
        try:
            refuse_settings(scene)
        except (ExportError, VelourError) as error:
            self.refused.add(str(error))
        try:
            visitor.visit_frame(scene, scene.frame_current, self._visit, ENGINE)
        except ExportError as error:
            self.refused.add(str(error))
        for layer in scene.view_layers:
            if layer.use:
                note_strokes(scene, layer, self.notes)

    def sentences(self, notes):
        return [self._of_scene(sentence) for sentence in notes]

    def _visit(self, _engine, depsgraph):
        try:
            self._look(depsgraph)
        except (ExportError, VelourError) as error:
            self.refused.add(str(error))
        note_missing_passes(depsgraph.view_layer_eval, self.notes)
        self._copies.add(depsgraph.scene.name)

    def _look(self, depsgraph):
        view = final_view(depsgraph)
        export = export_scene(depsgraph, view, self.notes)
        reduced = export.materials.reduced
        with export.scene:
            try:
                found = served(export.scene, reduced, view, depsgraph)
            finally:
                for entry in reduced:
                    entry.model.close()
        for each in found:
            if not each.is_inside:
                self.notes.add(each.sentence)
        self.served += found

    def _of_scene(self, sentence):
        """Replaces the name of the inspected copy by the scene's own."""
        for name in self._copies:
            sentence = sentence.replace(f"Scene '{name}'", f"Scene '{self._scene.name}'")
        return sentence
