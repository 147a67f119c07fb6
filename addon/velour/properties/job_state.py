"""What windows show: the work in the background, which plot, what a check found, which measurements.

Never saved."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from .browser_settings import VelourBrowserSettings
from .check_state import VelourCheckState
from .plot_settings import VelourPlotSettings


class VelourJobState(bpy.types.PropertyGroup):
    """`window_manager.velour`. Names, not pointers: undo may replace any datablock while the job runs."""

    running: BoolProperty(options={"SKIP_SAVE"})
    cancel_requested: BoolProperty(options={"SKIP_SAVE"})
    subject: StringProperty(options={"SKIP_SAVE"})  # name of what it works on
    stage: StringProperty(options={"SKIP_SAVE"})
    seconds_left: FloatProperty(default=-1.0, options={"SKIP_SAVE"})  # below 0: not known
    waiting: IntProperty(options={"SKIP_SAVE"})  # how many come after it
    fraction: FloatProperty(name="Progress", subtype="FACTOR", min=0.0, max=1.0, options={"SKIP_SAVE"})
    reading: StringProperty(options={"SKIP_SAVE"})  # name of what is read beside it; empty: nothing
    estimate: StringProperty(options={"SKIP_SAVE"})  # of a capture
    estimated: StringProperty(options={"SKIP_SAVE"})  # which one it is of
    fit_estimate: StringProperty(options={"SKIP_SAVE"})  # of a fit of a BTF
    fit_estimated: StringProperty(options={"SKIP_SAVE"})
    outline_estimate: StringProperty(options={"SKIP_SAVE"})  # of an outline
    outline_estimated: StringProperty(options={"SKIP_SAVE"})
    plot: PointerProperty(type=VelourPlotSettings)
    checked: PointerProperty(type=VelourCheckState)
    browser: PointerProperty(type=VelourBrowserSettings)
