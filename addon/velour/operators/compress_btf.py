"""Make a material from a BTF: in the background of a window, or at once without one."""

import contextlib
import hashlib
import os

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..core.plain_words import plain
from ..core.read_job import ReadJob
from ..native import Btf, compress_job
from ..properties.tile_settings import METHODS, SHAPE_OF
from . import measured
from .approximate import MakesModel
from .slots import Slot, assign
from .tiles import find_tile, held_out_folder, tile_folder


class VELOUR_OT_compress_btf(MakesModel, bpy.types.Operator):
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
    # Where given these replace the settings of the tile, where there is one.
    method: EnumProperty(name="Method", items=METHODS, default="SRBF", options={"SKIP_SAVE"})
    clusters: IntProperty(
        name="Clusters",
        description="Of CTA and K-CTA; 0: what serves best",
        min=0,
        max=256,
        options={"SKIP_SAVE"},
    )
    members: IntProperty(
        name="Clusters of a Texel",
        description="Of K-CTA; 0: what serves best",
        min=0,
        max=8,
        options={"SKIP_SAVE"},
    )
    tolerance: FloatProperty(
        name="Largest Error",
        description="Relative L2 error of the roots of values; the smallest model within it. 0: none",
        min=0.0,
        max=0.9,
        options={"SKIP_SAVE"},
    )
    megabytes: FloatProperty(
        name="Megabytes",
        description="Of all coefficients at most; 0: a four-hundredth of the BTF (SVD: twice that), or a few;"
        " with a largest error, whatever it takes",
        min=0.0,
        options={"SKIP_SAVE"},
    )
    assign: BoolProperty(
        name="Assign",
        description="Put the material into a slot: the one that is named, or the active one",
        options={"SKIP_SAVE"},
    )
    object: StringProperty(
        name="Object", description="Whose slot is meant; empty: the active one", options={"SKIP_SAVE"}
    )
    slot: IntProperty(name="Slot", description="Its number, from 0", min=0, options={"SKIP_SAVE"})

    _what = "Making the material"

    def _begin(self, context):
        tile = None if self.filepath else find_tile(context, self.collection)
        path = self.filepath or tile_folder(tile)
        # By name: the owner may be another object after an undo.
        self._owner = (type(tile.owner), tile.owner.name) if tile else None
        path = os.path.normpath(bpy.path.abspath(path))
        self._subject = os.path.splitext(os.path.basename(path))[0]
        self._path = measured.btf_file(path)
        self._asked_for = {
            **self._asked_method(tile),
            "tolerance": self._asked(tile, "tolerance"),
            "bytes": int(self._asked(tile, "megabytes") * 1e6),
        }
        self._threads = context.scene.render.threads
        folder = _held_out_of(tile)
        self._job = self._reading = ReadJob(lambda: (Btf.load(path), folder and Btf.load(folder)))

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        btf, held_out = self._reading.result()
        self._reading = None
        with btf, held_out or contextlib.nullcontext():
            self._digest = btf.info()["sha256"]
            self._next = compress_job(
                btf,
                threads=self._threads,
                checkpoint=_checkpoint(self._digest, self._asked_for),
                resume=1,
                **self._asked_for,
                **({"held_out": held_out} if held_out else {}),
            )
        return None

    def _asked_method(self, tile):
        """The method, and of clusters and members what it takes."""
        method = self._asked(tile, "method")
        taken = {name: self._asked(tile, name) for name in SHAPE_OF.get(method, ())}
        return {"method": method.lower().replace("_", "-"), **taken}

    def _asked(self, tile, name):
        """What was given, or what the tile asks for."""
        if tile and self.properties.is_property_set(name):
            setattr(tile.owner.velour, name, getattr(self, name))
        return getattr(tile.owner.velour if tile else self, name)

    def _remember(self, image):
        """For the tile's panel."""
        if self._owner is None:
            return
        kind, name = self._owner
        owner = (bpy.data.objects if issubclass(kind, bpy.types.Object) else bpy.data.collections).get(name)
        if owner is not None:
            owner.velour.model = image

    def _wants_approximation(self):
        return True

    def _put(self):
        data, report = self._data, self._report
        material = measured.new_material(self._subject)
        node = measured.ensure_node(material)
        node.image = measured.packed_model(data, self._subject)
        node.velour.measurement = measured.measurement_image(self._path, self._digest)
        self._put_approximation(material)
        self._remember(node.image)
        slot = Slot(self.object, self.slot) if self.object else None
        if not (self.assign and assign(bpy.context, material, slot)):
            material.use_fake_user = True
        for sentence in report["warnings"]:
            self.report({"WARNING"}, plain(sentence))
        unseen = report["psnr_held_out"]
        self.report(
            {"INFO"},
            f"Material '{material.name}': {len(data) / 1e6:.2f} MB, 1:{report['ratio']:.0f},"
            f" {report['psnr']:.1f} dB, error {report['relative_l2']:.3f}"
            + ("." if unseen is None else f"; {unseen:.1f} dB at pairs that it has not seen."),
        )
        return {"FINISHED"}


def _held_out_of(tile):
    """The folder of pairs to judge by that were captured beside the tile's BTF, or None."""
    if tile is None or not tile.owner.velour.held_out:
        return None
    folder = held_out_folder(tile)
    return folder if os.path.isdir(folder) else None


def _checkpoint(digest, asked):
    """Of this session: a fit that was cancelled goes on when the same one is started again."""
    name = hashlib.sha256(repr((digest, asked)).encode()).hexdigest()
    return os.path.join(bpy.app.tempdir, f"velour-fit-{name[:32]}")
