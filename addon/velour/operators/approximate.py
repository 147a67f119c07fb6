"""Approximates a measured material: in the background or, without a window, synchronously."""

import bpy
from bpy.props import StringProperty

from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import sha256
from . import approximation_group, measured
from .background_job import JobsInSteps
from .convert import convert
from .job_target import JobTarget
from .shared_group import AsksUsers


class MakesModel(AsksUsers, JobsInSteps):
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
            self._steps = approximation_group.steps(model)
        return None if self._advance() else self._put()

    def _put_approximation(self, material, node):
        approximation_group.put(node, material, self._steps.result, self._info, sha256(self._data))


class VELOUR_OT_approximate(JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.approximate"
    bl_label = "Approximate"
    bl_description = (
        "Fit the nodes in the material's node group to the model, for EEVEE, Cycles and Solid mode. Nodes of"
        " your own are not changed"
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
        measured.refuse_linked_group(material, node)
        self._target, self._subject = JobTarget(material, node), material.name

    def _take_turn(self):
        self._job = self._reading = ReadJob(measured.stored_model(self._target).model_and_digest)

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
        found = self._steps.result
        if node.group is None:
            node = convert(material)
        approximation_group.put(node, material, found, self._info, self._digest)
        error = 100 * found.relative_l2
        self.report({"INFO"}, f"'{material.name}' in Cycles and EEVEE: {error:.2g} % off the model.")
        return {"FINISHED"}
