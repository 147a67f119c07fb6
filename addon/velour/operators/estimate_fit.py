"""Estimate: what the fit of a BTF will take, by its size and by the fits that were made before."""

from pathlib import Path

import bpy

from ..core.fit_text import fit_text
from ..export.caches import cache_folder
from ..native import Btf
from . import measured
from .asked_fit import AskedFit
from .reads_first import ReadsFirst
from .tiles import fitted_as


class VELOUR_OT_estimate_fit(AskedFit, ReadsFirst, bpy.types.Operator):
    bl_idname = "velour.estimate_fit"
    bl_label = "Estimate"
    bl_description = (
        "Say how long the fit will take, how much memory, and how large the model will be at most"
    )

    _keeps = False

    def _read(self, context):
        tile, path = self._chosen(context)
        self._subject = tile.owner.name if tile else measured.btf_name(path)
        asked, threads, folder = self._options(tile), context.scene.render.threads, Path(cache_folder())
        self._key = fitted_as(tile.owner) if tile else ""
        return lambda: _text(path, asked, threads, folder)

    def _use(self, context, text):
        state = context.window_manager.velour
        state.fit_estimate, state.fit_estimated = text, self._key
        self.report({"INFO"}, f"'{self._subject}': {text}")
        return {"FINISHED"}


def _text(path, *asked):
    with Btf.load(path) as btf:
        return fit_text(btf, *asked)
