"""Settings of a BTF fit."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

# Numbers are the library's, and so are the names in lower case with hyphens.
METHODS = (
    (
        "SRBF",
        "SRBF",
        "Spherical radial basis functions over a relief: smallest, smooth between directions",
        1,
    ),
    ("KCTA", "K-CTA", "Clustered tensor approximation with several clusters per texel", 4),
    ("CTA", "CTA", "Clustered tensor approximation with one cluster per texel", 3),
    ("TUCKER", "Tucker", "One Tucker decomposition for all texels", 2),
    ("SVD", "SVD", "Truncated singular value decomposition", 0),
    ("SVD_VIEW", "SVD by View", "Separate truncated singular value decomposition for each view", 5),
)
SHAPE_OF = {"CTA": ("clusters",), "KCTA": ("clusters", "members")}  # settings that a method takes
NAMES = ("method", "clusters", "members", "tolerance", "megabytes")
_OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}


class BtfFitSettings:
    """Mixin for a PropertyGroup."""

    method: EnumProperty(
        name="Method",
        description="Model that is fitted to the BTF",
        items=METHODS,
        default="SRBF",
        override=_OVERRIDABLE,
    )
    clusters: IntProperty(
        name="Clusters",
        description="Number of texel clusters. 0: automatic",
        min=0,
        max=256,
        override=_OVERRIDABLE,
    )
    members: IntProperty(
        name="Clusters per Texel",
        description="Number of clusters that a texel is composed of. 0: automatic",
        min=0,
        max=8,
        override=_OVERRIDABLE,
    )
    tolerance: FloatProperty(
        name="Max Error",
        description="Choose the smallest model with at most this relative error (0.1: about a tenth of the"
        " perceived brightness). 0: limited by Max Size only",
        min=0.0,
        max=0.9,
        default=0.0,
        precision=3,
        step=1,
        override=_OVERRIDABLE,
    )
    megabytes: FloatProperty(
        name="Max Size (MB)",
        description="Maximum model size in MB. 0: automatic, or unlimited if Max Error is set",
        min=0.0,
        default=0.0,
        precision=3,
        override=_OVERRIDABLE,
    )


class VelourBtfFitSettings(BtfFitSettings, bpy.types.PropertyGroup):
    """`node.velour.btf`, for a material whose measurement is a BTF."""
