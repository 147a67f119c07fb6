"""How a scene is rendered."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}


class VelourRenderSettings(bpy.types.PropertyGroup):
    """`scene.velour`."""

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
                "Half from the material, half from the lights, weighted by the balance heuristic",
                5,
            ),
            (
                "PRODUCT",
                "Products",
                "Half from the products of the material's lobes with lobes of the environment, the rest as "
                "Lobes and Lights. The least noise a sample",
                6,
            ),
        ),
        default="MIS",
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
        description="Light directions a pixel in material previews and in the viewport",
        default=32,
        min=1,
        soft_max=256,
        max=1 << 16,
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
