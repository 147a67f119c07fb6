"""What Blender itself adds to a picture of Velour by OpenGL: that it does, and that this is said."""

import unittest

import bpy

from support import scenes
from support.blender import BlenderTest, run_blender

_SECONDS = 250  # OpenGL by software compiles the shaders of EEVEE


class DrawnByBlender(BlenderTest):
    """A plane that fills a third of the picture, seen from 5 m above."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=4, size=64)
        scenes.add_camera()
        scenes.set_world()
        scenes.add_plane(scenes.diffuse_material((0.5, 0.5, 0.5)), size=1.5)
        self.plain = scenes.render(self.folder, "plain")

    def _share(self, *words):
        """Shares of changed pixels, in the picture and in its middle. The console must print `words`.

        A separate Blender renders the picture, because Blender ends where there is no OpenGL.
        """
        blend = self.folder / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        child = run_blender(blend, "-o", self.folder / "out_####", "-f", 1, seconds=_SECONDS)
        for word in words:
            self.assertIn(word, child.stdout)
        if child.returncode < 0 and "EGL" in child.stdout:
            self.skipTest("there is no OpenGL, without which Blender ends")
        self.assertEqual(child.returncode, 0, child.stdout)
        changed = abs(scenes.read(self.folder / "out_0001.exr") - self.plain).max(axis=2) > 0.02
        return changed.mean(), changed[24:40, 24:40].mean()

    def _add_pencil(self, height):
        names = dir(bpy.ops.object)
        add = bpy.ops.object.grease_pencil_add if "grease_pencil_add" in names else bpy.ops.object.gpencil_add
        add(type="STROKE", rotation=(1.57, 0, 0))
        pencil = bpy.context.object
        pencil.location, pencil.show_in_front = (0, 0, height), False  # newer ones come in front

    def test_grease_pencil(self):
        self._add_pencil(height=1)
        self.assertGreater(self._share("Object 'Stroke': Blender itself draws Grease Pencil")[0], 0.02)

    def test_grease_pencil_behind_a_surface(self):
        """It is hidden where the view layer has the Depth pass."""
        self._add_pencil(height=-1)
        layer = bpy.context.view_layer
        for layer.use_pass_z in (False, True):
            self.assertEqual(self._share("Object 'Stroke'")[1] > 0.02, not layer.use_pass_z)

    @unittest.skipUnless(
        "use_grease_pencil" in bpy.types.ViewLayer.bl_rna.properties, "Blender 5.0 and newer"
    )
    def test_grease_pencil_that_a_view_layer_leaves_out(self):
        self._add_pencil(height=1)
        bpy.context.view_layer.use_grease_pencil = False
        self.assertEqual(self._share(), (0, 0))

    @unittest.skipUnless(bpy.app.build_options.freestyle, "this Blender is built without Freestyle")
    def test_freestyle(self):
        self.scene.render.use_freestyle = True
        lines = bpy.context.view_layer.freestyle_settings.linesets
        style = (lines[0] if lines else lines.new("Lines")).linestyle
        if style is None:  # which ends Blender itself, whatever the engine
            lines[0].linestyle = bpy.data.linestyles.new("Lines")
        self.assertGreater(
            self._share("View layer 'ViewLayer': Blender itself adds Freestyle strokes")[0], 0.02
        )


if __name__ == "__main__":
    unittest.main()
