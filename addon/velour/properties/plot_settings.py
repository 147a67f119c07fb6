"""Settings of a model's plots. Never saved."""

import math

import bpy
from bpy.props import EnumProperty, FloatProperty

# The library's names are these in lower case with hyphens.
PLOTS = (
    ("LOBES", "Lobes", "Lobes of the model: reflection toward one view, from all angles in its plane", 0),
    ("ORDER", "Size", "Error by number of lobes (of a BTF: by size in bytes)", 1),
    ("VIEW_ERROR", "Error", "Error at five view angles, and Max Error", 2),
    ("ALBEDO", "Albedo", "Share of light from all directions that is reflected, by view angle", 3),
    ("OUTLINE", "Silhouette", "Share of the tile that its structure covers, by view angle", 4),
)


def plot_view():
    return FloatProperty(
        name="View",
        description="Angle between the surface normal and the view whose lobes are shown",
        default=math.radians(30),
        min=0.0,
        max=math.radians(89),
        subtype="ANGLE",
        options={"SKIP_SAVE"},
    )


def plot_azimuth():
    return FloatProperty(
        name="Azimuth",
        description="Azimuth of the view, from the U direction. It has no effect on isotropic materials",
        default=0.0,
        subtype="ANGLE",
        options={"SKIP_SAVE"},
    )


def plot_kind():
    return EnumProperty(name="Plot", items=PLOTS, default="LOBES", options={"SKIP_SAVE"})


class VelourPlotSettings(bpy.types.PropertyGroup):
    """`window_manager.velour.plot`."""

    kind: plot_kind()
    view: plot_view()
    azimuth: plot_azimuth()
