"""Render settings for common purposes."""

import bpy
from bpy.props import EnumProperty

from ..export import denoiser

# Values of render settings; every purpose uses the noise threshold.
_VALUES = {
    "PREVIEW": {"camera_samples": 32, "noise_target": 0.1, "use_denoising": True},
    "FINAL": {"camera_samples": 1024, "noise_target": 0.02, "use_denoising": True},
    "REFERENCE": {"camera_samples": 16384, "noise_target": 0.003, "use_denoising": False},
}
PRESETS = (
    ("PREVIEW", "Preview", "A quick image: few samples, denoised"),
    ("FINAL", "Final", "An image without visible noise, denoised"),
    ("REFERENCE", "Reference", "An image for comparisons: no denoising, no clamping"),
)


class VELOUR_OT_sampling_preset(bpy.types.Operator):
    bl_idname = "velour.sampling_preset"
    bl_label = "Sampling Preset"
    bl_description = "Set samples, noise threshold and denoising for a purpose"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(name="Preset", description="Purpose of the image", items=PRESETS, default="FINAL")

    @classmethod
    def description(cls, _context, properties):
        return dict((name, text) for name, _label, text in PRESETS)[properties.preset]

    def execute(self, context):
        settings = context.scene.velour
        settings.use_noise_target = True
        for name, value in _VALUES[self.preset].items():
            setattr(settings, name, value)
        if settings.use_denoising and (reason := denoiser.missing()):
            settings.use_denoising = False
            self.report({"WARNING"}, f"Without denoising: {reason}")
        if self.preset == "REFERENCE":
            settings.clamp_direct = settings.clamp_indirect = settings.filter_glossy = 0.0
        return {"FINISHED"}
