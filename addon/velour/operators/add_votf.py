"""Adds a tile's VOTF to a material's model: in the background or, without a window, synchronously."""

import functools

import bpy

from ..core.read_job import ReadJob
from ..core.sizes import data_size
from ..core.warning_table import sentences
from ..native import votf_job
from . import measured
from .approximate import MakesModel
from .asked_outline import AskedOutline, export_structure
from .job_target import JobTarget


class VELOUR_OT_add_votf(AskedOutline, MakesModel, bpy.types.Operator):
    bl_idname = "velour.add_votf"
    bl_label = "Add Silhouette"
    bl_description = (
        "Give the material's model the silhouette and holes of the structure (VOTF). The previous model is"
        " kept"
    )
    bl_options = {"UNDO"}

    _what = "Adding the silhouette"

    def _begin(self, context):
        asked = self._asked(context)
        measured.refuse_linked_group(asked.material, asked.node)
        self._target, self._subject = JobTarget(asked.material, asked.node), asked.material.name
        # The structure is exported now; the model is read when earlier jobs have finished.
        scene, options, self._notes = export_structure(context, asked)
        self._outline = functools.partial(_outline_job, scene, texels=asked.texels, **options)

    def _take_turn(self):
        self._job = self._reading = ReadJob(
            functools.partial(self._outline, measured.stored_model(self._target))
        )

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        self._next, self._reading = self._reading.result(), None
        return None

    def _put(self):
        report = self._report
        material, node = measured.put_model(self._data, self._target, self.report, self.users)
        if node is None:
            return None, None
        for sentence in (*self._notes, *sentences(report["warning_codes"])):
            self.report({"WARNING"}, sentence)
        self.report(
            {"INFO"},
            f"'{material.name}' has the silhouette of '{report['source']}': {data_size(report['bytes'])},"
            f" {report['wrong']:.2%} of rays wrong.",
        )
        return material, node


def _outline_job(scene, stored, **options):
    """Runs on the job's thread."""
    with scene, stored.model() as model:
        return votf_job(scene, model, **options)
