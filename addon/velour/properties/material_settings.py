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
from .look_settings import stored_or_input
from .placement_settings import VelourPlacementSettings
from .saved_by import saved_by

_OVERRIDE = {"LIBRARY_OVERRIDABLE"}

MODELS = (
    ("SCATTERED", "Per-View", "Separate lobes for each sampled view direction, blended between views", 0),
    (
        "PARAMETRIC",
        "Parametric",
        "Few lobes that change smoothly with the view direction; the smallest model",
        1,
    ),
)


class VelourMaterialSettings(bpy.types.PropertyGroup):
    """`node.velour`; the model itself is `node.image`."""

    saved_by: saved_by()
    enabled: BoolProperty(
        name="Measured Material",
        description="Render this node's material with the measured model in the node's image",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    measurement: PointerProperty(
        name="Measurement",
        description="Measurement file that the model is fitted to. Only the path of the image is used",
        type=bpy.types.Image,
        override=_OVERRIDE,
    )
    model: EnumProperty(
        name="Model",
        description="Type of model that is fitted to the measurement",
        items=MODELS,
        default="PARAMETRIC",
        override=_OVERRIDE,
    )
    kernel: EnumProperty(
        name="Kernel",
        description="Shape of the lobes of a per-view model",
        items=(
            ("GAUSSIAN", "Gaussian", "exp(bandwidth * (cos - 1)), the von Mises-Fisher distribution", 0),
            ("ABEL_POISSON", "Abel-Poisson", "Sharp peak with a long tail", 1),
        ),
        default="GAUSSIAN",
        override=_OVERRIDE,
    )
    tolerance: FloatProperty(
        name="Max Error",
        description="Maximum relative error at view angles up to 75 degrees, twice that beyond."
        " 0.02: hardly visible next to the measurement",
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
        description="Maximum number of lobes (per view for the per-view model). The fit stops earlier"
        " when Max Error is met",
        default=16,
        min=1,
        max=64,
        override=_OVERRIDE,
    )
    neighbors: IntProperty(
        name="Neighbors",
        description="Number of sampled views that a per-view model blends. 0: the model's default",
        default=0,
        min=0,
        max=16,
        update=changed,
        override=_OVERRIDE,
    )
    use_limit_albedo: BoolProperty(
        name="Limit Albedo",
        description="Lower the model where the measurement reflects more light than it receives",
        default=False,
        override=_OVERRIDE,
    )
    use_symmetric: BoolProperty(
        name="Reciprocal",
        description="Make the model invariant to exchanging light and view, for programs that trace light"
        " from both ends. Evaluation takes about three times as long",
        default=False,
        override=_OVERRIDE,
    )
    use_all_data: BoolProperty(
        name="All Data",
        description="Fit to all samples, without holding any out for the error estimate. For final models",
        default=False,
        override=_OVERRIDE,
    )
    use_reference: BoolProperty(
        name="Render from Measurement",
        description="Evaluate the measurement instead of the model. Slower, for comparison",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    seed: IntProperty(name="Seed", description="Random seed of the fit", default=0, min=0, override=_OVERRIDE)
    btf: PointerProperty(
        name="BTF Fit",
        description="Settings for fitting the material's BTF",
        type=VelourBtfFitSettings,
        override=_OVERRIDE,
    )
    job: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # marks of jobs with results for this node
    scene_model: PointerProperty(
        name="Scene Model",
        description="Smaller model for the views and lights of one scene. The full model is kept",
        type=bpy.types.Image,
        update=changed,
        override=_OVERRIDE,
    )
    use_scene_model: BoolProperty(
        name="Use Scene Model",
        description="Use the scene model in the frames it was fitted for. Other frames use the full model and"
        " report it",
        default=False,
        update=changed,
        override=_OVERRIDE,
    )
    structure: PointerProperty(
        name="Structure",
        description="Object that is one tile of the structure. The material gets its silhouette and holes",
        type=bpy.types.Object,
    )
    outline_texels: IntProperty(
        name="Texels",
        description="Resolution of the silhouette along the tile",
        default=128,
        min=4,
        max=4096,
        override=_OVERRIDE,
    )
    outline_width: FloatProperty(
        name="Tile Width",
        description="Width of a tile on the object, which also scales the height of the structure."
        " 0: mean width from the texture coordinates",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
        update=changed,
        override=_OVERRIDE,
    )
    outline_softness: FloatProperty(
        name="Edge Softness",
        description="Share of the tile width over which the silhouette fades out, as fuzz does. 0: hard edge",
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
        description="Color that multiplies the reflection. White: as measured",
        subtype="COLOR",
        size=3,
        default=(1.0, 1.0, 1.0),
        min=0.0,
        soft_max=1.0,
        update=look_changed,
        override=_OVERRIDE,
        **stored_or_input("tint", (1.0, 1.0, 1.0)),
    )
    exposure: FloatProperty(
        name="Exposure",
        description="Exposure of the reflection in stops, each of which doubles it. 0: as measured",
        default=0.0,
        soft_min=-4.0,
        soft_max=4.0,
        min=-32.0,
        max=32.0,
        update=look_changed,
        override=_OVERRIDE,
        **stored_or_input("exposure", 0.0),
    )
    roughness: FloatProperty(
        name="Roughness Offset",
        description="Widen the highlights of a BRDF model, keeping their brightness; a mirror gets the"
        " highlight of a Glossy BSDF with this roughness. 0: as measured",
        subtype="FACTOR",
        default=0.0,
        min=0.0,
        max=1.0,
        update=look_changed,
        override=_OVERRIDE,
        **stored_or_input("roughness", 0.0),
    )
    placement: PointerProperty(
        name="Placement",
        description="Placement of the tiles of a BTF on objects",
        type=VelourPlacementSettings,
        override=_OVERRIDE,
    )
