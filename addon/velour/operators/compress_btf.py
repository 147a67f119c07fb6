"""Make a material from a BTF: in the background of a window, or at once without one."""

import contextlib
import hashlib
import os
from pathlib import Path

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

from ..core.fit_time import fit_of, remember
from ..core.plain_words import plain
from ..core.read_job import ReadJob, check
from ..core.sizes import data_size
from ..export.caches import cache_folder
from ..native import Btf, compress_job
from . import measured
from .approximate import MakesModel
from .asked_fit import AskedFit
from .job_target import JobOwner
from .slots import SlotTarget
from .tiles import held_out_folder


class VELOUR_OT_compress_btf(AskedFit, MakesModel, bpy.types.Operator):
    bl_idname = "velour.compress_btf"
    bl_label = "Make Material from BTF"
    bl_description = "Fit a model to a captured or measured BTF and make a material of it"
    bl_options = {"UNDO"}

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
        tile, path = self._chosen(context)
        self._owner = JobOwner(tile.owner) if tile else None
        self._slot = SlotTarget.asked(context, self)
        self._subject = measured.btf_name(path)
        self._path = measured.btf_file(path)
        self._asked_for = self._options(tile)
        self._threads = context.scene.render.threads
        folder = _held_out_of(tile)
        self._job = self._reading = ReadJob(lambda: _read(path, folder))

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        btf, info, held_out = self._reading.result()
        self._reading = None
        with btf, held_out or contextlib.nullcontext():
            self._digest = info["sha256"]
            checkpoint = _checkpoint(self._digest, self._asked_for)
            # One that goes on with what another has done would tell too little.
            self._fit = None if os.path.exists(checkpoint) else fit_of(info, self._asked_for, self._threads)
            self._next = compress_job(
                btf,
                threads=self._threads,
                checkpoint=checkpoint,
                resume=1,
                **self._asked_for,
                **({"held_out": held_out} if held_out else {}),
            )
        return None

    def _remember(self, image):
        """For the tile's panel."""
        owner = self._owner.take() if self._owner else None
        if owner is not None:
            owner.velour.model = image

    def _wants_approximation(self):
        return True

    def _put(self):
        data, report = self._data, self._report
        if self._fit is not None:
            remember(Path(cache_folder()), self._fit, self._seconds)
        material = measured.new_material(self._subject)
        node = measured.ensure_node(material)
        node.image = measured.packed_model(data, self._subject)
        node.velour.measurement = measured.measurement_image(self._path, self._digest)
        self._put_approximation(material)
        self._remember(node.image)
        if self._slot:
            self._slot.put(material, self.report)
        else:
            material.use_fake_user = True
        for sentence in report["warnings"]:
            self.report({"WARNING"}, plain(sentence))
        unseen = report["psnr_held_out"]
        self.report(
            {"INFO"},
            f"Material '{material.name}': {data_size(len(data))}, 1:{report['ratio']:.0f},"
            f" {report['psnr']:.1f} dB, error {report['relative_l2']:.3f}"
            + ("." if unseen is None else f"; {unseen:.1f} dB at pairs that it has not seen."),
        )
        return {"FINISHED"}


def _read(path, held_out):
    """Beside the window: the BTF, what is known of it, and the one to judge by or None."""
    btf = Btf.load(path)
    check()
    return btf, btf.info(), held_out and Btf.load(held_out)


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
