"""Which files a measured material is rendered from, by their hashes."""

from . import files
from .nodes import velour_node


def model_hashes(material):
    """SHA-256 of its model (before that, of its model for the scene), or of the measurement in its place.

    None of a material that is not measured. What is missing is left out: renders refuse it in words.
    """
    node = velour_node(material)
    if node is None:
        return None
    settings = node.velour
    if settings.use_reference:
        return _hashes(settings.measurement, computed=_measurement_hash)
    reduced = settings.scene_model if settings.use_scene_model else None
    return _hashes(reduced, node.image, computed=_model_hash)


def _hashes(*images, computed):
    # Renders refuse a file that is another one than when it was chosen.
    return [image.velour.sha256 or computed(image) for image in images if files.is_there(image)]


def _model_hash(image):
    return files.sha256(files.content(image, image.name))


def _measurement_hash(image):
    return files.measurement_info(image, image.name)["sha256"]
