"""Approximates a measured material: in the background or, without a window, synchronously."""

import bpy
from bpy.props import StringProperty

from ..core.approximation import Steps
from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import sha256
from . import approximation_group, measured
from .background_job import JobsInSteps
from .job_target import JobTarget


class MakesModel(JobsInSteps):
    """Mixin for an operator whose first job makes a model, applied only together with its approximation.

    The model is for the material of `_target`; `_put()` uses `_data`, `_info` and the first job's `_report`.
    """

    _data = None  # contents of the model file

    def _finish(self):
        if self._data is None:
            with self._job:
                model, self._report = self._job.result_model(), self._job.report()
                self._seconds = self._job.poll().seconds
            self._data, self._info = model.bytes(), model.info()
            if self._wants_approximation():
                self._steps = Steps(model, approximation_group.has_layers())
        return None if self._advance() else self._put()

    def _wants_approximation(self):
        material, _node = self._target.find()
        return material is not None and approximation_group.is_wanted(material)

    def _put_approximation(self, material):
        if self._steps:
            approximation_group.put(material, self._steps.result, sha256(self._data))


class VELOUR_OT_approximate(JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.approximate"
    bl_label = "Approximate"
    bl_description = (
        "Fit a node group with a Principled BSDF to the model, for EEVEE, Cycles and Solid mode. Other nodes"
        " are not changed"
    )
    bl_options = {"UNDO"}

    material: StringProperty(
        name="Material", description="Name of the material. Empty: the active one", options={"SKIP_SAVE"}
    )

    _what = "The approximation"

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        owner = f"Material '{material.name}'"
        if not approximation_group.is_editable(material):
            raise ExportError(f"{owner} is linked from another file; approximate it there or make it local.")
        node = measured.modelled_node(material)
        self._target, self._subject = JobTarget(material, node), material.name

    def _take_turn(self):
        self._job = self._reading = ReadJob(measured.stored_model(self._target).model_and_digest)

    def _finish(self):
        if self._reading is not None:
            model, self._digest = self._reading.result()
            self._reading, self._steps = None, Steps(model, approximation_group.has_layers())
        if self._advance():
            return None
        material, _node = self._target.find()
        if material is None:
            self.report({"WARNING"}, "The material no longer exists; its approximation was discarded.")
            return {"CANCELLED"}
        found = self._steps.result
        approximation_group.put(material, found, self._digest)
        self.report({"INFO"}, f"Approximated '{material.name}': relative error {found.relative_l2:.3g}.")
        return {"FINISHED"}
