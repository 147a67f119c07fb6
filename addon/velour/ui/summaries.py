"""What panels show of models. Reading one takes milliseconds: once a content, never once a redraw."""

import os

from ..export import ExportError
from ..export.files import absolute_path, packed_bytes, read_model
from ..native import VelourError

_KEPT = 64
_summaries = {}  # identity: info or sentence; oldest first


def model_summary(image):
    """The model's info, or the sentence why there is none."""
    identity = _identity(image)
    if identity not in _summaries:
        while len(_summaries) >= _KEPT:
            del _summaries[next(iter(_summaries))]
        _summaries[identity] = _read(image)
    return _summaries[identity]


def _identity(image):
    """Changes whenever the content may have changed; cheap. No pointer: undo replaces datablocks."""
    path = absolute_path(image)
    if packed_bytes(image) is not None:
        return image.name, path, image.velour.sha256, image.packed_file.size
    try:
        state = os.stat(path)
        return image.name, path, image.velour.sha256, state.st_mtime_ns, state.st_size
    except OSError:
        return image.name, path, image.velour.sha256


def _read(image):
    try:
        with read_model(image, f"Model '{image.name}'") as model:
            return model.info()
    except (ExportError, VelourError) as error:
        return str(error)
