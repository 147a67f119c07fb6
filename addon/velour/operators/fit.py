"""Fits a model to a material's measurement: in the background or, without a window, synchronously."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from ..core import verdict
from ..core.model_warnings import panel_warnings
from ..export import ExportError
from ..export.files import MeasurementReading, absolute_path
from ..export.nodes import velour_node
from ..native import fit_job
from ..properties.material_settings import MODELS
from . import measured
from .approximate import MakesModel
from .background_job import give_up_waiting
from .job_target import JobTarget

_SETTINGS = ("model", "tolerance", "max_lobes", "kernel", "seed")


class VELOUR_OT_fit(measured.OfMaterial, MakesModel, bpy.types.Operator):
    bl_idname = "velour.fit"
    bl_label = "Fit"
    bl_description = "Fit a model to the material's measurement. The previous model is kept"
    bl_options = {"UNDO"}

    # If set, these replace the settings of the material.
    model: EnumProperty(name="Model", items=MODELS, default="PARAMETRIC", options={"SKIP_SAVE"})
    tolerance: FloatProperty(name="Max Error", min=0.0005, max=1.0, default=0.02, options={"SKIP_SAVE"})
    max_lobes: IntProperty(name="Max Lobes", min=1, max=64, default=16, options={"SKIP_SAVE"})
    kernel: EnumProperty(
        name="Kernel",
        items=(("GAUSSIAN", "Gaussian", "", 0), ("ABEL_POISSON", "Abel-Poisson", "", 1)),
        options={"SKIP_SAVE"},
    )
    seed: IntProperty(name="Seed", min=0, options={"SKIP_SAVE"})

    _what = "The fit"

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        measured.refuse_linked(material)
        node = velour_node(material)
        owner = f"Material '{material.name}'"
        if node is None or node.velour.measurement is None:
            raise ExportError(f"{owner}: no measurement is chosen; press Open beside Measurement.")
        if measured.is_btf(node.velour.measurement):
            path = absolute_path(node.velour.measurement)
            call = f"bpy.ops.velour.compress_btf(material={material.name!r})"
            raise ExportError(f"{owner}: {path} is a BTF; fit it with {call}, or with Fit in its panel.")
        measured.refuse_linked_group(material, node)
        self._target = JobTarget(material, node)
        self._subject = material.name
        self._after_cancel = "; the previous model is kept" if node.image is not None else ""
        settings = self._settings(node)
        self._options = {
            "tolerance": settings.tolerance,
            "max_lobes": settings.max_lobes,
            "seed": settings.seed,
            **_model_options(settings),
            "all_data": int(settings.use_all_data),
            "threads": context.scene.render.threads,
        }
        measurement = node.velour.measurement
        self._read_file = measured.ReadFile.of(measurement)
        self._job = self._reading = MeasurementReading(measurement, owner, may_differ=True)

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        with self._reading, self._reading.result() as measurement:
            self._reading = None
            self._digest = measurement.info()["sha256"]
            self._next = fit_job(measurement, **self._options)
        return None

    def _settings(self, node):
        for name in _SETTINGS:
            if self.properties.is_property_set(name):
                setattr(node.velour, name, getattr(self, name))
        return node.velour

    def _put(self):
        data, info = self._data, self._info
        material, node = measured.put_model(data, self._target, self.report, self.users)
        if node is None:
            return None, None
        measured.after_fit(material, node, self._read_file, self._digest, self.report)
        for warning in panel_warnings(info):
            self.report({"WARNING"}, f"Material '{material.name}': {warning}")
        line = verdict.line(info)
        looks = f" {line.text}." if line is not None else ""
        fitted = f"Fitted '{material.name}': {info['lobes']} lobes, {len(data)} bytes."
        self.report({"INFO"}, fitted + looks)
        return material, node


def _model_options(settings):
    """Options of fit_job(). Parametric models have Gaussian lobes; the kernel is for per-view models only."""
    if settings.model == "PARAMETRIC":
        return {
            "model": "parametric",
            "limit_albedo": int(settings.use_limit_albedo),
            "symmetric": int(settings.use_symmetric),
        }
    return {"model": "scattered", "kernel": settings.kernel.lower().replace("_", "-")}


class VELOUR_OT_cancel_fit(bpy.types.Operator):
    bl_idname = "velour.cancel_fit"
    bl_label = "Cancel"
    bl_description = "Cancel the running job"

    def execute(self, context):
        context.window_manager.velour.cancel_requested = True
        return {"FINISHED"}


class VELOUR_OT_cancel_waiting(bpy.types.Operator):
    bl_idname = "velour.cancel_waiting"
    bl_label = "Cancel Queued"
    bl_description = "Cancel all queued jobs. The running job continues"

    def execute(self, context):
        give_up_waiting(context)
        return {"FINISHED"}
