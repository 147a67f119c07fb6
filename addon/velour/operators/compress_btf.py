"""Make a material from a BTF: in the background of a window, or at once without one."""

import os

import bpy
from bpy.props import BoolProperty, FloatProperty, StringProperty

from ..native import Btf, compress_job
from . import measured
from .background_job import OneJob
from .tiles import find_tile, tile_folder


class VELOUR_OT_compress_btf(OneJob, bpy.types.Operator):
    bl_idname = "velour.compress_btf"
    bl_label = "Make Material from BTF"
    bl_description = "Fit a model to a captured or measured BTF and make a material of it"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="BTF",
        subtype="FILE_PATH",
        description="A folder, a CSV index or a .btf file; empty: what was captured of the tile",
        options={"SKIP_SAVE"},
    )
    collection: StringProperty(
        name="Collection", description="The tile; empty: the active object is it", options={"SKIP_SAVE"}
    )
    megabytes: FloatProperty(
        name="Megabytes",
        description="Of all coefficients at most; 0: a two-hundredth of the BTF, or a few components",
        min=0.0,
        options={"SKIP_SAVE"},
    )
    assign: BoolProperty(
        name="Assign",
        description="Put the material into the active slot of the active object",
        options={"SKIP_SAVE"},
    )

    _what = "Making the material"

    def _begin(self, context):
        path = self.filepath or tile_folder(find_tile(context, self.collection))
        path = os.path.normpath(bpy.path.abspath(path))
        self._subject = os.path.splitext(os.path.basename(path))[0]
        self._path = measured.btf_file(path)
        with Btf.load(path) as btf:
            self._digest = btf.info()["sha256"]
            self._job = compress_job(
                btf, bytes=int(self.megabytes * 1e6), threads=context.scene.render.threads
            ).start()

    def _finish(self):
        with self._job, self._job.result_model() as model:
            data, report = model.bytes(), self._job.report()
        material = measured.new_material(self._subject)
        node = measured.ensure_node(material)
        node.image = measured.packed_model(data, self._subject)
        node.velour.measurement = measured.measurement_image(self._path, self._digest)
        if not (self.assign and measured.assign(bpy.context, material)):
            material.use_fake_user = True
        for sentence in report["warnings"]:
            self.report({"WARNING"}, sentence)
        self.report(
            {"INFO"},
            f"Material '{material.name}': {len(data) / 1e6:.2f} MB, 1:{report['ratio']:.0f},"
            f" {report['psnr']:.1f} dB.",
        )
        return {"FINISHED"}
