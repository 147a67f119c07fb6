"""Nodes of a world, as a program that computes its radiance in each direction."""

import math
from typing import NamedTuple

import numpy as np

from ..color import rec709_to_working
from ..image_nodes import UnsupportedError, maps_coordinates
from ..picture_files import size_of
from ..programs import Draft, ImageNumber
from ..programs.coordinate_nodes import mapped, position
from ..programs.image_nodes import place_on_sphere
from ..shaders.emission import radiance_of
from ..shaders.values import Reader
from .sky import SkyPicture, sky_of

_LEAST_WIDTH, _MOST_WIDTH = 2048, 16384  # texels of the image that lights the scene


class Emitted(NamedTuple):
    """Radiance of a world: an output of a draft. Its suns are seen by camera rays and shadow rays alone."""

    draft: Draft
    output: int
    suns: list  # Suns of Sky Textures

    @property
    def constant(self):
        """The color if nothing has to be evaluated, else None."""
        value = self.draft.outputs[self.output][0]
        return None if value.first >= 0 else self.draft.constants_of(value)

    @property
    def size(self):
        """Width and height in texels: those of the largest picture."""
        choices = [choice for step in self.draft.steps for choice in step.choices]
        images = [choice.picture.image for choice in choices if isinstance(choice, ImageNumber)]
        widths = [size_of(image)[0] for image in images if image]
        width = int(np.clip(max(widths, default=0), _LEAST_WIDTH, _MOST_WIDTH))
        return width, width // 2


def emitted(plug, owner, notes, waits):
    """The Emitted of the shader at an output; notes what is left out. `waits`: see sky_of()."""
    reader, suns = Reader(owner, notes), []
    reader.compiler.is_world = True
    reader.compiler.more_nodes = {"ShaderNodeTexSky": lambda c, sky: _sky(c, sky, waits, suns)}
    draft = reader.compiler.draft
    return Emitted(draft, draft.output(radiance_of(plug, reader), "color").index, suns)


def _sky(c, plug, waits, suns):
    """A Sky Texture. The disk of its sun is left out where its coordinates are not the direction."""
    if plug.socket.type != "RGBA":
        raise UnsupportedError(f"output '{plug.socket.name}' of '{plug.node.name}' is not supported")
    sky, draft = sky_of(plug.node, waits), c.draft
    vector = c.linked(plug.input("Vector")) if plug.input("Vector") else None
    if vector is not None or maps_coordinates(plug.node):
        vector = mapped(c, plug.node, vector or position(c))
    u, v = map(place_on_sphere(draft, vector or position(c)).component, range(2))
    place = draft.joined(draft.math("add", u, -sky.turn / (2 * math.pi)), v, draft.number(0.0))
    color = draft.one("image", (place,), 3, (ImageNumber(sky.picture, True),))
    if sky.sun is None:
        return color
    if vector is not None:
        c.reader.note(plug, "the disk of its sun is left out, because its coordinates are mapped.")
        return color
    suns.append(sky.sun)
    cosine = draft.vector_math("dot_product", position(c), draft.vector(sky.sun.direction))[1]
    rays = draft.math("maximum", *(draft.source(f"{kind}_ray").component(0) for kind in ("camera", "shadow")))
    inside = draft.math("multiply", draft.math("greater_than", cosine, math.cos(sky.sun.angle / 2)), rays)
    radiance = draft.vector(rec709_to_working() @ sky.sun.radiance)
    return draft.vector_math("add", color, draft.vector_math("scale", radiance, scale=inside)[0])[0]


def sky_texture(scene, picture: SkyPicture):
    """The Texture of a SkyPicture."""
    colors = tuple(np.ravel(rec709_to_working()))
    return scene.texture(picture.pixels(), wrap="repeat", filter="linear", channel=-1, colors=colors)
