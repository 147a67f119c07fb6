"""Environment light of a scene."""

from .files import file_stamp


class WorldLight:
    """Environment of one library scene. Reading an image takes seconds: the current one is only re-placed."""

    def __init__(self, scene):
        self._scene = scene
        self._picture = None  # key of the current image; None: a color, or an image that may change unnoticed

    def set_color(self, color):
        self._picture = None
        self._scene.set_world_color(color)

    def set_file(self, path, strength, rotation, layer=""):
        """`rotation` [3 x 3] from world directions to the image's, or None; `layer` of an OpenEXR file."""
        stamp = file_stamp(path)
        self._show(
            stamp and (stamp, layer),
            strength,
            rotation,
            lambda *placed: self._scene.set_world_file(path, *placed, layer=layer, as_stored=True),
        )

    def set_image(self, image, path, pixels, strength, rotation):
        """`pixels()`: [height x width x 3] of `image` in the working space, row 0 at the top."""
        self._show(
            _image_key(image, path),
            strength,
            rotation,
            lambda *placed: self._scene.set_world_pixels(pixels(), *placed),
        )

    def _show(self, key, strength, rotation, read):
        if key is not None and key == self._picture:
            self._scene.place_world(strength, rotation)
            return
        self._picture = None  # in case reading fails
        read(strength, rotation)
        self._picture = key


def _image_key(image, path):
    """Key of an image's content; None if its pixels were edited."""
    if image.is_dirty:
        return None
    return (
        image.as_pointer(),
        image.source,
        file_stamp(path),
        image.packed_file and image.packed_file.size,
        (image.generated_type, tuple(image.generated_color)),
        image.colorspace_settings.name,
        image.alpha_mode,
        tuple(image.size),
    )
