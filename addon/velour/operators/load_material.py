"""File > Import, or files dropped into a window: models and measurements become materials."""

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..native import VelourError, library
from . import measured
from .slots import Slot, assign, slot_under

# Never .exr: those are pictures to everyone else.
DROPPED = (".velour", ".binary", ".bsdf", ".brdf", ".btf")


class VELOUR_OT_load_material(bpy.types.Operator, ImportHelper):
    bl_idname = "velour.load_material"
    bl_label = "Import Measured Material"
    bl_description = "Make materials from model files (.velour) or measurements (MERL, RGL, Cornell, BTFs)"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".velour"
    filter_glob: StringProperty(
        default="*.velour;*.binary;*.bsdf;*.brdf;*.exr;*.btf;btf.json;btf.csv", options={"HIDDEN"}
    )
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

    assign: BoolProperty(
        name="Assign", description="Put the first material into a slot", default=True, options={"SKIP_SAVE"}
    )
    object: StringProperty(
        name="Object",
        description="Whose slot is meant; empty: the active one",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    slot: IntProperty(name="Slot", description="Its number, from 0", min=0, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context, event):
        """What is dropped on an object goes into the slot under the cursor, elsewhere into none.

        Without files one is asked for them."""
        if not (self.properties.is_property_set("filepath") or self.files):
            return super().invoke(context, event)
        if context.area is not None and context.area.type == "VIEW_3D":
            slot = slot_under(context, event)
            self.assign = slot is not None
            if slot is not None:
                self.object, self.slot = slot
        return self.execute(context)

    def execute(self, context):
        try:
            kinds = {path: library.file_info(path) for path in self._paths()}
            btfs = [path for path, info in kinds.items() if info["kind"] == "btf"]
            materials = [self._load(path, info) for path, info in kinds.items() if path not in btfs]
        except (VelourError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        slot = Slot(self.object, self.slot) if self.object else None
        for number, material in enumerate(materials):
            if number > 0 or not self.assign or not assign(context, material, slot):
                material.use_fake_user = True
        unfitted = [m.name for m in materials if measured.ensure_node(m).image is None]
        jobs = [(bpy.ops.velour.fit, {"material": name}) for name in unfitted if self.fit]
        jobs += [
            (bpy.ops.velour.approximate, {"material": m.name}) for m in materials if m.name not in unfitted
        ]
        for path in btfs:  # the first of all files takes the slot
            place = {
                "assign": self.assign and not materials and path == btfs[0],
                **(slot._asdict() if slot else {}),
            }
            jobs.append((bpy.ops.velour.compress_btf, {"filepath": path, **place}))
        return self._run_all(jobs)

    def _paths(self):
        names = [file.name for file in self.files if file.name]
        return [os.path.join(self.directory, name) for name in names] or [bpy.path.abspath(self.filepath)]

    def _load(self, path, info):
        name = os.path.splitext(os.path.basename(path))[0]
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

    def _run_all(self, jobs):
        # One job may run in the background of a window; several are done one after the other.
        mode = "INVOKE_DEFAULT" if len(jobs) == 1 and not bpy.app.background else "EXEC_DEFAULT"
        for operator, arguments in jobs:
            try:
                operator(mode, **arguments)
            except RuntimeError as error:
                self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
                return {"FINISHED"}  # the materials are there; their jobs can be tried again
        return {"FINISHED"}
