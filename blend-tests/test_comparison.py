"""A material beside its measurement, and as an asset: pictures of a ball."""

import contextlib
import gc
import io
import threading
from unittest import mock

import bpy
import numpy as np
from velour.operators.compare import find_comparison

from support import inputs, scenes
from support.blender import BlenderTest

_SIDE = 64
_CAPTION_ROWS = 30  # three lines of the smallest text


class BallTest(BlenderTest):
    def _material(self, measurement, model=None, name="Paint"):
        """A material of that measurement, with a quick fit to it or to another measurement, `model`."""
        bpy.ops.velour.load_material(filepath=str(measurement), assign=False)
        (material,) = (m for m in bpy.data.materials if scenes.velour_node(m).velour.measurement)
        material.name = name
        node = scenes.velour_node(material)
        other = scenes.measured_material(inputs.model_bytes(model or measurement), name="Other")
        node.image = scenes.velour_node(other).image
        return material

    def _said(self, operator, **values):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertEqual(operator(**values), {"FINISHED"})
        return said.getvalue()

    def _refused(self, words, operator, **values):
        with self.assertRaises(RuntimeError) as caught:
            operator(**values)
        self.assertIn(words, str(caught.exception))


class Compare(BallTest):
    def _tiles(self, image):
        """The tiles above their captions: [rows x side x 3] each, row 0 at the bottom."""
        captions, tiles = np.split(self._pixels(image), [_CAPTION_ROWS])
        for caption in np.split(captions, 3, axis=1):
            self.assertGreater(caption[_CAPTION_ROWS // 3 : -_CAPTION_ROWS // 3, : _SIDE // 2].max(), 0.5)
        return np.split(tiles, 3, axis=1)

    def _pixels(self, image):
        self.assertEqual(tuple(image.size), (3 * _SIDE, _SIDE))
        pixels = np.empty(3 * _SIDE * _SIDE * 4, np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(_SIDE, 3 * _SIDE, 4)[..., :3]

    def _compared(self, material, **options):
        self._said(bpy.ops.velour.compare, material=material.name, side=_SIDE, samples=64, **options)
        return bpy.data.images[f"{material.name} compared"]

    @staticmethod
    def _off(measured, model):
        return np.linalg.norm(model - measured) / np.linalg.norm(measured)

    def test_a_fit_is_like_its_measurement(self):
        material = self._material(inputs.glossy_measurement())
        image = self._compared(material)
        self.assertTrue(image.is_float)
        self.assertTrue(image.use_view_as_render)
        self.assertTrue(image.packed_file)
        measured, model, difference = self._tiles(image)
        np.testing.assert_allclose(difference, 4 * np.abs(model - measured), atol=1e-4)
        self.assertLess(self._off(measured, model), 0.15)  # of four lobes
        ball = measured[:10, _SIDE // 2 - 8 : _SIDE // 2 + 8]
        self.assertGreater(ball[..., 2].mean(), 1.3 * ball[..., 0].mean())  # its base is blue
        self.assertEqual(tuple(image.preview.image_size), (256, 256))
        preview = np.array(image.preview.image_pixels_float).reshape(256, 256, 4)
        self.assertGreater(preview[128:, :128, :3].std(), 0.05)
        again = self._compared(material, gain=1.0)
        self.assertEqual(again, image)
        self.assertLess(self._tiles(again)[2].mean(), 0.5 * difference.mean())

    def test_in_a_wide_working_space(self):
        """The balls are linear Rec. 709; pixels of the image are in Blender's space, here Rec. 2020."""
        material = self._material(inputs.glossy_measurement())
        plain = np.array(self._tiles(self._compared(material)))
        wide = np.array(((0.6274, 0.3293, 0.0433), (0.0691, 0.9195, 0.0114), (0.0164, 0.0880, 0.8956)))
        with mock.patch.object(inputs.module("export.color"), "rec709_to_working", return_value=wide):
            shown = np.array(self._tiles(self._compared(material)))
        np.testing.assert_allclose(shown, plain @ wide.T, atol=1e-4)
        self.assertGreater(np.abs(shown - plain).max(), 0.01)  # the control

    def test_it_is_of_one_model(self):
        """Whatever materials are called, and until another model is fitted."""
        material = self._material(inputs.glossy_measurement())
        node = scenes.velour_node(material)
        image = self._compared(material)
        self.assertEqual(find_comparison(node), image)
        material.name = "Renamed"
        self.assertEqual(find_comparison(node), image)
        other = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()), name="Paint")
        scenes.velour_node(other).velour.measurement = node.velour.measurement
        self.assertIsNone(find_comparison(scenes.velour_node(other)), "another material has its name now")
        node.image = scenes.velour_node(other).image
        self.assertIsNone(find_comparison(node), "another model")
        node.image, node.velour.measurement = None, None
        self.assertIsNone(find_comparison(node))

    def test_another_size_is_the_same_image(self):
        """Also where the name belongs to an image of the artist's."""
        taken = bpy.data.images.new("Paint compared", 8, 8)
        material = self._material(inputs.glossy_measurement())
        for side in (_SIDE, 2 * _SIDE, _SIDE):
            self._said(bpy.ops.velour.compare, material="Paint", side=side, samples=16)
            image = find_comparison(scenes.velour_node(material))
            self.assertEqual(tuple(image.size), (3 * side, side))
            self.assertEqual([each for each in bpy.data.images if each.velour.is_plot], [image])
        self.assertEqual(tuple(taken.size), (8, 8))
        self.assertGreater(self._tiles(image)[0].std(), 0.05)
        image.buffers_free()  # what is packed is as large
        self.assertGreater(self._tiles(image)[0].std(), 0.05)

    def test_another_model_is_not(self):
        material = self._material(inputs.glossy_measurement(), model=inputs.lambert_measurement())
        measured, model, _difference = self._tiles(self._compared(material))
        self.assertGreater(self._off(measured, model), 0.5)

    def test_a_btf(self):
        """A BTF of four quarters, whose model is exact except for rounding."""
        bpy.ops.velour.load_material(filepath=str(inputs.quarters_btf()), assign=False)
        (material,) = bpy.data.materials
        model = scenes.measured_material(inputs.quarters_model(), name="Model")
        scenes.velour_node(material).image = scenes.velour_node(model).image
        measured, model, _difference = self._tiles(self._compared(material))
        self.assertLess(self._off(measured, model), 0.05)
        self.assertGreater(measured[20:44, 20:44].std(), 0.05)

    def test_refusals(self):
        material = self._material(inputs.glossy_measurement())
        measurement = scenes.velour_node(material).velour.measurement
        measurement.filepath_raw = "//gone.binary"
        self._refused("gone.binary", bpy.ops.velour.compare, material="Paint")
        scenes.velour_node(material).velour.measurement = None
        self._refused("no measurement to compare with", bpy.ops.velour.compare, material="Paint")
        scenes.velour_node(material).image = None
        self._refused("has no model", bpy.ops.velour.compare, material="Paint")


class Asset(BallTest):
    def test_a_material_becomes_an_asset(self):
        material = self._material(inputs.glossy_measurement())
        said = self._said(
            bpy.ops.velour.mark_asset,
            material="Paint",
            author="A. Painter",
            tags="car, blue",
            license="CC0-1.0",
        )
        asset = material.asset_data
        self.assertEqual(asset.author, "A. Painter")
        self.assertEqual({tag.name for tag in asset.tags}, {"measured", "velour", "car", "blue"})
        self.assertTrue(asset.description.startswith("Measured: "))
        if hasattr(asset, "license"):
            self.assertEqual(asset.license, "CC0-1.0")
        self.assertEqual("does not store the license" in said, not hasattr(asset, "license"))
        self.assertEqual(tuple(material.preview.image_size), (256, 256))
        pixels = np.array(material.preview.image_pixels_float).reshape(256, 256, 4)
        self.assertTrue((pixels[..., 3] == 1).all())
        middle, corner = pixels[96:160, 96:160, :3].mean((0, 1)), pixels[250:, 250:, :3].mean((0, 1))
        self.assertGreater(middle[2], middle[0] + 0.05)
        self.assertLess(np.ptp(corner), 0.01)  # the backdrop is gray
        # What was given stays when more is given.
        asset.description = "Blue"
        self._said(bpy.ops.velour.mark_asset, material="Paint", tags="later")
        self.assertEqual((asset.author, asset.description), ("A. Painter", "Blue"))
        self.assertLessEqual({"car", "later"}, {tag.name for tag in asset.tags})

    def test_no_model(self):
        material = self._material(inputs.glossy_measurement())
        scenes.velour_node(material).image = None
        self._refused("has no model", bpy.ops.velour.mark_asset, material="Paint")
        self.assertIsNone(material.asset_data)


class Cancelled(BallTest):
    """Between the steps of their jobs: a thread still makes the scene with the model."""

    def _cancelled_while_a_scene_is_made(self, steps, before):
        """Whether the scene's thread came to its end; `before`: how many jobs there are before it."""
        begun, go_on, ended = threading.Event(), threading.Event(), []
        kind = inputs.native().Scene
        add = kind.add_model_material

        def blocked(*arguments):
            begun.set()
            go_on.wait(10)
            ended.append(add(*arguments))
            return ended[-1]

        for _ in range(before):
            steps.next_job().start().wait()
        with mock.patch.object(kind, "add_model_material", blocked):
            making = steps.next_job().start()
            begun.wait(10)
            making.cancel()
            making.close()
            del steps, making
            gc.collect()
            go_on.set()
            for thread in threading.enumerate():
                if thread.name == "velour-read":
                    thread.join()
        return ended == [0]

    def test_a_picture_of_an_asset(self):
        node = scenes.velour_node(self._material(inputs.glossy_measurement()))
        stored = inputs.module("export.files").StoredFile.of(node.image, "Paint")
        picture = inputs.module("operators.mark_asset")._Picture
        self.assertTrue(self._cancelled_while_a_scene_is_made(picture(stored, 1), before=1))

    def test_a_comparison(self):
        node = scenes.velour_node(self._material(inputs.glossy_measurement()))
        comparison = inputs.module("operators.comparison").Comparison
        self.assertTrue(
            self._cancelled_while_a_scene_is_made(comparison(node, "Paint", _SIDE, 4, 1), before=3)
        )
