"""Makes a material from a BTF: in the background or, without a window, synchronously."""

import contextlib
import functools
import hashlib
import os
from pathlib import Path

import bpy
from bpy.props import BoolProperty

from ..core.fit_time import fit_of, remember
from ..core.read_job import ReadJob, check
from ..core.sizes import data_size
from ..core.warning_table import sentences
from ..export.caches import cache_folder
from ..export.nodes import velour_node
from ..native import Btf, compress_job
from . import measured
from .approximate import MakesModel
from .asked_fit import AskedFit, keep, options_of
from .job_target import JobOwner, JobTarget
from .slots import PutsInSlot, SlotTarget
from .tiles import held_out_folder


class VELOUR_OT_compress_btf(AskedFit, PutsInSlot, MakesModel, bpy.types.Operator):
    bl_idname = "velour.compress_btf"
    bl_label = "Make Material from BTF"
    bl_description = (
        "Fit a model to a BTF. Creates a material, or refits the BTF's own; the previous model is kept"
    )
    bl_options = {"UNDO"}

    assign: BoolProperty(
        name="Assign",
        description="Put the material into the given slot, or else the active slot",
        options={"SKIP_SAVE"},
    )

    _what = "Making the material"
    _target = None  # the material whose model is refitted

    def _begin(self, context):
        chosen = self._chosen(context)
        self._owner = JobOwner(chosen.tile.owner) if chosen.tile else None
        if chosen.material:
            node = velour_node(chosen.material)
            self._target, self._what = JobTarget(chosen.material, node), "The fit"
            self._read_file = measured.ReadFile.of(node.velour.measurement)
        self._slot = SlotTarget.asked(context, self)
        self._subject = chosen.material.name if chosen.material else measured.btf_name(chosen.path)
        self._path = measured.btf_file(chosen.path)
        self._asked_for = self._asked(chosen.settings)
        self._threads = context.scene.render.threads
        self._job = self._reading = ReadJob(
            functools.partial(_read, chosen.loading(), _held_out_of(chosen.tile))
        )

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        btf, info, held_out = self._reading.result()
        self._reading = None
        with btf, held_out or contextlib.nullcontext():
            self._digest = info["sha256"]
            options = options_of(self._asked_for)
            checkpoint = self._checkpoint = _checkpoint(self._digest, options)
            # The time of a resumed fit would be too short.
            self._fit = None if os.path.exists(checkpoint) else fit_of(info, options, self._threads)
            self._next = compress_job(
                btf,
                threads=self._threads,
                checkpoint=checkpoint,
                resume=1,
                **options,
                **({"held_out": held_out} if held_out else {}),
            )
        return None

    def _refitted(self, context):
        return super()._refitted(context) if self.material else None

    def _remember(self, material):
        """Stores the material for the tile's panel."""
        owner = self._owner.take() if self._owner else None
        if owner is not None:
            owner.velour.material = material

    def _put(self):
        if self._fit is not None:
            remember(Path(cache_folder()), self._fit, self._seconds)
        material, node = self._put_anew() if self._target else self._put_new()
        if material is not None:
            Path(self._checkpoint).unlink(missing_ok=True)
            self._say_what_it_is(material)
        return material, node

    def _put_anew(self):
        """Puts the refitted model; returns the material and its node, or (None, None) if they are gone."""
        material, node = measured.put_model(self._data, self._target, self.report, self.users)
        if node is not None:
            measured.after_fit(material, node, self._read_file, self._digest, self.report)
        return material, node

    def _put_new(self):
        material = measured.new_material(self._subject)
        node = measured.ensure_node(material)
        node.image = measured.packed_model(self._data, self._subject)
        node.velour.measurement = measured.measurement_image(self._path, self._digest)
        keep(self._asked_for, node.velour.btf)
        self._remember(material)
        if self._slot:
            self._slot.put(material, self.report)
        else:
            material.use_fake_user = True
        return material, node

    def _say_what_it_is(self, material):
        report = self._report
        for sentence in sentences(report["warning_codes"]):
            self.report({"WARNING"}, sentence)
        unseen = report["psnr_held_out"]
        self.report(
            {"INFO"},
            f"Material '{material.name}': {data_size(len(self._data))}, 1:{report['ratio']:.0f},"
            f" {report['psnr']:.1f} dB, error {report['relative_l2']:.3f}"
            + ("." if unseen is None else f"; {unseen:.1f} dB for held-out pairs."),
        )


def _read(load, held_out):
    """Runs on the job's thread: the BTF, its info, and the held-out BTF or None."""
    btf = load()
    check()
    return btf, btf.info(), held_out and Btf.load(held_out)


def _held_out_of(tile):
    """Folder of held-out pairs captured beside the tile's BTF, or None. For a BTF without its tile, it is
    unknown whether the folder beside it is from the same capture."""
    if tile is None or not tile.owner.velour.held_out:
        return None
    folder = held_out_folder(tile)
    return folder if os.path.isdir(folder) else None


def _checkpoint(digest, asked):
    """Checkpoint in this session's folder: a canceled fit resumes when the same one is started again."""
    name = hashlib.sha256(repr((digest, asked)).encode()).hexdigest()
    return os.path.join(bpy.app.tempdir, f"velour-fit-{name[:32]}")
