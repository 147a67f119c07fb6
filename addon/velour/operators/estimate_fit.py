"""Estimates the cost of a BTF fit from the BTF's size and from earlier fits."""

import functools
from pathlib import Path

import bpy

from ..core.fit_text import fit_text
from ..export.caches import cache_folder
from . import measured
from .asked_fit import AskedFit, fitted_as, options_of, refitted_as
from .reads_first import ReadsFirst
from .tiles import asked_of


class VELOUR_OT_estimate_fit(AskedFit, ReadsFirst, bpy.types.Operator):
    bl_idname = "velour.estimate_fit"
    bl_label = "Estimate"
    bl_description = "Estimate time, memory and maximum model size of the fit"

    _keeps = False

    def _read(self, context):
        chosen = self._chosen(context)
        options = options_of(self._asked(chosen.settings))
        self._subject, self._key = measured.btf_name(chosen.path), ""
        if chosen.tile:
            self._subject, self._key = chosen.tile.owner.name, captured_and_fitted_as(chosen.tile.owner)
        if chosen.material:
            self._subject, self._key = chosen.material.name, refitted_as(chosen.material)
        return functools.partial(
            _text, chosen.loading(), options, context.scene.render.threads, Path(cache_folder())
        )

    def _use(self, context, text):
        state = context.window_manager.velour
        state.fit_estimate, state.fit_estimated = text, self._key
        self.report({"INFO"}, f"'{self._subject}': {text}")
        return {"FINISHED"}


def captured_and_fitted_as(owner):
    """Key that changes with the parameters of a tile's capture and fit. Safe in draw()."""
    return fitted_as(owner.velour, asked_of(owner), owner.velour.directory)


def _text(load, *asked):
    with load() as btf:
        return fit_text(btf, *asked)
