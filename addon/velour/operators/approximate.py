"""Approximates a measured material: in the background or, without a window, synchronously."""

import bpy

from ..core.read_job import ReadJob
from ..core.sizes import percent
from ..export import ExportError
from ..export.files import sha256
from . import approximation_group, measured
from .background_job import JobsInSteps
from .convert import convert
from .job_target import JobTarget
from .shared_group import AsksUsers

_LONG_SECONDS = 10.0  # of a fit that no undo may lose, whatever the undo is meant for


class MakesModel(AsksUsers, JobsInSteps):
    """Mixin for an operator whose first job makes a model. The material gets it at once; the approximation
    for other engines follows.

    `_put()` puts the model of `_data`, `_info` and the first job's `_report`; it returns the material and its
    node, or (None, None) if they are gone.
    """

    _data = None  # contents of the model file
    _user = None  # JobTarget of the material that has the model

    def _finish(self):
        if self._data is None:
            with self._job:
                model, self._report = self._job.result_model(), self._job.report()
                self._seconds = self._job.poll().seconds
            self._data, self._info = model.bytes(), model.info()
            material, node = self._put()
            if node is None:
                return {"FINISHED"}
            approximation_group.put_inputs(node, material, self._info)
            self._user, self._what = JobTarget(material, node), "The approximation"
            self._after_cancel = "; other engines do not show the new model"
            self._steps = approximation_group.steps(model)
            if self._ticket is not None and self._seconds > _LONG_SECONDS:
                bpy.ops.ed.undo_push(message=self.bl_label)
        if self._advance():
            return None
        (material, node), digest = self._user.find(), sha256(self._data)
        if measured.model_key(node) != digest:  # an undo took it back; a step here would end its redo
            return {"CANCELLED"}
        approximation_group.put(node, material, self._steps.result, self._info, digest)
        return {"FINISHED"}

    def _fail(self, error):
        """Ends as finished if the material has the model, so that an undo takes it back."""
        failed = super()._fail(error)
        return {"FINISHED"} if self._user is not None else failed


class VELOUR_OT_approximate(measured.OfMaterial, JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.approximate"
    bl_label = "Approximate"
    bl_description = (
        "Fit the nodes in the material's node group to the model, for EEVEE, Cycles and Solid mode. Nodes of"
        " your own are not changed"
    )
    bl_options = {"UNDO"}

    _what = "The approximation"

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        owner = f"Material '{material.name}'"
        if not approximation_group.is_editable(material):
            raise ExportError(f"{owner} is linked from another file; approximate it there or make it local.")
        node = measured.modelled_node(material)
        measured.refuse_linked_group(material, node)
        self._target, self._subject = JobTarget(material, node), material.name

    def _take_turn(self):
        self._job = self._reading = ReadJob(measured.stored_model(self._target).model_and_digest)
        self._model = measured.model_key(self._target.find()[1])

    def _finish(self):
        if self._reading is not None:
            model, self._digest = self._reading.result()
            self._info = model.info()
            self._reading, self._steps = None, approximation_group.steps(model)
        if self._advance():
            return None
        material, node = self._target.find()
        if material is None:
            self.report({"WARNING"}, "The material no longer exists; its approximation was discarded.")
            return {"CANCELLED"}
        if measured.model_key(node) != self._model:  # a step here would end the redo of an undo
            self.report(
                {"WARNING"},
                f"Material '{material.name}' has another model now; this approximation was discarded.",
            )
            return {"CANCELLED"}
        found = self._steps.result
        if node.group is None:
            node = convert(material)
        approximation_group.put(node, material, found, self._info, self._digest)
        error = percent(found.relative_l2)
        self.report({"INFO"}, f"'{material.name}' in Cycles and EEVEE: {error} off the model.")
        return {"FINISHED"}


def approximate_new(context, material, info):
    """Approximates a material whose model has just been added; `info`: that of the model.

    In a window, BTFs, which take many seconds, are approximated in the background."""
    has_window = not bpy.app.background and context.window is not None
    mode = "INVOKE_DEFAULT" if has_window and "texels" in info else "EXEC_DEFAULT"
    bpy.ops.velour.approximate(mode, material=material.name)
