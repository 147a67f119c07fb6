"""What a fit of a BTF is asked for."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

# Numbers and, in lower case with hyphens, names are the library's.
METHODS = (
    ("SRBF", "SRBF", "Lobes of light and view over a relief: smallest, and smooth between directions", 1),
    ("KCTA", "K-CTA", "Clustered tensors, of which a texel has a few", 4),
    ("CTA", "CTA", "Clustered tensors, of which a texel has one", 3),
    ("TUCKER", "Tucker", "One tensor decomposition for all texels", 2),
    ("SVD", "SVD", "Truncated singular values", 0),
    ("SVD_VIEW", "SVD by View", "Singular values of each view for itself", 5),
)
SHAPE_OF = {"CTA": ("clusters",), "KCTA": ("clusters", "members")}  # settings that a method takes
NAMES = ("method", "clusters", "members", "tolerance", "megabytes")
_OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}


class BtfFitSettings:
    """Mixin of a PropertyGroup."""

    method: EnumProperty(
        name="Method",
        description="What the BTF is turned into",
        items=METHODS,
        default="SRBF",
        override=_OVERRIDABLE,
    )
    clusters: IntProperty(
        name="Clusters",
        description="Of texels that look alike in how they turn with view and light. 0: what serves best",
        min=0,
        max=256,
        override=_OVERRIDABLE,
    )
    members: IntProperty(
        name="Clusters of a Texel",
        description="How many a texel is made of. 0: what serves best",
        min=0,
        max=8,
        override=_OVERRIDABLE,
    )
    tolerance: FloatProperty(
        name="Largest Error",
        description="The smallest material that differs from the BTF by no more than this part: 0.1 is about"
        " a tenth of how bright things look. 0: as good as the size allows",
        min=0.0,
        max=0.9,
        default=0.0,
        precision=3,
        step=1,
        override=_OVERRIDABLE,
    )
    megabytes: FloatProperty(
        name="Largest Size (MB)",
        description="Of the material, at most. 0: a four-hundredth of the BTF; with a largest error, whatever"
        " it takes",
        min=0.0,
        default=0.0,
        precision=3,
        override=_OVERRIDABLE,
    )


class VelourBtfFitSettings(BtfFitSettings, bpy.types.PropertyGroup):
    """`node.velour.btf`: of a material whose measurement is a BTF."""
