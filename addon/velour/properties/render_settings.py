"""How a scene is rendered."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .saved_by import saved_by

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}


def _redraw_viewports(_settings, context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class VelourRenderSettings(bpy.types.PropertyGroup):
    """`scene.velour`."""

    saved_by: saved_by()
    strategy: EnumProperty(
        name="Strategy",
        description="How light directions are drawn. All strategies converge to the same picture",
        items=(
            ("UNIFORM", "Uniform", "All directions of the hemisphere alike", 0),
            ("COSINE", "Cosine", "In proportion to the cosine", 1),
            ("TABLE", "Table", "From a table of the material", 2),
            ("SRBF", "SRBF Lobes", "From the lobes of the fitted material", 3),
            ("LIGHT", "Lights", "From the environment and the lamps", 4),
            (
                "MIS",
                "Lobes and Lights",
                "Some from the material, some from the lights, weighted by multiple importance sampling",
                5,
            ),
            ("GGX", "Fitted GGX", "From a GGX lobe over a diffuse base that is fitted to the material", 6),
            (
                "MIS_GGX",
                "Fitted GGX and Lights",
                "Half from the fitted GGX lobe, half from the lights, weighted by the balance heuristic",
                7,
            ),
            (
                "PRODUCT",
                "Products",
                "Up to three quarters from products of material and environment, the rest as before",
                8,
            ),
        ),
        default="MIS",
        override=_OVERRIDE,
    )
    share: FloatProperty(
        name="Light Share",
        description="Share of the directions that the lights draw; the material draws the rest",
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
        override=_OVERRIDE,
    )
    heuristic: EnumProperty(
        name="Heuristic",
        description="How the world's light is weighted between directions of material and lights",
        items=(
            ("BALANCE", "Balance", "In proportion to the density", 0),
            ("POWER", "Power", "In proportion to the square of the density", 1),
        ),
        default="BALANCE",
        override=_OVERRIDE,
    )
    sequence: EnumProperty(
        name="Sequence",
        description="Where random numbers come from",
        items=(
            ("RANDOM", "Random", "Independent numbers", 0),
            ("SOBOL", "Sobol", "A scrambled Sobol sequence a pixel: less noise for the same samples", 1),
        ),
        default="SOBOL",
        override=_OVERRIDE,
    )
    use_noise_target: BoolProperty(
        name="Noise Threshold",
        description="Stop where the picture is good enough; Samples is then the most that a pixel gets",
        default=False,
        override=_OVERRIDE,
    )
    noise_target: FloatProperty(
        name="Noise Threshold",
        description="Relative error at which a block of 16 x 16 pixels gets no more samples",
        default=0.02,
        min=0.0001,
        soft_max=0.2,
        max=1.0,
        precision=4,
        override=_OVERRIDE,
    )
    samples: IntProperty(
        name="Samples",
        description="Light directions a pixel",
        default=256,
        min=1,
        soft_max=4096,
        max=1 << 20,
        override=_OVERRIDE,
    )
    preview_samples: IntProperty(
        name="Preview Samples",
        description="Light directions a pixel in material previews",
        default=32,
        min=1,
        soft_max=256,
        max=1 << 16,
        override=_OVERRIDE,
    )
    viewport_mode: EnumProperty(
        name="Viewport",
        description="How the rendered viewport shows the scene",
        items=(
            ("RAY_TRACED", "Ray Traced", "As the final render, ever less noisy", 0),
            (
                "REAL_TIME",
                "Real Time",
                "By the graphics processor at once: lit by world and lamps, without shadows and bounces",
                1,
            ),
        ),
        default="RAY_TRACED",
        override=_OVERRIDE,
        update=_redraw_viewports,
    )
    viewport_samples: IntProperty(
        name="Viewport Samples",
        description="Light directions a pixel in the rendered viewport. 0: as many as there is time for",
        default=1024,
        min=0,
        soft_max=4096,
        max=1 << 20,
        override=_OVERRIDE,
    )
    split: IntProperty(
        name="Split",
        description="How many light directions share one camera ray. More is faster, fewer smooths edges",
        default=8,
        min=1,
        max=48,
        override=_OVERRIDE,
    )
    bounces: IntProperty(
        name="Bounces",
        description="Indirect bounces of light. 0: direct light only",
        default=4,
        min=0,
        soft_max=12,
        max=64,
        override=_OVERRIDE,
    )
    use_denoising: BoolProperty(
        name="Denoise Render",
        description=(
            "Remove noise from final renders with Open Image Denoise. The Noise Threshold then is the error"
            " of the denoised picture"
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
            "Largest value of a sample of direct light. Lower values remove fireflies and darken highlights."
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
            "Largest value of a sample of indirect light. Lower values remove fireflies and darken bounced"
            " light. 0: no clamping"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        override=_OVERRIDE,
    )
    filter_glossy: FloatProperty(
        name="Filter Glossy",
        description="Blur glossy reflections behind blurry bounces, to reduce noise. 0: off",
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
        description="The same seed gives the same picture, bit by bit. Animate it to vary the noise",
        default=0,
        min=0,
        override=_OVERRIDE,
    )
    use_cache: BoolProperty(
        name="Cache World",
        description="Keep what Products fits to an environment image, for the next render",
        default=True,
        override=_OVERRIDE,
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="Stop after this time at a whole pass, even if samples are missing. 0: no limit",
        default=0.0,
        min=0.0,
        subtype="TIME",
        unit="TIME_ABSOLUTE",
        override=_OVERRIDE,
    )
    jobs: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # marks of those that look at the scene
