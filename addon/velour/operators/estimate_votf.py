"""Estimates the cost of a VOTF from small ones of the structure."""

import bpy

from ..core.outline_size import Made, outline_text, probes
from ..core.read_job import ReadJob
from ..export.files import StoredFile
from ..native import votf_job
from .asked_outline import AskedOutline, export_structure, outlined_as
from .background_job import JobsInSteps


class VELOUR_OT_estimate_votf(AskedOutline, JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.estimate_votf"
    bl_label = "Estimate"
    bl_description = "Estimate time, memory, size and quality from two coarse runs. Changes nothing"

    _keeps = False
    _what = "The estimate"

    def _begin(self, context):
        asked = self._asked(context)
        self._subject, self._texels = asked.material.name, asked.texels
        self._key = outlined_as(asked.material, asked.tile.owner, asked.texels)
        scene, options, _notes = export_structure(context, asked)
        model = StoredFile.of(asked.node.image, f"Material '{asked.material.name}'")
        self._steps = _Probes(scene, model, asked.texels, options)
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        text = outline_text(self._texels, self._steps.made)
        state = bpy.context.window_manager.velour
        state.outline_estimate, state.outline_estimated = text, self._key
        self.report({"INFO"}, f"'{self._subject}': {text}")
        return {"FINISHED"}


class _Probes:
    """Jobs of small VOTFs of a committed scene, which this owns, and the result `made`."""

    def __init__(self, scene, model, texels, options):
        self._scene, self._model, self._texels, self._options = scene, model, texels, options
        self.made = ()
        self._jobs = self._run()

    def next_job(self):
        return next(self._jobs, None)

    def _run(self):
        with self._scene as scene:
            yield (reading := ReadJob(self._model.model))
            with reading.result() as model:
                for probe in probes(self._texels):
                    with votf_job(scene, model, **self._options, **probe.options()) as job:
                        yield job
                        self.made += (Made.of(job.report(), job.poll().seconds),)
