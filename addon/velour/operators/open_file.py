"""Chooses the file of a material's measurement or model, and stores its SHA-256 to detect changes."""

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from ..core.measurement_files import file_filter
from ..export import ExportError
from ..export.nodes import velour_node
from . import measured
from .approximate import approximate_new
from .job_target import JobTarget
from .load_material import found_file
from .reads_first import ReadsFirst
from .shared_group import ModelUsers

_NAMES = {
    "model": "a model",
    "measurement": "a measurement",
    "btf": "a BTF",
    "observation": "a scene usage file",
}
_MODELS = ".velour"


class _OpensFile(measured.OfMaterial, ReadsFirst, ImportHelper):
    """Operator mixin. `_kinds`: accepted kinds of files; `_put(context, material, node, file)` takes the
    file that was read."""

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})

    _asks = False

    def invoke(self, context, event):
        """Opens a file browser unless the file is given."""
        if self.properties.is_property_set("filepath"):
            return ReadsFirst.invoke(self, context, event)
        material = measured.find_material(context, self.material)
        self.material = material.name if material else ""
        self._asks = True
        return ImportHelper.invoke(self, context, event)

    def execute(self, context):
        if not self._asks:
            return ReadsFirst.execute(self, context)
        try:
            measured.refuse_folder(bpy.path.abspath(self.filepath))
        except ExportError as error:
            return self._fail(error)
        # Blender ends the file browser's operator when this returns, so another one does the work.
        opens = getattr(bpy.ops.velour, type(self).bl_idname.partition(".")[2])
        opens("INVOKE_DEFAULT", **self.as_keywords(ignore=("check_existing", "filter_glob")))
        return {"CANCELLED"}  # no undo step: the other operator adds it

    def cancel(self, context):
        if not self._asks:
            ReadsFirst.cancel(self, context)

    def _read(self, context):
        material = measured.wanted_material(context, self.material)
        node, path = velour_node(material), bpy.path.abspath(self.filepath)
        if node is None:
            raise ExportError(
                f"Material '{material.name}' is not measured; press Use Measured Material first."
            )
        if material.library is not None:
            raise ExportError(
                f"Material '{material.name}' is linked from another file; choose its files there or make it"
                " local."
            )
        if "model" in self._kinds:
            measured.refuse_linked_group(material, node)
        self._target, self._subject = JobTarget(material, node), material.name
        return lambda: self._refusing_others(found_file(path))

    def _refusing_others(self, file):
        if file.kind not in self._kinds:
            wanted = " or ".join(_NAMES[kind] for kind in self._kinds)
            raise ExportError(f"{file.path} is {_NAMES[file.kind]}; choose {wanted}.")
        return file

    def _use(self, context, file):
        material, node = self._target.find()
        if node is None:
            self.report({"WARNING"}, "The material no longer exists, so the file was not used.")
            return {"CANCELLED"}
        self._put(context, material, node, file)
        return {"FINISHED"}


class VELOUR_OT_open_measurement(_OpensFile, bpy.types.Operator):
    bl_idname = "velour.open_measurement"
    bl_label = "Open Measurement"
    bl_description = "Choose the file of a measurement (MERL, RGL, Cornell) or a BTF. It is not packed"
    bl_options = {"UNDO"}

    filter_glob: StringProperty(default=file_filter(without=_MODELS), options={"HIDDEN"})

    _kinds = ("measurement", "btf")

    def _put(self, _context, _material, node, file):
        node.velour.measurement = measured.measurement_image(file.path, file.digest)


class _OpensModel(_OpensFile):
    filter_glob: StringProperty(default=f"*{_MODELS};*.exr", options={"HIDDEN"})
    pack: BoolProperty(
        name="Pack", description="Store the model (kilobytes) in the .blend file", default=True
    )

    _kinds = ("model",)

    def _image(self, file):
        if self.pack:
            return measured.packed_model(file.data, file.name, file.digest)
        return measured.linked_model(file.path, file.digest)


class VELOUR_OT_open_model(ModelUsers, _OpensModel, bpy.types.Operator):
    bl_idname = "velour.open_model"
    bl_label = "Open Model"
    bl_description = "Choose the file of a fitted model (.velour)"
    bl_options = {"UNDO"}

    def _put(self, context, material, node, file):
        measured.set_model(material, node, self._image(file), self.report, self.users, file.info)
        approximate_new(context, material, file.info)


class VELOUR_OT_open_scene_model(_OpensModel, bpy.types.Operator):
    bl_idname = "velour.open_scene_model"
    bl_label = "Open Scene Model"
    bl_description = "Choose the file of a model that was fitted for a scene (.velour)"
    bl_options = {"UNDO"}

    def _put(self, _context, _material, node, file):
        node.velour.scene_model = self._image(file)
