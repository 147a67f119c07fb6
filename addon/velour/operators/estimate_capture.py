"""Estimates the cost of a tile's capture from two small captures."""

import os
import tempfile
from types import SimpleNamespace

import bpy

from ..core.capture_size import Timed, capture_text, probes, spread
from ..export.tiles import export_tile
from ..native import capture_job
from .background_job import JobsInSteps
from .tiles import CAPTURE_NUMBERS, OfTile, capture_options, captured_as, find_tile


class VELOUR_OT_estimate_capture(OfTile, JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.estimate_capture"
    bl_label = "Estimate"
    bl_description = "Estimate time, memory and disk space of the capture from two small captures"

    _what = "The estimate"

    def _begin(self, context):
        tile = find_tile(context, self.collection)
        settings = tile.owner.velour
        self._subject, self._key = tile.owner.name, captured_as(tile.owner)
        # A copy, since the user may change the settings meanwhile.
        self._numbers = SimpleNamespace(
            **{name: getattr(settings, name) for name in (*CAPTURE_NUMBERS, "held_out")}
        )
        scene, place, _notes = export_tile(tile, context.evaluated_depsgraph_get(), settings.use_approximate)
        self._steps = _Probes(scene, self._numbers, capture_options(context, tile, place))
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        text = capture_text(self._numbers, self._steps.took, self._steps.sides)
        state = bpy.context.window_manager.velour
        state.estimate, state.estimated = text, self._key
        self.report({"INFO"}, f"'{self._subject}': {text}")
        return {"FINISHED"}


class _Probes:
    """Jobs of two small captures of a committed scene, which this owns, and their `took` and `sides`."""

    def __init__(self, scene, numbers, options):
        self._scene, self._numbers, self._options = scene, numbers, options
        self.took, self.sides = [], 1
        self._jobs = self._run()

    def next_job(self):
        return next(self._jobs, None)

    def _run(self):
        with self._scene as scene, tempfile.TemporaryDirectory(prefix="velour-") as folder:
            for number, probe in enumerate(probes(self._numbers)):
                options = {
                    **self._options,
                    "texels": probe.texels,
                    "views": spread(self._options["views"], probe.views),
                    "lights": spread(self._options["lights"], probe.lights),
                }
                with capture_job(scene, os.path.join(folder, f"{number}.btf"), **options) as job:
                    yield job
                    report, whole = job.report(), job.poll().seconds
                self.took.append(Timed(report["seconds"], whole))
                self.sides = report["sides"]
