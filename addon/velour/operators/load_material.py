"""File > Import: model and measurement files become materials."""

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..native import VelourError, library
from ..native.errors import refuse
from . import measured


class VELOUR_OT_load_material(bpy.types.Operator, ImportHelper):
    bl_idname = "velour.load_material"
    bl_label = "Import Measured Material"
    bl_description = "Make materials from model files (.velour) or measurements (MERL, RGL, Cornell)"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".velour"
    filter_glob: StringProperty(default="*.velour;*.binary;*.bsdf;*.brdf;*.exr", options={"HIDDEN"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    pack: BoolProperty(
        name="Pack Models",
        description="Keep models (kilobytes) inside the .blend. Measurements always stay files",
        default=True,
    )
    fit: BoolProperty(
        name="Fit Measurements", description="Fit a model to each measurement at once", default=True
    )

    def execute(self, context):
        try:
            materials = [self._load(path) for path in self._paths()]
        except (VelourError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        measured.assign(context, materials[0])
        for material in materials[1:]:
            material.use_fake_user = True
        unfitted = [m.name for m in materials if measured.ensure_node(m).image is None]
        if self.fit:
            return self._fit_all(unfitted)
        return {"FINISHED"}

    def _paths(self):
        names = [file.name for file in self.files if file.name]
        return [os.path.join(self.directory, name) for name in names] or [bpy.path.abspath(self.filepath)]

    def _load(self, path):
        info = library.file_info(path)
        name = os.path.splitext(os.path.basename(path))[0]
        if info["kind"] == "btf":
            raise refuse(f"{path} is a BTF; bpy.ops.velour.compress_btf makes a material of it.")
        if info["kind"] != "model":
            image = measured.measurement_image(path, info["sha256"])
            material = measured.new_material(name)
            measured.ensure_node(material).velour.measurement = image
            return material
        with open(path, "rb") as file:
            data = file.read()
        image = measured.packed_model(data, name) if self.pack else measured.linked_model(path, data)
        material = measured.new_material(name)
        measured.ensure_node(material).image = image
        return material

    def _fit_all(self, names):
        # One fit may run in the background of a window; several are made one after the other.
        background = len(names) == 1 and not bpy.app.background
        for name in names:
            mode = "INVOKE_DEFAULT" if background else "EXEC_DEFAULT"
            try:
                bpy.ops.velour.fit(mode, material=name)
            except RuntimeError as error:
                self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
                return {"FINISHED"}  # the materials are there; fitting can be tried again
        return {"FINISHED"}
