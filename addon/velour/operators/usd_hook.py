"""Hook of Blender's USD exporter, 4.0 and newer, that adds approximations of measured materials."""

import importlib.util

import bpy

from . import approximation_usd, materialx_usd

_registered = []


class VELOUR_USD_approximation(getattr(bpy.types, "USDHook", object)):
    bl_idname = "velour_approximation"
    bl_label = "Velour Approximation"

    @staticmethod
    def on_material_export(export_context, bl_material, usd_material):
        parts = {"approximation": approximation_usd, "MaterialX surface": materialx_usd}
        written = [
            _write(part, module, (export_context, bl_material, usd_material))
            for part, module in parts.items()
        ]
        return any(written)

    @staticmethod
    def on_export(export_context):
        try:
            approximation_usd.choose_uvs(export_context.get_stage())
        except Exception as error:
            return _sorry("the texture coordinates of approximations", error)
        return True


def _write(part, module, arguments):
    """Writes a part of a material; without it, the export continues."""
    try:
        return module.write(*arguments)
    except Exception as error:
        return _sorry(f"the {part} of material '{arguments[1].name}'", error)


def attach():
    if _can_be_asked():
        bpy.utils.register_class(VELOUR_USD_approximation)
        _registered.append(VELOUR_USD_approximation)


def detach():
    while _registered:
        bpy.utils.unregister_class(_registered.pop())


def _can_be_asked():
    """Whether hooks work: without USD's Python modules, as in some bpy builds, any hook aborts exports."""
    return hasattr(bpy.types, "USDHook") and all(map(_is_there, ("pxr", "pxr.Usd", "pxr.UsdShade")))


def _is_there(module):
    try:
        return importlib.util.find_spec(module) is not None
    except ImportError:
        return False


def _sorry(what, error):
    print(
        f"Velour: {what} could not be written to the USD file ({type(error).__name__}: {error}).", flush=True
    )
    return False
