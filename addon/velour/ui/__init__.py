"""Panels and preferences."""

from . import (
    browser,
    file_handler,
    library_state,
    node_menu,
    placement_summary,
    plot_preview,
    preset_grid,
    progress,
    stock_panels,
    summaries,
    tile_panel,
)
from .advanced_panel import VELOUR_MATERIAL_PT_advanced
from .approximation_panel import VELOUR_MATERIAL_PT_approximation
from .browser_panel import VELOUR_MATERIAL_PT_browser
from .layer_panels import VELOUR_VIEWLAYER_PT_filter, VELOUR_VIEWLAYER_PT_override
from .light_panel import VELOUR_LIGHT_PT_light
from .material_panel import (
    VELOUR_MATERIAL_PT_measured,
    VELOUR_MATERIAL_PT_notes,
    VELOUR_MATERIAL_PT_surface,
)
from .material_settings_panel import VELOUR_MATERIAL_PT_settings
from .model_panel import VELOUR_MATERIAL_PT_model
from .motion_panels import VELOUR_OBJECT_PT_motion_blur, VELOUR_RENDER_PT_motion_blur
from .outline_panel import VELOUR_MATERIAL_PT_outline
from .pass_panels import (
    VELOUR_VIEWLAYER_PT_passes,
    VELOUR_VIEWLAYER_PT_passes_cryptomatte,
    VELOUR_VIEWLAYER_PT_passes_data,
    VELOUR_WORLD_PT_mist,
)
from .placement_panel import VELOUR_MATERIAL_PT_placement
from .plot_panel import VELOUR_MATERIAL_PT_plots
from .preferences import VelourPreferences
from .render_panel import (
    VELOUR_RENDER_PT_check,
    VELOUR_RENDER_PT_film,
    VELOUR_RENDER_PT_library,
    VELOUR_RENDER_PT_light_paths,
    VELOUR_RENDER_PT_newer,
    VELOUR_RENDER_PT_performance,
    VELOUR_RENDER_PT_sampling,
    VELOUR_RENDER_PT_sampling_advanced,
    VELOUR_RENDER_PT_simplify,
    VELOUR_RENDER_PT_viewport,
)
from .scene_model_panel import VELOUR_MATERIAL_PT_scene_model
from .viewport_panel import VELOUR_VIEW3D_PT_lighting
from .visibility_panels import VELOUR_OBJECT_PT_ray_visibility, VELOUR_WORLD_PT_ray_visibility

CLASSES = (
    VelourPreferences,
    VELOUR_RENDER_PT_library,
    VELOUR_RENDER_PT_newer,
    VELOUR_RENDER_PT_sampling,
    VELOUR_RENDER_PT_sampling_advanced,
    VELOUR_RENDER_PT_viewport,
    VELOUR_RENDER_PT_light_paths,
    VELOUR_RENDER_PT_simplify,
    VELOUR_RENDER_PT_motion_blur,
    VELOUR_RENDER_PT_film,
    VELOUR_RENDER_PT_check,
    VELOUR_RENDER_PT_performance,
    VELOUR_VIEWLAYER_PT_filter,
    VELOUR_VIEWLAYER_PT_override,
    VELOUR_VIEWLAYER_PT_passes,
    VELOUR_VIEWLAYER_PT_passes_data,
    VELOUR_VIEWLAYER_PT_passes_cryptomatte,
    VELOUR_WORLD_PT_mist,
    VELOUR_MATERIAL_PT_measured,
    VELOUR_MATERIAL_PT_placement,
    VELOUR_MATERIAL_PT_outline,
    VELOUR_MATERIAL_PT_advanced,
    VELOUR_MATERIAL_PT_scene_model,
    VELOUR_MATERIAL_PT_model,
    VELOUR_MATERIAL_PT_plots,
    VELOUR_MATERIAL_PT_approximation,
    VELOUR_MATERIAL_PT_notes,
    VELOUR_MATERIAL_PT_browser,
    VELOUR_MATERIAL_PT_surface,
    VELOUR_MATERIAL_PT_settings,
    VELOUR_LIGHT_PT_light,
    VELOUR_OBJECT_PT_ray_visibility,
    VELOUR_OBJECT_PT_motion_blur,
    VELOUR_WORLD_PT_ray_visibility,
    VELOUR_VIEW3D_PT_lighting,
    *tile_panel.CLASSES,
    *file_handler.CLASSES,
)


def attach():
    library_state.refresh()
    progress.attach()
    placement_summary.attach()
    stock_panels.open_to_engine()
    node_menu.open_to_engine()


def detach():
    node_menu.close_to_engine()
    stock_panels.close_to_engine()
    placement_summary.detach()
    progress.detach()
    summaries.forget()
    plot_preview.forget()
    browser.forget()
    preset_grid.forget()
