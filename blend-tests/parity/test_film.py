"""The film: what part of it is rendered, how bright, and what is behind everything."""

import math

import bpy

from parity import engines, stage
from parity.case import ParityTest, TownTest


class Border(TownTest):
    def setUp(self):
        super().setUp()
        render = self.scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x = 0.206, 0.754  # no whole pixels
        render.border_min_y, render.border_max_y = 0.104, 0.857

    def test_whole_film(self):
        self.assert_parity("Render border without crop")

    def test_crop(self):
        self.scene.render.use_crop_to_border = True
        self.assert_parity("Render border with crop")

    def test_border_at_whole_pixels(self):
        """5/6 of 96 pixels are 80, though the nearest float is less: no row is left empty."""
        engines.set_size(engines.WHOLE)
        render = self.scene.render
        render.use_crop_to_border, render.border_max_y = True, 5 / 6
        self.assertLess(render.border_max_y * 96, 80)
        render.film_transparent = False
        for engine in ("CYCLES", "VELOUR"):
            picture = self.pictures(engine)[0]
            self.assertEqual(picture.shape[0], 80 - 9, engine)
            self.assertEqual(picture[..., 3].min(), 1.0, engine)

    def test_percentage(self):
        self.scene.render.resolution_percentage = 87
        self.scene.render.use_crop_to_border = True
        self.assert_parity("Render border at a resolution percentage")


class Film(ParityTest):
    def setUp(self):
        super().setUp()
        stage.sphere()
        stage.sharp_sun()
        stage.world((0.2, 0.3, 0.4))
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))

    def test_opaque(self):
        self.assert_parity("Film: background")

    def test_transparent(self):
        self.scene.render.film_transparent = True
        self.assert_parity("Film: transparent")

    def test_without_sky(self):
        self.scene.view_layers[0].use_sky = False
        self.assert_parity("View layer: without sky")

    def test_world_of_the_layer(self):
        layer = self.scene.view_layers[0]
        if not hasattr(layer, "world_override"):
            self.skipTest("view layers have no world of their own before Blender 4.3")
        layer.world_override = stage.world((0.9, 0.2, 0.1), 0.5)
        self.scene.world = bpy.data.worlds["World"]
        self.assertNotEqual(layer.world_override, self.scene.world)
        self.assert_parity("View layer: world override")

    def test_exposure(self):
        self.scene.cycles.film_exposure = 1.7
        self.assert_parity("Film: exposure")
