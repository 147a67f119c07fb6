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
from ..native import Btf, Measurement, Model, VelourError, library, measurement_job
from .notes import ExportError

FIND = "put it back, or use File > External Data > Find Missing Files"


def absolute_path(image):
    """The file that an image datablock names, in the reader's file system; "" where it names none."""
    path = image.filepath
    return os.path.normpath(bpy.path.abspath(path, library=image.library)) if path else ""


def packed_bytes(image):
    """The bytes packed into the .blend, or None."""
    packed = image.packed_file
    return packed.data if packed is not None else None


class ChangedFileError(ExportError):
    """The file is another one than that which was chosen, and can be accepted."""


class StoredFile(NamedTuple):
    """What is to be read of an image datablock, which undo may replace meanwhile: any thread may read it."""

    owner: str  # begins the sentence when it cannot be had
    name: str  # of the image
    path: str
    packed: bytes | None
    expected: str  # the SHA-256 of what was loaded or fitted; "" where any content will do

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
        """The model in it, and the file's SHA-256; refuses a content that is not the expected one."""
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
        """What panels show of that model; and the SHA-256 of its file, as "file_sha256"."""
        model, digest = self.model_and_digest()
        with model:
            return {**model.info(), "file_sha256": digest}

    @property
    def named(self):
        return self.path or repr(self.name)

    @contextlib.contextmanager
    def readable_path(self):
        """A path of it, which exists; packed bytes are written to a temporary file first."""
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
        """What the library knows of the measurement or BTF in it; its "kind" says which it is."""
        try:
            with self.readable_path() as path:
                return library.file_info(path)
        except VelourError as error:
            raise ExportError(f"{self.owner}: {error}") from error

    def chosen_raw_info(self):
        """As raw_info(); refuses a content that is not the expected one."""
        info = self.raw_info()
        self.refuse_other(info["sha256"])
        return info

    def raw(self, kind):
        """The Measurement or the Btf (`kind`) in it; refuses a content that is not the expected one."""
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
    """The bytes of the file that `image` stands for. `owner` begins the sentence when they cannot be had."""
    return StoredFile.of(image, owner).content()


def file_stamp(path):
    """Another one for another file, or another content; None: there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return path, found.st_mtime_ns, found.st_size


def stamp_of(image):
    """Of what `image` (or None) stands for: another one where that may be something else."""
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
    """The model in `image`; refuses one that is not the file it was when it was loaded or fitted."""
    return StoredFile.of(image, owner).model()


def read_measurement(image, owner):
    """As read_model, for raw measurements of BRDFs."""
    return StoredFile.of(image, owner).raw(Measurement)


def read_btf(image, owner):
    """As read_model, for captured and measured BTFs."""
    return StoredFile.of(image, owner).raw(Btf)


class MeasurementReading:
    """A job, to be used as one, that reads what read_measurement() does.

    Waiting for it raises nothing but a cancel: what is wrong with the file is said by result(). `may_differ`:
    whether another content will do than that which was chosen.
    """

    def __init__(self, image, owner, may_differ=False):
        self._stored, self._error = StoredFile.of(image, owner), None
        if may_differ:
            self._stored = self._stored._replace(expected="")
        with contextlib.ExitStack() as until_read:
            path = until_read.enter_context(self._stored.readable_path())
            self._stored = self._stored._replace(packed=None)  # they are in a file now
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
        """As Job.wait()."""
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
    """As StoredFile.raw_info()."""
    return StoredFile.of(image, owner).raw_info()
