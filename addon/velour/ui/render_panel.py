"""Render properties."""

import bpy

from ..engine import denoising
from ..export import denoiser
from ..handlers.saved_files import newer_sentence
from ..operators.check_scene import VELOUR_OT_check_scene
from ..operators.copy_cycles_settings import VELOUR_OT_copy_cycles_settings
from ..operators.sampling_preset import PRESETS, VELOUR_OT_sampling_preset
from . import library_state
from .properties_panel import PropertiesPanel
from .text import draw_sentence

_COMPOSITOR = (  # 4.3 and newer; denoising: 5.2 and newer
    "compositor_device",
    "compositor_precision",
    "compositor_denoise_device",
    "compositor_denoise_preview_quality",
    "compositor_denoise_final_quality",
)


class _RenderPanel(PropertiesPanel):
    bl_context = "render"


class VELOUR_RENDER_PT_library(_RenderPanel, bpy.types.Panel):
    # Shown only if the library cannot be used, before a render fails.

    bl_label = "Velour Cannot Render"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and library_state.problem() != ""

    def draw(self, context):
        draw_sentence(context, self.layout, library_state.problem(), icon="ERROR")


class VELOUR_RENDER_PT_newer(_RenderPanel, bpy.types.Panel):
    # Shown only if a later release has saved the scene.

    bl_label = "Saved by a Newer Velour"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and newer_sentence(context.scene.velour.saved_by) is not None

    def draw(self, context):
        draw_sentence(context, self.layout, newer_sentence(context.scene.velour.saved_by), icon="ERROR")


class VELOUR_RENDER_PT_sampling(_RenderPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context):
        layout, settings = self.layout, context.scene.velour
        row = layout.row(align=True)
        for name, label, _description in PRESETS:
            row.operator(VELOUR_OT_sampling_preset.bl_idname, text=label).preset = name
        layout.use_property_split = True
        layout.use_property_decorate = True
        layout.prop(settings, "camera_samples")
        row = layout.row(heading="Noise Threshold")
        row.prop(settings, "use_noise_target", text="")
        value = row.row()
        value.active = settings.use_noise_target
        value.prop(settings, "noise_target", text="")
        layout.prop(settings, "time_limit")
        layout.column(heading="Denoise").prop(settings, "use_denoising", text="Render")
        if settings.use_denoising and (reason := denoiser.missing()):
            draw_sentence(context, layout, reason, icon="ERROR")
        elif error := denoising.last_errors.get(context.scene.name):
            draw_sentence(context, layout, error, icon="INFO")
        layout.prop(settings, "bounces")
        column = layout.column(align=True)
        column.prop(settings, "clamp_direct", text="Clamp Direct")
        column.prop(settings, "clamp_indirect", text="Indirect")


class VELOUR_RENDER_PT_sampling_advanced(_RenderPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "VELOUR_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.velour
        layout.use_property_split = True
        layout.use_property_decorate = True
        layout.prop(settings, "light_samples")
        layout.prop(settings, "seed")
        layout.prop(settings, "strategy")
        if settings.strategy == "MIS":
            column = layout.column(align=True)
            column.prop(settings, "share")
            column.prop(settings, "heuristic")
        if settings.strategy in ("AUTO", "PRODUCT"):
            layout.prop(settings, "use_cache")
        layout.prop(settings, "sequence")


class VELOUR_RENDER_PT_viewport(_RenderPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.velour
        layout.use_property_split = True
        layout.use_property_decorate = True
        layout.prop(settings, "viewport_mode", text="Mode")
        column = layout.column()
        column.active = settings.viewport_mode == "RAY_TRACED"
        column.prop(settings, "viewport_camera_samples", text="Samples")
        column.column(heading="Denoise").prop(settings, "use_viewport_denoising", text="Viewport")
        layout.prop(settings, "preview_camera_samples")


class VELOUR_RENDER_PT_light_paths(_RenderPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.velour
        layout.use_property_split = True
        layout.use_property_decorate = True
        layout.prop(settings, "filter_glossy")
        layout.prop(settings, "use_reflective_caustics")
        if hasattr(context.scene, "cycles"):
            layout.operator(VELOUR_OT_copy_cycles_settings.bl_idname, icon="DUPLICATE")


class VELOUR_RENDER_PT_simplify(_RenderPanel, bpy.types.Panel):
    # Replaces Blender's own panel, whose earlier registration would place it above Sampling.

    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw(self, context):
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.active = render.use_simplify
        for label, name in (("Max Subdivision", "subdivision"), ("Child Particles", "child_particles")):
            column = layout.column(align=True)
            column.prop(render, f"simplify_{name}", text=f"{label} Viewport")
            column.prop(render, f"simplify_{name}_render", text="Render")


class VELOUR_RENDER_PT_film(_RenderPanel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        cycles = getattr(context.scene, "cycles", None)
        if cycles is not None:
            layout.prop(cycles, "film_exposure", text="Exposure")
        layout.prop(context.scene.render, "film_transparent", text="Transparent")


class VELOUR_RENDER_PT_check(_RenderPanel, bpy.types.Panel):
    bl_label = "Unsupported Features"

    def draw(self, context):
        layout, checked = self.layout, context.window_manager.velour.checked
        layout.operator(VELOUR_OT_check_scene.bl_idname, icon="VIEWZOOM")
        if checked.scene != context.scene.name:
            return
        for sentence in checked.sentences:
            draw_sentence(context, layout, sentence.text, icon="ERROR" if sentence.is_refusal else "INFO")
        if not checked.sentences:
            layout.label(text=f"None in frame {checked.frame}", icon="CHECKMARK")


class VELOUR_RENDER_PT_performance(_RenderPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(render, "threads_mode")
        count = column.row()
        count.enabled = render.threads_mode == "FIXED"
        count.prop(render, "threads")
        layout.prop(render, "use_persistent_data", text="Persistent Data")
        layout.prop(render, "preview_pixel_size", text="Viewport Pixel Size")
        column = layout.column()
        for name in _COMPOSITOR:
            if hasattr(render, name):
                column.prop(render, name)
