"""Image textures of ordinary materials: pixels of a plane, and what is said of nodes that are not read."""

import math
import os

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest
from support.notes import export_notes

SIDE = 8  # texels and pixels of a side


def _image(name, values, is_float=True, space=None):
    """[height x width x 4] in a new image of Blender's; row 0 at the bottom."""
    height, width = values.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    if space:
        image.colorspace_settings.name = space  # forgets the pixels
    image.pixels.foreach_set(np.ascontiguousarray(values, np.float32).ravel())
    image.update()
    return image


def _colors():
    rows, columns = np.mgrid[0:SIDE, 0:SIDE]
    values = np.ones((SIDE, SIDE, 4), np.float32)
    values[..., 0], values[..., 1], values[..., 2] = columns / SIDE, rows / SIDE, 0.25
    return values


class Textures(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64, size=SIDE).velour.strategy = "COSINE"  # without noise here
        scenes.add_camera(ortho_scale=2.0)  # all of the plane: a texel a pixel
        scenes.set_world()

    def _plane(self, image, shader="ShaderNodeBsdfDiffuse", socket="Color", **settings):
        """A plane whose texture coordinates go from corner to corner."""
        material = bpy.data.materials.new("Cloth")
        material.use_nodes = True
        tree = material.node_tree
        node = tree.nodes.new(shader)
        self.texture = tree.nodes.new("ShaderNodeTexImage")
        self.texture.image = image
        self.texture.interpolation = "Closest"
        for name, value in settings.items():
            setattr(self.texture, name, value)
        tree.links.new(self.texture.outputs["Color"], node.inputs[socket])
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.add_plane(material)
        self.tree, self.shader = tree, node
        return material

    def _mapping(self, **inputs_of_node):
        mapping, coordinates = (
            self.tree.nodes.new(name) for name in ("ShaderNodeMapping", "ShaderNodeTexCoord")
        )
        for name, value in inputs_of_node.items():
            mapping.inputs[name].default_value = value
        self.tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        self.tree.links.new(mapping.outputs[0], self.texture.inputs["Vector"])
        return mapping

    def _rendered(self):
        return scenes.render(self.folder)[..., :3]

    def test_a_plane_shows_its_picture(self):
        self._plane(_image("float", _colors()))
        self.assertEqual(export_notes(), [])
        np.testing.assert_allclose(self._rendered(), _colors()[..., :3], atol=2e-3)

    def test_byte_images_are_decoded(self):
        values = np.full((SIDE, SIDE, 4), 1.0, np.float32)
        values[..., :3] = 0.5
        self._plane(_image("bytes", values, is_float=False))
        np.testing.assert_allclose(self._rendered(), ((0.5 + 0.055) / 1.055) ** 2.4, atol=3e-3)

    def test_data_images_are_not(self):
        values = np.full((SIDE, SIDE, 4), 1.0, np.float32)
        values[..., :3] = 0.5
        self._plane(_image("data", values, is_float=False, space="Non-Color"))
        np.testing.assert_allclose(self._rendered(), 0.5, atol=3e-3)

    def test_packed_and_file_images(self):
        native = inputs.module("native")
        path = self.folder / "stored.exr"
        native.images.write(path, _colors())
        for packed in (False, True):
            with self.subTest(packed=packed):
                loaded = bpy.data.images.load(str(path), check_existing=False)
                if packed:
                    loaded.pack()
                self._plane(loaded)
                np.testing.assert_allclose(self._rendered(), _colors()[..., :3], atol=3e-3)

    def test_channels_in_small_letters_and_further_ones(self):
        """Blender itself shows the first file black and the second not at all; Cycles shows both."""
        native, colors = inputs.native(), _colors()
        small = self.folder / "small.exr"
        native.images.write(small, colors[..., :3].copy())
        data = small.read_bytes()
        begin = data.index(b"chlist\0")
        end = data.index(b"compression\0")
        head = data[begin:end]
        for name in (b"R", b"G", b"B"):
            head = head.replace(name + b"\0\2", name.lower() + b"\0\2")  # a float's
        small.write_bytes(data[:begin] + head + data[end:])
        self.assertEqual(native.images.header(small)["channels"], ["b", "g", "r"])
        more = self.folder / "more.exr"
        native.images.write(more, np.concatenate([colors, colors[..., :1]], axis=2))
        for path, notes in ((small, 0), (more, 1)):
            with self.subTest(path.name):
                self._plane(bpy.data.images.load(str(path)))
                found = export_notes()
                self.assertEqual(len(found), notes, found)
                self.assertTrue(all("channel004" in note and "more.exr" in note for note in found), found)
                np.testing.assert_allclose(self._rendered(), colors[..., :3], atol=3e-3)

    def test_a_header_that_says_otherwise_is_told(self):
        """Cycles shows the rows of a Radiance file as they are stored, and so does Velour, aloud."""
        path = self.folder / "turned.hdr"
        top = bytes((128, 64, 32, 128)) * SIDE * (SIDE // 2)
        path.write_bytes(
            b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n+Y %d +X %d\n" % (SIDE, SIDE)
            + top
            + bytes((32, 64, 128, 128)) * SIDE * (SIDE // 2)
        )
        self._plane(bpy.data.images.load(str(path)))
        found = export_notes()
        self.assertEqual(len(found), 2, found)
        self.assertTrue("flipped vertically" in found[0] and "exposure" in found[1], found)
        np.testing.assert_allclose(self._rendered()[-1, 0], (0.5, 0.25, 0.125), atol=3e-3)
        np.testing.assert_allclose(self._rendered()[0, 0], (0.125, 0.25, 0.5), atol=3e-3)

    def test_values_that_are_not_finite_are_counted(self):
        pixels = _colors()[..., :3].copy()
        pixels[0, 0], pixels[1, 1, 0] = np.inf, np.nan
        path = self.folder / "faults.exr"
        inputs.native().images.write(path, pixels)
        self._plane(bpy.data.images.load(str(path)))
        found = export_notes()
        self.assertEqual(len(found), 2, found)
        self.assertIn("3 values are infinite", found[0])
        self.assertIn("1 values are not numbers", found[1])

    def test_a_pipe_is_refused(self):
        """Blender itself would wait for a writer."""
        path = self.folder / "pipe.png"
        os.mkfifo(path)
        image = _image("pipe", _colors())
        image.source, image.filepath = "FILE", str(path)
        self._plane(image)
        found = export_notes()
        self.assertEqual(len(found), 1, found)
        self.assertIn("is not a regular file; choose a file", found[0])

    def test_mapping(self):
        self._plane(_image("mapped", _colors()))
        mapping = self._mapping(
            Location=(0.25, 0.0, 0.0), Rotation=(0.0, 0.0, math.pi / 2), Scale=(1.0, -1.0, 1.0)
        )
        # (u, v) to (u, -v), turned to (v, u), moved to (v + 1/4, u).
        expected = np.roll(_colors()[..., :3].transpose(1, 0, 2), -SIDE // 4, axis=0)
        np.testing.assert_allclose(self._rendered(), expected, atol=2e-3)
        mapping.vector_type = "TEXTURE"  # the inverse: (u', v') = (v, u - 1/4)
        expected = np.roll(_colors()[..., :3].transpose(1, 0, 2), SIDE // 4, axis=1)
        np.testing.assert_allclose(self._rendered(), expected, atol=2e-3)

    def test_far_checkers_are_gray(self):
        rows, columns = np.mgrid[0:64, 0:64]
        values = np.ones((64, 64, 4), np.float32)
        values[..., :3] = ((rows + columns) % 2)[..., None]
        bpy.context.scene.velour.samples = 8
        self._plane(_image("checker", values), interpolation="Linear")
        self._mapping(Scale=(4.0, 4.0, 4.0))
        np.testing.assert_allclose(self._rendered(), 0.5, atol=0.01)

    def test_roughness_and_metallic_come_from_pictures(self):
        """A mirror to the left, a rough metal to the right, under a lamp that only roughness shows."""
        values = np.ones((SIDE, SIDE, 4), np.float32)
        values[:, : SIDE // 2, :3] = 0.05
        self._plane(_image("roughness", values, space="Non-Color"), "ShaderNodeBsdfPrincipled", "Roughness")
        self.shader.inputs["Metallic"].default_value = 1.0
        scenes.set_world((0, 0, 0))
        bpy.context.scene.velour.strategy = "MIS"
        lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        lamp.rotation_euler = (0.7, 0.0, 0.0)
        lamp.data.energy = 3.0
        bpy.context.scene.collection.objects.link(lamp)
        pixels = self._rendered().mean(axis=(0, 2))
        self.assertLess(pixels[: SIDE // 2 - 1].max(), 0.05 * pixels[SIDE // 2 + 1 :].min())

    def test_alpha_cuts_out(self):
        values = np.ones((SIDE, SIDE, 4), np.float32)
        values[: SIDE // 2, :, 3] = 0.0
        self._plane(_image("mask", values), "ShaderNodeBsdfPrincipled", "Base Color")
        self.tree.links.new(self.texture.outputs["Alpha"], self.shader.inputs["Alpha"])
        bpy.context.scene.render.film_transparent = True
        alpha = scenes.render(self.folder)[..., 3]
        np.testing.assert_array_equal(alpha, values[..., 3])

    def test_other_nodes_are_named(self):
        self._plane(_image("named", _colors()))
        self.texture.projection = "BOX"
        self.assertIn("is not projected with Flat", "".join(export_notes()))
        self.texture.projection = "FLAT"
        camera = self.tree.nodes.new("ShaderNodeTexCoord")
        self.tree.links.new(camera.outputs["Camera"], self.texture.inputs["Vector"])
        self.assertIn("output 'Camera'", "".join(export_notes()))
        self.tree.links.clear()
        self.assertNotIn("Camera", "".join(export_notes()))

    def test_an_empty_node_is_named(self):
        self._plane(None)
        self.assertIn("has no image and is magenta", "".join(export_notes()))

    def test_another_uv_map_is_named(self):
        self._plane(_image("mapped", _colors()))
        node = self.tree.nodes.new("ShaderNodeUVMap")
        self.tree.links.new(node.outputs[0], self.texture.inputs["Vector"])
        node.uv_map = "UVMap"
        self.assertEqual(export_notes(), [])
        node.uv_map = "Other"
        self.assertIn("UV map 'Other'", "".join(export_notes()))
