"""Image datablocks that stand for files: models and measurements.

Packed bytes come from memory; linked paths are resolved against the library they are linked from.
"""

import contextlib
import os
import tempfile
from typing import NamedTuple

import bpy

from ..core.files import read_bytes
from ..core.files import sha256_of as sha256
from ..core.measurement_files import INDICES
from ..native import Btf, Measurement, Model, VelourError, library, measurement_job
from .notes import ExportError

FIND = "put it back, or use File > External Data > Find Missing Files"


def absolute_path(image):
    """Absolute path of an image datablock's file; "" if it has none."""
    path = image.filepath
    return os.path.normpath(bpy.path.abspath(path, library=image.library)) if path else ""


def packed_bytes(image):
    """The bytes packed into the .blend, or None: also of the index of a BTF, which is a folder.

    File > External Data > Pack Resources packs such an index alone.
    """
    packed = image.packed_file
    if packed is None or os.path.basename(absolute_path(image)) in INDICES:
        return None
    return packed.data


class ChangedFileError(ExportError):
    """The file has changed since it was chosen; the user can accept it."""


class StoredFile(NamedTuple):
    """File of an image datablock. Any thread may read it, even after undo has replaced the datablock."""

    owner: str  # start of error messages
    name: str  # name of the image
    path: str
    packed: bytes | None
    expected: str  # SHA-256 of the file that was loaded or fitted; "": accept any content

    @classmethod
    def of(cls, image, owner):
        return cls(owner, image.name, absolute_path(image), packed_bytes(image), image.velour.sha256)

    def content(self):
        """The file's bytes."""
        if self.packed is not None:
            return self.packed
        try:
            return read_bytes(self.path)
        except OSError as error:
            named = repr(self.path or self.name)
            raise ExportError(
                f"{self.owner}: the file {named} cannot be read ({error.strerror}); {FIND}."
            ) from error

    def model_and_digest(self):
        """The model and the file's SHA-256; raises ChangedFileError if that is not the expected one."""
        data = self.content()
        digest = sha256(data)
        self.refuse_other(digest)
        try:
            return Model.from_bytes(data, self.name), digest
        except VelourError as error:
            raise ExportError(f"{self.owner}: {error}") from error

    def model(self):
        return self.model_and_digest()[0]

    def model_info(self):
        """The model's info for panels, with the SHA-256 of its file as "file_sha256"."""
        model, digest = self.model_and_digest()
        with model:
            return {**model.info(), "file_sha256": digest}

    @property
    def named(self):
        return self.path or repr(self.name)

    @contextlib.contextmanager
    def readable_path(self):
        """An existing path of the file; packed bytes are written to a temporary file first."""
        if self.packed is None:
            if not os.path.exists(self.path):  # some BTFs are folders
                raise ExportError(f"{self.owner}: the measurement {self.named} is missing; {FIND}.")
            yield self.path
            return
        with tempfile.TemporaryDirectory(prefix="velour-") as folder:
            path = os.path.join(folder, os.path.basename(self.path) or "measurement")
            with open(path, "wb") as file:
                file.write(self.packed)
            yield path

    def raw_info(self):
        """The library's info on the measurement or BTF; "kind" tells which it is."""
        try:
            with self.readable_path() as path:
                return library.file_info(path)
        except VelourError as error:
            raise ExportError(f"{self.owner}: {error}") from error

    def chosen_raw_info(self):
        """Like raw_info(); raises ChangedFileError if the content is not the expected one."""
        info = self.raw_info()
        self.refuse_other(info["sha256"])
        return info

    def raw(self, kind):
        """Loads the file as `kind`, Measurement or Btf; raises ChangedFileError if it has changed."""
        try:
            with self.readable_path() as path:
                raw = kind.load(path)
            self.refuse_other(raw.info()["sha256"])
        except VelourError as error:
            raise ExportError(f"{self.owner}: {error}") from error
        return raw

    def refuse_other(self, digest):
        if self.expected and digest != self.expected:
            raise ChangedFileError(
                f"{self.owner}: the file {self.named} has changed since it was chosen;"
                " restore it, or accept it with 'Accept Changed File' in the Material tab."
            )


def content(image, owner):
    """The bytes of the file that `image` stands for. `owner` starts error messages."""
    return StoredFile.of(image, owner).content()


def file_stamp(path):
    """A value that differs for another file or changed content; None if there is no file."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return path, found.st_mtime_ns, found.st_size


def stamp_of(image):
    """A value that differs when the file that `image` (or None) stands for may have changed."""
    if image is None:
        return None
    packed = image.packed_file
    content = packed.size if packed else file_stamp(absolute_path(image))
    digest = image.velour.sha256 or (packed and sha256(packed.data))
    return image.original.as_pointer(), content, digest


def is_there(image):
    """Whether the file that `image` (or None) stands for exists."""
    return image is not None and (image.packed_file is not None or os.path.exists(absolute_path(image)))


def read_model(image, owner):
    """The model in `image`; raises ChangedFileError if the file changed since it was loaded or fitted."""
    return StoredFile.of(image, owner).model()


def read_measurement(image, owner):
    """Like read_model(), for raw BRDF measurements."""
    return StoredFile.of(image, owner).raw(Measurement)


def read_btf(image, owner):
    """Like read_model(), for captured and measured BTFs."""
    return StoredFile.of(image, owner).raw(Btf)


class MeasurementReading:
    """Job with the interface of Job that reads like read_measurement().

    wait() raises only on cancellation; result() raises errors of the file. `may_differ`: accept content that
    has changed since it was chosen.
    """

    def __init__(self, image, owner, may_differ=False):
        self._stored, self._error = StoredFile.of(image, owner), None
        if may_differ:
            self._stored = self._stored._replace(expected="")
        with contextlib.ExitStack() as until_read:
            path = until_read.enter_context(self._stored.readable_path())
            self._stored = self._stored._replace(packed=None)  # the bytes are in a file now
            self._job = measurement_job(path)
            self._opened = until_read.pop_all()

    def start(self):
        self._job.start()
        return self

    def poll(self):
        return self._job.poll()

    def cancel(self):
        self._job.cancel()

    def wait(self, progress=None, timeout=None):
        """Like Job.wait()."""
        try:
            return self._job.wait(progress, timeout)
        except VelourError as error:
            if error.cancelled:
                raise
            self._error = error
            return True

    def result(self):
        """The measurement, once the job has ended."""
        if self._error is not None:
            raise ExportError(f"{self._stored.owner}: {self._error}") from self._error
        measurement = self._job.result_measurement()
        self._stored.refuse_other(measurement.info()["sha256"])
        return measurement

    def close(self):
        self._job.close()
        self._opened.close()

    def __enter__(self):
        return self

    def __exit__(self, *_exception):
        self.close()


def measurement_info(image, owner):
    """StoredFile.raw_info() of `image`."""
    return StoredFile.of(image, owner).raw_info()
