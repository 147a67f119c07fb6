"""A gray ground and what stands on it, for tests of how things come into a scene."""

import math

import bpy

from . import stage
from .case import ParityTest


class KindTest(ParityTest):
    """A gray ground under a sun and a dim sky."""

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.5)
        stage.camera((0, -7, 6), (0.8, 0, 0), 45)
        stage.sharp_sun()
        stage.world((0.3, 0.4, 0.5))

    def made(self, albedo=0.7, **settings):
        """What an operator has made, with a material."""
        obj = stage.without_terminator(bpy.context.object)
        obj.data.materials.append(stage.gray(albedo))
        for name, value in settings.items():
            setattr(obj.data, name, value)
        return obj

    def small(self):
        """A flat pyramid that is not the same from any two sides."""
        points = [(-0.2, -0.1, 0), (0.2, -0.1, 0), (0, 0.2, 0), (0.05, 0, 0.35)]
        return stage.mesh(points, [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)], stage.gray(0.8), "Small")

    def carrier(self):
        """A sheet of few vertices and faces that point everywhere, to instance on."""
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=3, size=4)
        carrier = self.made(0.6)
        for i, vertex in enumerate(carrier.data.vertices):
            vertex.co.z = 0.5 + 0.3 * math.sin(3 * i)
        return carrier
