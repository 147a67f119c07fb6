"""State of the user interface: background job, plot, results of a check, measurement browser.

Never saved."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from .browser_settings import VelourBrowserSettings
from .check_state import VelourCheckState
from .plot_settings import VelourPlotSettings


class VelourJobState(bpy.types.PropertyGroup):
    """`window_manager.velour`. Stores names, since undo may replace any datablock while a job runs."""

    running: BoolProperty(options={"SKIP_SAVE"})
    cancel_requested: BoolProperty(options={"SKIP_SAVE"})
    subject: StringProperty(options={"SKIP_SAVE"})  # name of what the job works on
    canceled: StringProperty(options={"SKIP_SAVE"})  # sentence on the last job, if it was canceled
    canceled_subject: StringProperty(options={"SKIP_SAVE"})
    stage: StringProperty(options={"SKIP_SAVE"})
    seconds_left: FloatProperty(default=-1.0, options={"SKIP_SAVE"})  # below 0: unknown
    waiting: IntProperty(options={"SKIP_SAVE"})  # number of queued jobs
    fraction: FloatProperty(name="Progress", subtype="FACTOR", min=0.0, max=1.0, options={"SKIP_SAVE"})
    reading: StringProperty(options={"SKIP_SAVE"})  # name of what is being read; empty: nothing
    estimate: StringProperty(options={"SKIP_SAVE"})  # estimate of a capture
    estimated: StringProperty(options={"SKIP_SAVE"})  # key of the estimated capture
    fit_estimate: StringProperty(options={"SKIP_SAVE"})  # estimate of a BTF fit
    fit_estimated: StringProperty(options={"SKIP_SAVE"})
    outline_estimate: StringProperty(options={"SKIP_SAVE"})  # estimate of a VOTF
    outline_estimated: StringProperty(options={"SKIP_SAVE"})
    plot: PointerProperty(type=VelourPlotSettings)
    checked: PointerProperty(type=VelourCheckState)
    browser: PointerProperty(type=VelourBrowserSettings)
