"""Scenes without light or anything to see: a sentence, never a black picture with status 0."""

import bpy
import numpy as np

from support import scenes
from support.bad_input import BadInputTest


class NoLight(BadInputTest):
    def test_lit(self):
        """The control."""
        self.assertGreater(self._middle().min(), 0.2)

    def test_no_light(self):
        bpy.data.objects.remove(self.lamp)
        self._refused("Scene 'Scene'", "no light with power", "add a light")

    def test_light_without_power(self):
        self.lamp.data.energy = 0.0
        self._refused("no light with power")

    def test_light_switched_off(self):
        self.lamp.hide_render = True
        self._refused("no light with power")

    def test_light_that_is_switched_on_later(self):
        for frame, energy in ((1, 0.0), (2, 2.0)):
            self.lamp.data.energy = energy
            self.lamp.data.keyframe_insert("energy", frame=frame)
        child = self._run("-a")
        self.assertEqual((child.returncode, len(self._written())), (0, 2), child.stdout)
        self._said(child, "Velour: ", "no light with power")
        self.assertEqual(self._picture(1)[..., :3].max(), 0.0)
        self.assertGreater(scenes.middle(self._picture(2)).min(), 0.2)

    def test_silhouettes(self):
        """Before a transparent film a black thing is a picture."""
        bpy.data.objects.remove(self.lamp)
        self.scene.render.film_transparent = True
        alpha = self._rendered("no light")[..., 3]
        self.assertEqual((alpha.min(), alpha.max()), (0.0, 1.0))

    def test_glowing_material(self):
        bpy.data.objects.remove(self.lamp)
        tree = self.ball.active_material.node_tree
        glow = tree.nodes.new("ShaderNodeEmission")
        tree.links.new(glow.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        self.assertGreater(self._middle().min(), 0.5)

    def test_normals_of_a_dark_scene(self):
        """Somebody may want the passes alone."""
        bpy.data.objects.remove(self.lamp)
        self.scene.view_layers[0].use_pass_normal = True
        self._rendered("Velour: ", "no light with power")


class NothingToSee(BadInputTest):
    def test_no_mesh(self):
        bpy.data.objects.remove(self.ball)
        self._refused("Scene 'Scene'", "no object with faces", "Outliner")

    def test_mesh_switched_off(self):
        self.ball.hide_render = True
        self._refused("no object with faces")

    def test_mesh_hidden_from_the_camera(self):
        self.ball.visible_camera = False
        self._refused("no object with faces")

    def test_no_mesh_before_a_sky(self):
        bpy.data.objects.remove(self.ball)
        scenes.set_world((0.2, 0.4, 0.6))
        np.testing.assert_allclose(self._middle(), (0.2, 0.4, 0.6), rtol=1e-3)

    def test_mesh_that_is_built_later(self):
        build = self.ball.modifiers.new("Build", "BUILD")
        build.frame_start, build.frame_duration = 5, 10
        self._rendered("Velour: ", "no object with faces")

    def test_no_camera(self):
        self.scene.camera = None
        self._refused("amera")


class CameraInside(BadInputTest):
    def setUp(self):
        super().setUp()
        self.camera.location = (0, 0, 0)

    def test_in_the_dark(self):
        self._refused("Camera 'Camera'", "inside object 'Sphere'", "Clip Start")

    def test_of_an_instance_among_others(self):
        for x in (5, 0, -5):
            other = bpy.data.objects.new(f"Copy {x}", self.ball.data)
            other.location.x = x
            self.scene.collection.objects.link(other)
        bpy.data.objects.remove(self.ball)
        self._refused("inside object 'Copy 0'")

    def test_of_something_lit(self):
        lamp = bpy.data.objects.new("Inner", bpy.data.lights.new("Inner", "POINT"))
        lamp.data.energy, lamp.location = 50.0, (0, 0, 0.2)
        self.scene.collection.objects.link(lamp)
        self.assertGreater(self._middle("Velour: ", "inside object 'Sphere'").min(), 0.2)

    def test_on_its_way_through(self):
        for frame, z in ((1, 0), (2, 5)):
            self.camera.location.z = z
            self.camera.keyframe_insert("location", frame=frame)
        self._rendered("Velour: ", "inside object 'Sphere'")

    def test_beyond_its_clip_start(self):
        """The surface about it is cut away, and there is something behind."""
        self.camera.data.clip_start, self.lamp.rotation_euler.y = 2.0, 0.9  # shines past the ball
        bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -5))
        self.assertGreater(self._middle().min(), 0.2)
