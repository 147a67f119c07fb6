"""What the plots of models show. Never saved."""

import math

import bpy
from bpy.props import EnumProperty, FloatProperty

# By name as the library has them, in lower case and with hyphens.
PLOTS = (
    ("LOBES", "Lobes", "What the model is made of: light to one view, from all angles in its plane", 0),
    ("ORDER", "Size", "Error against the number of lobes (of a BTF: against bytes)", 1),
    ("VIEW_ERROR", "Error", "Error at five view angles, and the tolerance", 2),
    ("ALBEDO", "Albedo", "Share of the light from all sides that is reflected, against the view angle", 3),
    ("OUTLINE", "Outline", "Share of the tile that its structure covers, against the view angle", 4),
)


def plot_view():
    return FloatProperty(
        name="View",
        description="Angle between the normal and the view whose lobes are shown",
        default=math.radians(30),
        min=0.0,
        max=math.radians(89),
        subtype="ANGLE",
        options={"SKIP_SAVE"},
    )


def plot_azimuth():
    return FloatProperty(
        name="Azimuth",
        description="Of the view, about the normal, from the direction of U. Isotropic materials look alike",
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
