"""Environment light of a scene."""

import math
from typing import NamedTuple

import numpy as np
from mathutils import Vector

from ..files import absolute_path, file_stamp
from ..picture_files import size_of
from ..programs import finished
from ..textures import TextureTable
from .nodes import sky_texture
from .sky import SkyPicture


class SunLight(NamedTuple):
    """A lamp in place of the disk of a sky's sun."""

    direction: tuple  # towards it
    angle: float  # diameter, radians
    irradiance: tuple  # [3], on a facing plane


class WorldLight:
    """Environment of one library scene. Reading an image takes seconds: the current one is only re-placed."""

    def __init__(self, scene, waits=True):
        """`waits` until a sky is rendered; else it is shown when the world is set again."""
        self.waits = waits
        self._scene = scene
        self._hidden = ()
        self.is_even = True  # a color
        self.suns = []  # SunLights of the sky
        self._picture = None  # key of the current image; None: a color, or an image that may change unnoticed
        self._textures = {}  # of the nodes, by image and use

    def set_color(self, color):
        self._picture, self.suns, self.is_even = None, [], True
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

    def set_nodes(self, emitted, owner, notes):
        """An Emitted, whose textures are kept until others are set."""
        former, self._textures = self._textures, {}

        def texture(picture, is_color):
            if isinstance(picture, SkyPicture):
                self._textures[picture] = former.get(picture) or sky_texture(self._scene, picture)
                return self._textures[picture]
            key = picture.image and _image_key(picture.image, absolute_path(picture.image))
            key = key and (key, picture._replace(image=None, uv_map=None), is_color)
            found = former.get(key) or TextureTable(self._scene, notes).texture(picture, is_color, owner)
            if key:
                self._textures[key] = found
            return found

        self._picture, self.is_even = None, False
        program = finished(emitted.draft, None, (), texture)
        self._scene.set_world_program(program, emitted.output, *emitted.size)
        self.suns = [_sun_light(program, emitted.output, sun) for sun in emitted.suns]

    def hide(self, rays):
        """Rays that neither it nor its suns light: names of `hidden` in Scene.hide_world."""
        self._hidden = rays
        self._scene.hide_world(rays)

    def add_suns(self):
        """Adds the suns to the scene's lights."""
        for sun in self.suns:
            matrix = np.column_stack((Vector(sun.direction).to_track_quat("Z", "Y").to_matrix(), np.zeros(3)))
            self._scene.add_light(
                "sun", sun.irradiance, matrix.astype(np.float32), hidden=self._hidden, angle=sun.angle
            )

    def _show(self, key, strength, rotation, read):
        self.suns, self.is_even = [], False
        if key is not None and key == self._picture:
            self._scene.place_world(strength, rotation)
            return
        self._picture = None  # in case reading fails
        read(strength, rotation)
        self._picture = key


def _sun_light(program, output, sun):
    """The SunLight of a Sun: what shadow rays see of the disk through the world's nodes."""
    direction = np.array([sun.direction], np.float32)
    disk, around = (program.radiance(output, rays, direction)[0] for rays in ("shadow", "others"))
    irradiance = (disk - around) * math.pi * math.sin(sun.angle / 2) ** 2
    return SunLight(sun.direction, sun.angle, tuple(map(float, np.maximum(irradiance, 0))))


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
        size_of(image),
    )
