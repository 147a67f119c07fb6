"""Hashes of the files that a measured material renders from."""

from . import files


def model_hashes(node):
    """SHA-256 of the scene model of a MeasuredNode, if used, and of its model; or of the measurement used
    instead.

    Missing files are skipped; renders refuse them with a message.
    """
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
