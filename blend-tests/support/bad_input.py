"""What tests of scenes that give no picture, or a part of one, have in common."""

import re

import bpy
import numpy as np

from support import scenes
from support.blender import BlenderTest, run_blender


class BadInputTest(BlenderTest):
    """A ball under a lamp, before a black world."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=16, size=16)
        self.scene.frame_start, self.scene.frame_end = 1, 2
        self.camera = scenes.add_camera()
        self.ball = scenes.add_sphere(scenes.diffuse_material())
        scenes.set_world((0, 0, 0))
        self.lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "SUN"))
        self.scene.collection.objects.link(self.lamp)
        self.lamp.data.energy = 2.0

    def _run(self, *frames):
        path = self.folder / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        return run_blender(path, "-o", self.folder / "out_####", "-F", "OPEN_EXR", *(frames or ("-f", 1)))

    def _written(self):
        return sorted(path.name for path in self.folder.glob("out_*"))

    def _refused(self, *words):
        child = self._run()
        self.assertEqual((child.returncode, self._written()), (1, []), child.stdout)
        self._said(child, "Error: ", *words)

    def _said(self, child, *words):
        # What older Blenders call "Error: ", newer ones log with the time and a category.
        lines = [re.sub(r"^.*\| ERROR ", "Error: ", line) for line in child.stdout.splitlines()]
        self.assertTrue(any(all(word in line for word in words) for line in lines), child.stdout)

    def _rendered(self, *words):
        """The picture of frame 1; `words` stand in one line of the console."""
        child = self._run()
        self.assertEqual((child.returncode, self._written()), (0, ["out_0001.exr"]), child.stdout)
        self._said(child, *words)
        return self._picture(1)

    def _picture(self, frame):
        pixels = scenes.read(self.folder / f"out_000{frame}.exr")
        self.assertTrue(np.isfinite(pixels).all())
        return pixels

    def _middle(self, *words):
        return scenes.middle(self._rendered(*words))
