"""A measured material: settings of the Image Texture node whose image is the model."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .btf_fit_settings import VelourBtfFitSettings
from .changed import changed, look_changed
from .placement_settings import VelourPlacementSettings
from .saved_by import saved_by

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}

MODELS = (
    ("SCATTERED", "Scattered", "Lobes of each sampled view direction, mixed between views", 0),
    ("PARAMETRIC", "Parametric", "Few lobes that change smoothly with the view direction: smallest", 1),
)


class VelourMaterialSettings(bpy.types.PropertyGroup):
    """`node.velour`; the model itself is `node.image`."""

    saved_by: saved_by()
    enabled: BoolProperty(
        name="Measured Material",
        description="Render the material of this node from the measured model in its image",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    measurement: PointerProperty(
        name="Measurement",
        description="The measurement file that the model is fitted to. Only its path is used",
        type=bpy.types.Image,
        override=_OVERRIDE,
    )
    model: EnumProperty(
        name="Kind",
        description="The kind of model that the measurement is turned into",
        items=MODELS,
        default="PARAMETRIC",
        override=_OVERRIDE,
    )
    kernel: EnumProperty(
        name="Kernel",
        description="The shape of a lobe of a scattered model",
        items=(
            ("GAUSSIAN", "Gaussian", "exp(bandwidth (cos - 1)), the von Mises-Fisher shape", 0),
            ("ABEL_POISSON", "Abel-Poisson", "A sharp peak with a long tail", 1),
        ),
        default="GAUSSIAN",
        override=_OVERRIDE,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Largest relative error asked for at every view up to 75 degrees, twice that beyond."
        " 0.02: hardly to be seen beside the measurement",
        default=0.02,
        min=0.0005,
        max=1.0,
        soft_max=0.2,
        precision=4,
        step=0.1,
        override=_OVERRIDE,
    )
    max_lobes: IntProperty(
        name="Max Lobes",
        description="Most lobes in all; of a scattered model, of a view. The fit stops earlier where"
        " the tolerance is met",
        default=16,
        min=1,
        max=64,
        override=_OVERRIDE,
    )
    neighbors: IntProperty(
        name="Neighbours",
        description="View directions of a scattered model that are mixed at run time. 0: the model's default",
        default=0,
        min=0,
        max=16,
        update=changed,
        override=_OVERRIDE,
    )
    use_limit_albedo: BoolProperty(
        name="Limit Albedo",
        description="Lower the model where the measurement reflects more light than arrives",
        default=False,
        override=_OVERRIDE,
    )
    use_symmetric: BoolProperty(
        name="Reciprocal",
        description="Make the model the same with light and view exchanged, for programs that trace light"
        " from either end. It takes about three times as long to evaluate",
        default=False,
        override=_OVERRIDE,
    )
    use_all_data: BoolProperty(
        name="All Data",
        description="Hold nothing out for the error estimate: for production, once the fit is trusted",
        default=False,
        override=_OVERRIDE,
    )
    use_reference: BoolProperty(
        name="Render from Measurement",
        description="Evaluate the raw measurement instead of the model: slower, for comparison",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    seed: IntProperty(name="Seed", description="Of the fit", default=0, min=0, override=_OVERRIDE)
    btf: PointerProperty(
        name="Fit of a BTF",
        description="What a fit of the material's BTF is asked for",
        type=VelourBtfFitSettings,
        override=_OVERRIDE,
    )
    job: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # marks of those whose results come here
    scene_model: PointerProperty(
        name="Model for the Scene",
        description="A smaller model that holds for the views and lights of one scene. The full model stays"
        " beside it",
        type=bpy.types.Image,
        update=changed,
        override=_OVERRIDE,
    )
    use_scene_model: BoolProperty(
        name="Use Model for the Scene",
        description="Render with the model for the scene, in every frame that shows the material no otherwise"
        " than it was fitted for; other frames take the full model and say so. Off: always the full model",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    structure: PointerProperty(
        name="Structure",
        description="The object that is one tile of structure, whose outline and holes the material shows",
        type=bpy.types.Object,
    )
    outline_texels: IntProperty(
        name="Texels",
        description="Of the structure's outline along the tile; its height is as fine",
        default=128,
        min=4,
        max=4096,
        override=_OVERRIDE,
    )
    outline_width: FloatProperty(
        name="Tile Width",
        description="How wide a tile lies on the object, in metres; the height of its structure goes with it."
        " 0: as the texture coordinates say, on average",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
        update=changed,
        override=_OVERRIDE,
    )
    outline_softness: FloatProperty(
        name="Edge Softness",
        description="Share of a tile's width over which the outline fades out, as fuzz does; 0: a hard edge",
        default=0.0,
        min=0.0,
        max=0.99,
        soft_max=0.1,
        precision=3,
        update=changed,
        override=_OVERRIDE,
    )
    tint: FloatVectorProperty(
        name="Tint",
        description="What the material reflects is multiplied with this colour. White: as it was measured",
        subtype="COLOR",
        size=3,
        default=(1.0, 1.0, 1.0),
        min=0.0,
        soft_max=1.0,
        update=look_changed,
        override=_OVERRIDE,
    )
    exposure: FloatProperty(
        name="Exposure",
        description="In stops: each doubles what the material reflects. 0: as it was measured",
        default=0.0,
        soft_min=-4.0,
        soft_max=4.0,
        min=-32.0,
        max=32.0,
        update=look_changed,
        override=_OVERRIDE,
    )
    roughness: FloatProperty(
        name="Roughness Offset",
        description="Widens the highlights of a model of a BRDF and keeps their brightness: a mirror gets"
        " that of a Glossy BSDF of this roughness. 0: as it was measured",
        subtype="FACTOR",
        default=0.0,
        min=0.0,
        max=1.0,
        update=look_changed,
        override=_OVERRIDE,
    )
    placement: PointerProperty(
        name="Placement",
        description="Where the tiles of a BTF lie on objects",
        type=VelourPlacementSettings,
        override=_OVERRIDE,
    )
