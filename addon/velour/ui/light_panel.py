"""Lights in the Properties editor. Blender's own panels are EEVEE's, whose factors Velour does not read."""

import bpy

from .properties_panel import PropertiesPanel

_NEWER_POWER = ("exposure", "normalize")  # 4.5 and newer


class VELOUR_LIGHT_PT_light(PropertiesPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light is not None

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.row().prop(light, "type", expand=True)
        layout.use_property_split = True
        _draw_power(layout.column(), light)
        _DRAW_SHAPE[light.type](layout.column(), light)
        _draw_shadow(layout.column(), light)


def _draw_power(column, light):
    if hasattr(light, "use_temperature"):
        row = column.row(heading="Temperature", align=True)
        row.prop(light, "use_temperature", text="")
        value = row.row()
        value.active = light.use_temperature
        value.prop(light, "temperature", text="")
    column.prop(light, "color")
    column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
    for name in _NEWER_POWER:
        if hasattr(light, name):
            column.prop(light, name)


def _draw_sun(column, light):
    column.prop(light, "angle")


def _draw_point(column, light):
    column.prop(light, "shadow_soft_size", text="Radius")
    if hasattr(light, "use_soft_falloff"):
        column.prop(light, "use_soft_falloff")


def _draw_spot(column, light):
    _draw_point(column, light)
    column.prop(light, "spot_size", text="Beam Angle")
    column.prop(light, "spot_blend", text="Blend", slider=True)
    column.prop(light, "show_cone")


def _draw_area(column, light):
    column.prop(light, "shape")
    is_even = light.shape in ("SQUARE", "DISK")
    column.prop(light, "size", text="Size" if is_even else "Size X")
    if not is_even:
        column.prop(light, "size_y", text="Y")
    column.prop(light, "spread")
    cycles = getattr(light, "cycles", None)
    if hasattr(cycles, "is_portal"):
        column.prop(cycles, "is_portal", text="Portal")


_DRAW_SHAPE = {"SUN": _draw_sun, "POINT": _draw_point, "SPOT": _draw_spot, "AREA": _draw_area}


def _draw_shadow(column, light):
    """Cycles has a shadow switch of its own before 4.2; that of the light is EEVEE's there."""
    cycles = getattr(light, "cycles", None)
    if hasattr(cycles, "cast_shadow"):
        column.prop(cycles, "cast_shadow", text="Cast Shadow")
    elif hasattr(light, "use_shadow"):
        column.prop(light, "use_shadow", text="Cast Shadow")
