"""Velour: measured materials for Blender. Only names the add-on and hands over to `registration`."""

import importlib.util

# Read as text by Blender and by a test: literal values only, the version of CMakeLists.txt and the manifest.
bl_info = {
    "name": "Velour",
    "author": "The Velour authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine; File > Import > Measured Material",
    "description": "Measured BRDFs as compact models, fitted, sampled in closed form and ray traced",
    "category": "Render",
    "support": "COMMUNITY",
}

_NO_NUMPY = (
    "Velour: Blender's Python has no numpy, which Velour needs. A Blender of a distribution takes"
    " the Python of an active virtual environment or pyenv: start it outside of that, or install numpy there."
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
    """Blender's exporter asks each add-on for a class of that name."""

    def gather_material_hook(self, gltf_material, material, export_settings):
        from .operators.approximation_gltf import fill

        fill(gltf_material, material, export_settings)
