"""Velour: measured materials for Blender. Only names the add-on and hands over to `registration`."""

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


def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()


class glTF2ExportUserExtension:
    """Blender's exporter asks each add-on for a class of that name."""

    def gather_material_hook(self, gltf_material, material, export_settings):
        from .operators.approximation_gltf import fill

        fill(gltf_material, material, export_settings)
