"""What is left out of a scene, said before it is rendered."""

import bpy

from support import scenes
from support.blender import BlenderTest
from support.drawn import drawn


class CheckScene(BlenderTest):
    """A ball under a lamp."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=1, size=4)
        scenes.add_camera()
        self.ball = scenes.add_sphere(scenes.diffuse_material())
        self.lamp = bpy.data.objects.new("Fill", bpy.data.lights.new("Fill", "POINT"))
        self.lamp.data.energy = 50.0
        self.scene.collection.objects.link(self.lamp)
        self.scene.world = None

    def _found(self):
        self.assertEqual(bpy.ops.velour.check_scene(), {"FINISHED"})
        checked = bpy.context.window_manager.velour.checked
        self.assertEqual((checked.scene, checked.frame), (self.scene.name, self.scene.frame_current))
        return [(sentence.is_refusal, sentence.text) for sentence in checked.sentences]

    def _drawn(self):
        layout = drawn(bpy.types.VELOUR_RENDER_PT_check)
        self.assertEqual(layout.operators, ["velour.check_scene"])
        return " ".join(layout.texts)

    def test_nothing(self):
        self.assertEqual(self._drawn(), "")
        self.assertEqual(self._found(), [])
        self.assertEqual(self._drawn(), "None in frame 1")

    def test_owners_are_named(self):
        """Messages name the lamp, object, material or scene, in the words of the render itself."""
        self.lamp.data.specular_factor = 0.5
        self.ball.visible_glossy = False
        tree = self.ball.active_material.node_tree
        toon = tree.nodes.new("ShaderNodeBsdfToon")
        tree.links.new(toon.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        self.scene.view_layers[0].use_solid = False
        found, drawn = self._found(), self._drawn()
        self.assertEqual(len(found), 4, found)
        for words in (
            "Light 'Fill': its diffuse, specular and volume factors are not supported; ignored.",
            "Object 'Sphere': hiding it from glossy rays only is not supported; ignored.",
            "Material 'Diffuse': node 'Toon BSDF' (Toon BSDF) is not supported; rendered gray.",
            f"View layer '{self.scene.view_layers[0].name}': leaving out surfaces is not supported; ignored.",
        ):
            self.assertIn((False, words), found)
            self.assertIn(words, drawn)

    def test_settings_of_view_layers(self):
        """What only a render looks at, and Freestyle, which ended newer Blenders here."""
        layer = bpy.context.view_layer
        layer.use_pass_glossy_direct = True
        layer.lightgroups.add(name="Key")
        self.scene.render.use_freestyle = True
        has_freestyle = bpy.app.build_options.freestyle
        found = [text for _, text in self._found()]
        self.assertEqual(len(found), 2 + has_freestyle, found)
        self.assertEqual(sum("the pass" in text and "left out" in text for text in found), 2)
        self.assertEqual(sum("Freestyle strokes" in text for text in found), has_freestyle)
        self.assertTrue(self.scene.render.use_freestyle)
        layer.use_freestyle = False
        self.assertFalse(any("Freestyle" in text for _, text in self._found()))

    def test_refusals(self):
        self.lamp.data.energy = 0.0
        ((is_refusal, text),) = self._found()
        self.assertTrue(is_refusal)
        self.assertIn(f"Scene '{self.scene.name}', view layer 'ViewLayer': it has no light with power", text)
        self.assertIn("no light with power", self._drawn())

    def test_no_camera(self):
        self.scene.camera = None
        ((is_refusal, text),) = self._found()
        self.assertTrue(is_refusal)
        self.assertIn("camera", text)

    def test_settings_that_no_render_takes(self):
        self.scene.render.use_multiview = True
        ((is_refusal, text),) = self._found()
        self.assertTrue(is_refusal)
        self.assertIn("Stereoscopy is not supported", text)

    def test_scene_and_picture_stay(self):
        picture = scenes.render(self.folder)
        names = [scene.name for scene in bpy.data.scenes]
        self.lamp.data.energy = 5000.0
        self._found()
        self.assertEqual([scene.name for scene in bpy.data.scenes], names)
        bpy.data.images["Render Result"].save_render(str(self.folder / "after.exr"))
        self.assertLess(abs(scenes.read(self.folder / "after.exr") - picture).max(), 1e-3)

    def test_another_scene_shows_nothing_of_it(self):
        self._found()
        bpy.context.window.scene = bpy.data.scenes.new("Other")
        self.assertEqual(self._drawn(), "")


if __name__ == "__main__":
    import unittest

    unittest.main()
