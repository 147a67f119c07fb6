"""Render settings of a scene."""

import warnings

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .saved_by import saved_by

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}


def _redraw_viewports(_settings, context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


# Numbers of samples are stored as light directions a pixel. The panels show camera rays, as other engines do.

_shown_sets = 0  # above 0: a property of the panels sets a stored number


def _told(_settings, _context):
    """Tells scripts which unit a stored number has. Python shows it once per line of a script."""
    if _shown_sets:
        return
    warnings.warn(
        "scene.velour.samples, viewport_samples and preview_samples count light directions a pixel;"
        " camera_samples, viewport_camera_samples and preview_camera_samples count camera rays.",
        DeprecationWarning,
        stacklevel=2,
    )


def _store(settings, **numbers):
    global _shown_sets
    _shown_sets += 1
    try:
        for name, number in numbers.items():
            setattr(settings, name, number)
    finally:
        _shown_sets -= 1


def _camera_samples(stored, name, description, least=1):
    """Property of the camera rays a pixel whose light directions are in the property `stored`."""
    return IntProperty(
        name=name,
        description=description,
        min=least,
        soft_max=4096,
        max=1 << 20,
        get=lambda settings: -(-getattr(settings, stored) // settings.split),
        set=lambda settings, rays: _store(settings, **{stored: min(rays * settings.split, _MOST[stored])}),
        options={"SKIP_SAVE"},
        override=_OVERRIDE,
    )


_MOST = {"samples": 1 << 20, "preview_samples": 1 << 16, "viewport_samples": 1 << 20}


def _set_light_samples(settings, split):
    """Sets the light directions a camera ray and keeps the numbers of camera rays."""
    rays = {name: -(-getattr(settings, name) // settings.split) for name in _MOST}
    _store(settings, split=split, **{name: min(rays[name] * split, _MOST[name]) for name in _MOST})


class VelourRenderSettings(bpy.types.PropertyGroup):
    """`scene.velour`."""

    saved_by: saved_by()
    strategy: EnumProperty(
        name="Strategy",
        description="How light directions are sampled. All strategies converge to the same image",
        items=(
            ("AUTO", "Automatic", "What a short test render finds best for each material", 11),
            ("UNIFORM", "Uniform", "Uniform over the hemisphere", 0),
            ("COSINE", "Cosine", "Proportional to the cosine", 1),
            ("TABLE", "Table", "From tables of the material's reflectance", 2),
            ("SRBF", "SRBF Lobes", "From the lobes of the fitted material", 3),
            ("LIGHT", "Lights", "From the environment and the lights", 4),
            (
                "MIS",
                "Lobes and Lights",
                "From the material and the lights, combined by multiple importance sampling",
                5,
            ),
            ("GGX", "Fitted GGX", "From a GGX lobe over a diffuse base, fitted to the material", 6),
            (
                "MIS_GGX",
                "Fitted GGX and Lights",
                "Half from the fitted GGX lobe, half from the lights, combined by the balance heuristic",
                7,
            ),
            (
                "PRODUCT",
                "Products",
                "Up to 3/4 from products of material and environment, the rest as Lobes and Lights",
                8,
            ),
        ),
        default="AUTO",
        override=_OVERRIDE,
    )
    share: FloatProperty(
        name="Light Share",
        description="Share of the directions that are sampled from the lights; the rest from the material",
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        override=_OVERRIDE,
    )
    heuristic: EnumProperty(
        name="Heuristic",
        description="How environment light is weighted between directions sampled from material and lights",
        items=(
            ("BALANCE", "Balance", "Proportional to the density", 0),
            ("POWER", "Power", "Proportional to the square of the density", 1),
        ),
        default="BALANCE",
        override=_OVERRIDE,
    )
    sequence: EnumProperty(
        name="Sequence",
        description="Source of random numbers",
        items=(
            ("RANDOM", "Random", "Independent random numbers", 0),
            ("SOBOL", "Sobol", "Scrambled Sobol sequence in each pixel; less noise with the same samples", 1),
        ),
        default="SOBOL",
        override=_OVERRIDE,
    )
    use_noise_target: BoolProperty(
        name="Noise Threshold",
        description="Stop sampling where the noise is low enough. Samples is then the maximum per pixel",
        default=False,
        override=_OVERRIDE,
    )
    noise_target: FloatProperty(
        name="Noise Threshold",
        description="Relative error below which a block of 16 x 16 pixels gets no more samples",
        default=0.02,
        min=0.0001,
        soft_max=0.2,
        max=1.0,
        precision=4,
        override=_OVERRIDE,
    )
    camera_samples: _camera_samples("samples", "Samples", "Number of camera rays per pixel")
    viewport_camera_samples: _camera_samples(
        "viewport_samples",
        "Viewport Samples",
        "Number of camera rays per pixel in the rendered viewport. 0: unlimited",
        least=0,
    )
    preview_camera_samples: _camera_samples(
        "preview_samples", "Preview Samples", "Number of camera rays per pixel in material previews"
    )
    light_samples: IntProperty(
        name="Light Directions",
        description="Number of light directions per camera ray. Higher is faster, lower smooths edges",
        min=1,
        max=48,
        get=lambda settings: settings.split,
        set=_set_light_samples,
        options={"SKIP_SAVE"},
        override=_OVERRIDE,
    )
    samples: IntProperty(
        name="Light Directions per Pixel",
        description="Number of light directions per pixel, for scripts; panels show Samples",
        default=256,
        min=1,
        soft_max=4096,
        max=_MOST["samples"],
        override=_OVERRIDE,
        update=_told,
    )
    preview_samples: IntProperty(
        name="Preview Light Directions",
        description="Number of light directions per pixel in material previews, for scripts",
        default=32,
        min=1,
        soft_max=256,
        max=_MOST["preview_samples"],
        override=_OVERRIDE,
        update=_told,
    )
    viewport_mode: EnumProperty(
        name="Viewport",
        description="How the rendered viewport draws the scene",
        items=(
            ("RAY_TRACED", "Ray Traced", "Like the final render, refined progressively", 0),
            (
                "REAL_TIME",
                "Real Time",
                "Drawn by the GPU at once, lit by the world and lights, without shadows and bounces",
                1,
            ),
        ),
        default="RAY_TRACED",
        override=_OVERRIDE,
        update=_redraw_viewports,
    )
    viewport_samples: IntProperty(
        name="Viewport Light Directions",
        description="Number of light directions per pixel in the viewport, for scripts. 0: unlimited",
        default=1024,
        min=0,
        soft_max=4096,
        max=_MOST["viewport_samples"],
        override=_OVERRIDE,
        update=_told,
    )
    split: IntProperty(
        name="Split",
        description="Number of light directions per camera ray. Higher is faster, lower smooths edges",
        default=8,
        min=1,
        max=48,
        override=_OVERRIDE,
    )
    bounces: IntProperty(
        name="Bounces",
        description="Maximum number of indirect light bounces. 0: direct light only",
        default=4,
        min=0,
        soft_max=12,
        max=64,
        override=_OVERRIDE,
    )
    use_denoising: BoolProperty(
        name="Denoise Render",
        description=(
            "Remove noise from final renders with Open Image Denoise. Noise Threshold then applies to the"
            " error of the denoised image"
        ),
        default=False,
        override=_OVERRIDE,
    )
    use_viewport_denoising: BoolProperty(
        name="Denoise Viewport",
        description="Remove noise from the rendered viewport with Open Image Denoise",
        default=True,
        override=_OVERRIDE,
        update=_redraw_viewports,
    )
    clamp_direct: FloatProperty(
        name="Direct Light",
        description=(
            "Maximum value of a direct light sample. Lower values remove fireflies but darken highlights."
            " 0: no clamping"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        override=_OVERRIDE,
    )
    clamp_indirect: FloatProperty(
        name="Indirect Light",
        description=(
            "Maximum value of an indirect light sample. Lower values remove fireflies but darken bounced"
            " light. 0: no clamping"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        override=_OVERRIDE,
    )
    filter_glossy: FloatProperty(
        name="Filter Glossy",
        description="Blur glossy reflections after blurry bounces to reduce noise. 0: off",
        default=0.0,
        min=0.0,
        max=10.0,
        override=_OVERRIDE,
    )
    use_reflective_caustics: BoolProperty(
        name="Reflective Caustics",
        description="Render light that glossy surfaces cast on diffuse ones. Off removes it and its noise",
        default=True,
        override=_OVERRIDE,
    )
    seed: IntProperty(
        name="Seed",
        description="Random seed. The same seed gives the same image bit by bit; animate it to vary noise",
        default=0,
        min=0,
        override=_OVERRIDE,
    )
    use_cache: BoolProperty(
        name="Cache World",
        description="Cache the fit of the environment image for products, for later renders",
        default=True,
        override=_OVERRIDE,
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="Stop at the end of a pass after this time, even if samples are missing. 0: no limit",
        default=0.0,
        min=0.0,
        subtype="TIME",
        unit="TIME_ABSOLUTE",
        override=_OVERRIDE,
    )
    jobs: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # marks of jobs that observe the scene
