"""Fits a scene model: a smaller model for one scene's usage of a material."""

import time

import bpy
from bpy.props import BoolProperty

from ..core.model_warnings import panel_warnings
from ..export import ExportError
from ..native import VelourError
from . import measured
from .background_job import BackgroundJob, console_progress
from .scene_fit import SceneFit, SharedMaterialError

_OBSERVING = 0.5  # share of the progress bar for observing frames
_TICK_SECONDS = 0.1  # spent on observing frames per timer event, to keep the window responsive


class VELOUR_OT_fit_for_scene(measured.OfMaterial, BackgroundJob, bpy.types.Operator):
    bl_idname = "velour.fit_for_scene"
    bl_label = "Fit for This Scene"
    bl_description = (
        "Fit a scene model: a smaller model for what all frames, view layers and instances of the scene show"
        " of the material. The full model is kept"
    )
    bl_options = {"UNDO"}

    current_frame: BoolProperty(
        name="Current Frame Only",
        description="Use the current frame instead of the scene's frame range",
        options={"SKIP_SAVE"},
    )
    shared: BoolProperty(
        name="Even if Shared",
        description="Fit even if other scenes use the material. They use the full model where needed",
        options={"SKIP_SAVE"},
    )

    _job = None

    def execute(self, context):
        """Runs synchronously."""
        try:
            self._begin(context)
            self._work.begin_reading().wait()
            self._work.take()
            while self._work.observe_next():
                self._say_frame()
            self._start_fit(context)
            self._job.wait(console_progress() if bpy.app.background else None)
            return self._finish()
        except (ExportError, VelourError) as error:
            return self._fail(error)

    def invoke(self, context, _event):
        """Reads files and fits on other threads; in between, observes some frames per timer event."""
        try:
            self._begin(context)
        except SharedMaterialError as error:
            material = measured.wanted_material(context, self.material)
            _ask(context, str(error), material.name, self.current_frame)
            return {"CANCELLED"}
        except (ExportError, VelourError) as error:
            return self._fail(error)
        return self._enter(context, self._work.material_name)

    def cancel(self, context):
        """Called when Blender closes the window or loads another file."""
        self._leave(context)
        self._close()

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        if bpy.app.is_job_running("RENDER"):
            raise ExportError("A render is running; wait until it ends, or cancel it.")
        self._work = SceneFit(material, context.scene, self.current_frame, self.shared)

    def _start(self, context):
        self._work.begin_reading()

    def _stop(self):
        return self._cancelled()

    def _step(self, context):
        """Polls the reading, observes some frames, starts the fit, or polls the fit."""
        if not self._work.has_read:
            if self._work.reading.wait(timeout=0.0):
                self._work.take()
            else:
                self._show(context, "reading", 0.0)
            return None
        if self._job is not None:
            state = self._job.poll()
            self._show(
                context, state.stage, _OBSERVING + (1 - _OBSERVING) * state.fraction, state.seconds_left
            )
            return self._finish() if self._job.wait(timeout=0.0) else None
        if bpy.app.is_job_running("RENDER"):
            return None  # the render goes first
        if not self._observe_some():
            self._start_fit(context)
            return None
        done, count = self._work.done, len(self._work.frames)
        self._show(context, f"frame {self._work.frames[done - 1]}", _OBSERVING * done / count)
        return None

    def _observe_some(self):
        """Observes frames for one timer event, at least one; False if none remained."""
        end = time.monotonic() + _TICK_SECONDS
        seen = self._work.observe_next()
        while seen and time.monotonic() < end and self._work.observe_next():
            pass
        return seen

    def _start_fit(self, context):
        self._job = self._work.fit(context.scene.render.threads)

    def _finish(self):
        with self._job, self._job.result_model() as model:
            info = model.info() | {"seconds": self._job.poll().seconds}
            smaller = info["parameter_bytes"] < info["scene"]["full_parameter_bytes"]
            if smaller:
                self._work.keep(model)
        for warning in panel_warnings(info):  # including that the model is not smaller
            self.report({"WARNING"}, f"Material '{self._work.material_name}': {warning}")
        if smaller:
            self.report({"INFO"}, _report(self._work, info))
        self._close()
        return {"FINISHED"} if smaller else {"CANCELLED"}

    def _fail(self, error):
        self._close()
        if isinstance(error, VelourError) and error.cancelled:
            return self._cancelled()
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

    def _cancelled(self):
        self._close()
        self.report({"WARNING"}, "The fit for the scene was canceled.")
        return {"CANCELLED"}

    def _close(self):
        if self._job is not None:
            self._job.close()  # cancels it if it is running
        work = getattr(self, "_work", None)
        if work is not None:
            work.close()

    def _say_frame(self):
        if bpy.app.background:
            work = self._work
            print(
                f"Velour: observed frame {work.frames[work.done - 1]} ({work.done}/{len(work.frames)})",
                flush=True,
            )


def _report(work, info):
    scene, own = info["scene"], info["parameter_bytes"]
    full, of_btf = scene["full_parameter_bytes"], "full_texels" in scene
    took, cost = _texels_left(info) if of_btf else _time_and_error(info)
    return (
        f"Fitted '{work.material_name}' for scene '{work.scene_name}', {len(work.frames)} frames{took}:"
        f" {own} bytes of parameters, full model {full} ({full / own:.1f} times as many); {cost}."
    )


def _time_and_error(info):
    scene = info["scene"]
    errors = f"{scene['picture_error']:.2g}, full model {scene['full_picture_error']:.2g}"
    return f", in {info['seconds']:.1f} s", f"image error {errors}"


def _texels_left(info):
    (width, height), (full_width, full_height) = info["texels"], info["scene"]["full_texels"]
    return "", f"{width} x {height} texels instead of {full_width} x {full_height}"


def _ask(context, sentence, material, current_frame):
    """Shows the reason, and offers to fit anyway."""

    def draw(menu, _context):
        menu.layout.operator_context = "INVOKE_DEFAULT"
        menu.layout.label(text=sentence)
        choice = menu.layout.operator(VELOUR_OT_fit_for_scene.bl_idname, text="Fit Even if Shared")
        choice.material, choice.current_frame, choice.shared = material, current_frame, True

    context.window_manager.popup_menu(draw, title="Shared Material", icon="QUESTION")
