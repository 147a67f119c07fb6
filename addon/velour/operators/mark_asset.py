"""Marks a measured material as an asset, with a preview of it on a ball."""

import bpy
from bpy.props import StringProperty

from ..core.ball import ball_job, ball_scene, shown
from ..core.read_job import ReadJob
from ..export import ExportError
from . import measured
from .background_job import JobsInSteps
from .job_target import JobTarget

_SIDE, _SAMPLES = 256, 256
_TEXTS = ("author", "license", "description")


class VELOUR_OT_mark_asset(measured.OfMaterial, JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.mark_asset"
    bl_label = "Mark as Asset"
    bl_description = "Mark the material as an asset, with a preview of it on a ball"
    bl_options = {"UNDO"}

    # Properties that are not set remain unchanged.
    author: StringProperty(name="Author", options={"SKIP_SAVE"})
    license: StringProperty(name="License", options={"SKIP_SAVE"})
    description: StringProperty(name="Description", options={"SKIP_SAVE"})
    catalog: StringProperty(name="Catalog", description="UUID of the asset catalog", options={"SKIP_SAVE"})
    tags: StringProperty(name="Tags", description="Tags to add, separated by commas", options={"SKIP_SAVE"})

    _what = "The asset preview"

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        measured.refuse_linked(material)
        if material.override_library:
            raise ExportError(
                f"Material '{material.name}' is an override of a linked one, and cannot be an asset; mark the"
                " material in its library."
            )
        node = measured.modelled_node(material)
        self._target, self._subject = JobTarget(material, node), material.name
        self._threads = context.scene.render.threads

    def _take_turn(self):
        self._steps = _Picture(measured.stored_model(self._target), self._threads)
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        material, _node = self._target.find()
        if material is None:
            self.report(
                {"WARNING"}, f"Material '{self._subject}' no longer exists, so it was not marked as an asset."
            )
            return {"CANCELLED"}
        self._describe(material)
        preview = material.preview_ensure()
        preview.image_size = _SIDE, _SIDE
        preview.image_pixels_float.foreach_set(self._steps.pixels.ravel())
        self.report({"INFO"}, f"Marked '{material.name}' as an asset.")
        return {"FINISHED"}

    def _describe(self, material):
        is_new = material.asset_data is None
        material.asset_mark()
        asset = material.asset_data
        if is_new:
            asset.description = f"Measured: {self._steps.source}"
            for tag in ("measured", "velour"):
                asset.tags.new(tag, skip_if_exists=True)
        for name in _TEXTS:
            if getattr(self, name) and hasattr(asset, name):
                setattr(asset, name, getattr(self, name))
            elif getattr(self, name):  # the license, in Blender 3.4
                sentence = f"this Blender does not store the {name} of assets; add it to the description"
                self.report({"WARNING"}, f"Material '{material.name}': {sentence}.")
        if self.catalog:
            asset.catalog_id = self.catalog
        for tag in filter(None, (each.strip() for each in self.tags.split(","))):
            asset.tags.new(tag, skip_if_exists=True)


class _Picture:
    """Jobs that render the preview, and the results: `pixels`, and `source`, the name of the measurement."""

    def __init__(self, stored, threads):
        self._stored, self._threads = stored, threads
        self.pixels = self.source = None
        self._jobs = self._run()

    def next_job(self):
        return next(self._jobs, None)

    def _run(self):
        reading = ReadJob(self._stored.model)
        yield reading
        model = reading.result()  # not closed here: after a cancel, a thread may still read it
        self.source = model.info()["source"]["name"]
        making = ReadJob(lambda: ball_scene(lambda scene: scene.add_model_material(model)))
        yield making
        with making.result() as scene, ball_job(scene, _SIDE, _SAMPLES, self._threads) as job:
            yield job
            self.pixels = shown(job.read_pass("Combined"))
