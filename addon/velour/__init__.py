"""Velour: measured materials for Blender. Only describes the add-on and delegates to `registration`."""

import importlib.util

# Parsed as text by Blender and a test: literals only; the version is that of CMakeLists.txt and the manifest.
bl_info = {
    "name": "Velour",
    "author": "The Velour authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine; File > Import > Measured Material",
    "description": "Render measured materials with compact models that are fitted and importance sampled",
    "category": "Render",
    "support": "COMMUNITY",
}

_NO_NUMPY = (
    "Velour cannot start: Blender's Python has no NumPy. A Blender from a Linux distribution uses the Python"
    " of an active virtual environment or pyenv: start Blender outside of it, or install NumPy there."
)
_is_registered = False


def register():
    global _is_registered
    if importlib.util.find_spec("numpy") is None:
        print(_NO_NUMPY, flush=True)
        return
    from . import registration

    registration.register()
    _is_registered = True


def unregister():
    global _is_registered
    if not _is_registered:
        return
    from . import registration

    registration.unregister()
    _is_registered = False


class glTF2ExportUserExtension:
    """Blender's glTF exporter looks for a class of this name in each add-on."""

    def gather_material_hook(self, gltf_material, material, export_settings):
        from .operators.approximation_gltf import fill

        fill(gltf_material, material, export_settings)
