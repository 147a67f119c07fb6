"""Velour's properties in .blend files."""

import bpy

from .approximation_state import VelourApproximationState
from .browser_settings import VelourBrowserSettings
from .btf_fit_settings import VelourBtfFitSettings
from .check_state import VelourCheckState, VelourSentence, VelourServedModel
from .file_settings import VelourFileSettings
from .job_state import VelourJobState
from .layer_settings import VelourLayerSettings
from .material_settings import VelourMaterialSettings
from .placement_settings import VelourPlacementSettings
from .plot_settings import VelourPlotSettings
from .render_settings import VelourRenderSettings
from .tile_settings import VelourTileSettings

_POINTERS = (
    (bpy.types.Scene, VelourRenderSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.ViewLayer, VelourLayerSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.ShaderNodeTexImage, VelourMaterialSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.ShaderNodeGroup, VelourMaterialSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.ShaderNodeTree, VelourApproximationState, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.Image, VelourFileSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.Object, VelourTileSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.Collection, VelourTileSettings, {"LIBRARY_OVERRIDABLE"}),
    (bpy.types.WindowManager, VelourJobState, set()),
)
# A group comes after the groups that it contains.
CLASSES = (
    VelourPlacementSettings,
    VelourBtfFitSettings,
    VelourPlotSettings,
    VelourBrowserSettings,
    VelourSentence,
    VelourServedModel,
    VelourCheckState,
    *dict.fromkeys(group for _owner, group, _override in _POINTERS),
)


def attach():
    for owner, group, override in _POINTERS:
        owner.velour = bpy.props.PointerProperty(type=group, name="Velour", override=override)


def detach():
    for owner, _group, _override in reversed(_POINTERS):
        del owner.velour
