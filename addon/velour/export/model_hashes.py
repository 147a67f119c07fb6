"""Hashes of the files that a measured material renders from."""

from . import files
from .notes import ExportError, Notes
from .shaders import surface_layers


def model_hashes(material):
    """hashes_of() the measured nodes of a material's surface; None if it has none."""
    nodes = _nodes(material)
    return hashes_of(nodes) if nodes else None


def unreadable_models(material):
    """A sentence for each model or measurement of a material's surface that is missing or has changed."""
    sentences = []
    for node in _nodes(material):
        try:
            _try_to_read(node.velour, node.image, f"Material '{material.name}'")
        except ExportError as error:
            sentences.append(str(error))
    return sentences


def _try_to_read(settings, model, owner):
    """Raises ExportError. A measurement may be large, so only its existence is checked."""
    image = settings.measurement if settings.use_reference else model
    if image is None:
        return
    stored = files.StoredFile.of(image, owner)
    if not settings.use_reference:
        stored.model_info()
    elif stored.packed is None:
        with stored.readable_path():
            pass


def _nodes(material):
    return [layer.measured.node for layer in surface_layers(material, Notes()) if layer.measured]


def hashes_of(nodes):
    """SHA-256 of the scene model of each MeasuredNode, if used, and of its model; or of the measurement used
    instead. Each once.

    Missing files are skipped; renders refuse them with a message.
    """
    return list(dict.fromkeys(digest for node in nodes for digest in _of_node(node)))


def _of_node(node):
    settings = node.velour
    if settings.use_reference:
        return _hashes(settings.measurement, computed=_measurement_hash)
    reduced = settings.scene_model if settings.use_scene_model else None
    return _hashes(reduced, node.image, computed=_model_hash)


def _hashes(*images, computed):
    # The stored hash suffices, since renders refuse a file that has changed since it was chosen.
    return [image.velour.sha256 or computed(image) for image in images if files.is_there(image)]


def _model_hash(image):
    return files.sha256(files.content(image, image.name))


def _measurement_hash(image):
    return files.measurement_info(image, image.name)["sha256"]
