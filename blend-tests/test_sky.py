"""Sky Textures are rendered by a Blender of their own, once."""

import math
import threading
from unittest import mock

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest


class Sky(BlenderTest):
    def setUp(self):
        super().setUp()
        self.sky = inputs.module("export.world.sky")
        self._use(mock.patch.object(self.sky, "cache_folder", return_value=str(self.folder)))
        tree = scenes.set_world().node_tree
        self.node = tree.nodes.new("ShaderNodeTexSky")
        self.background = tree.nodes["Background"]
        tree.links.new(self.node.outputs[0], self.background.inputs["Color"])

    def _use(self, patch):
        self.addCleanup(patch.stop)
        return patch.start()

    def _write(self, path, _values, sun=(0.0, 0.0, 0.0)):
        """In place of Blender: a sky that is red in the north, at the middle of the right half."""
        pixels = np.full((8, 16, 3), 0.1, np.float16)
        pixels[:, 3:5, 0] = 1.0
        with open(path, "wb") as file:
            np.savez(file, sky=pixels, sun=np.array(sun))

    def test_a_turn_needs_no_other_picture(self):
        started = self._use(mock.patch.object(self.sky, "_start_blender", side_effect=self._write))
        for turn in (0.0, 1.0):
            self.node.sun_rotation = turn
            self.assertEqual(self.sky.sky_of(self.node, True).turn, np.float32(turn))
        self.assertEqual(started.call_count, 1)
        self.node.sun_elevation = 0.3
        self.sky.sky_of(self.node, True)
        self.assertEqual(started.call_count, 2)

    def test_it_turns_as_the_sun_does(self):
        """From the north, which is +y, towards +x."""
        self._use(mock.patch.object(self.sky, "_start_blender", side_effect=self._write))
        scenes.use_engine(samples=1, size=32)
        camera = scenes.add_camera()
        camera.data.type, camera.data.angle = "PERSP", 0.1
        camera.rotation_euler = math.pi / 2, 0, -1.0
        seen = []
        for self.node.sun_rotation in (0.0, 1.0):
            seen.append(scenes.render(self.folder)[..., 0].mean())
        self.assert_close(seen[0], 0.1, 0.01)
        self.assertGreater(seen[1], 0.5)

    def test_what_cannot_be_rendered_is_told(self):
        failed = OSError("no Cycles")
        self._use(mock.patch.object(self.sky, "_start_blender", side_effect=failed))
        notes = inputs.module("export").Notes()
        light = mock.Mock(waits=True)
        inputs.module("export.world").add_world(light, bpy.context.scene.world, 1, notes)
        self.assertIn("Blender cannot render 'Sky Texture': no Cycles", "".join(notes))
        self.assertFalse(list(self.folder.glob("sky-texture*")))

    def test_a_viewport_does_not_wait(self):
        go_on = threading.Event()

        def start(*arguments):
            go_on.wait(10)
            self._write(*arguments)

        self._use(mock.patch.object(self.sky, "_start_blender", side_effect=start))
        for _ in range(2):
            with self.assertRaises(self.sky.PendingError):
                self.sky.sky_of(self.node, False)
        go_on.set()
        (thread,) = self.sky._rendering.values()
        thread.join()
        (path,) = self.sky._rendering
        self.assertIsNone(self.sky._announce(path))
        self.assertEqual(self.sky.sky_of(self.node, False).picture.path, str(path))

    def test_blender_renders_it(self):
        self.node.sun_elevation, self.node.sun_rotation = 0.5, 0.0
        found = self.sky.sky_of(self.node, True)
        pixels = found.picture.pixels()
        height, width, _channels = pixels.shape
        self.assertGreater(pixels[height // 2 :].mean(), 5 * pixels[: height // 4].mean())
        column = pixels.sum(axis=(0, 2)).argmax()  # the brightest
        self.assert_close(2 * math.pi * (0.5 - (column + 0.5) / width), math.pi / 2, 0.1)
        self.assertGreater(min(found.sun.radiance), 1e5)
