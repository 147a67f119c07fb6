"""Motion blur beside Cycles, and the pass Vector."""

import bpy
import numpy as np

from parity import engines, stage
from parity.case import ParityTest, record
from parity.shaders import Tree
from support import scenes
from support.judge import judge_renders
from support.motion import blur, move


class Motion(ParityTest):
    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.sharp_sun()
        stage.world((0.3, 0.3, 0.3))
        self.camera = stage.camera()
        self.box = stage.box((-0.5, -0.4, -0.3), (0.4, 0.5, 0.6), 0.8)
        self.box.location.z = 0.6

    def _slide(self, obj, way=(1.2, -0.4, 0.3)):
        start = np.array(obj.location)
        move(obj, "location", [start - way, start, start + np.array(way)])

    def test_camera(self):
        self._slide(self.camera, (0.5, 0.1, 0.2))
        turn = np.array(self.camera.rotation_euler)
        move(self.camera, "rotation_euler", [turn - 0.04, turn, turn + 0.04])
        blur(self.scene)
        self.assert_parity("Motion blur: camera")

    def test_zoom(self):
        move(self.camera.data, "lens", [40, 50, 65])
        blur(self.scene)
        self.assert_parity("Motion blur: focal length")

    def _assert_sharp(self, feature, block, name, values):
        """Animates a property of the camera that does not blur: the image is that of the frame."""
        move(block, name, values)
        blur(self.scene)
        self.assert_parity(f"Motion blur: {feature}, which stays sharp")
        blurred = self.pictures("VELOUR")
        self.scene.render.use_motion_blur = False
        np.testing.assert_allclose(blurred, self.pictures("VELOUR"), atol=1e-5)

    def test_shift(self):
        self._assert_sharp("camera shift", self.camera.data, "shift_x", [-0.2, 0, 0.3])

    def test_orthographic_scale(self):
        self.camera.data.type = "ORTHO"
        self._assert_sharp("orthographic scale", self.camera.data, "ortho_scale", [4, 6, 9])

    def test_shifted_zoom(self):
        self.camera.data.shift_x = 0.3
        move(self.camera.data, "lens", [40, 50, 65])
        blur(self.scene)
        self.assert_parity("Motion blur: focal length of a shifted camera")

    def test_curve(self):
        """The mesh made of a curve deforms with its bevel."""
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(0, 0, 1))
        curve = stage.without_terminator(bpy.context.object)
        curve.data.materials.append(stage.gray(0.7))
        move(curve.data, "bevel_depth", [0.05, 0.25, 0.6])
        self._slide(curve)
        blur(self.scene)
        self.assert_parity("Motion blur: moving curve with an animated bevel", samples=2)

    def test_object(self):
        """Turned by a third of a circle, stretched and moved on a path with a bend."""
        self._slide(self.box)
        move(self.box, "rotation_euler", [(0, 0, -1), (0, 0.2, 0), (0, 0, 1.1)])
        move(self.box, "scale", [(1, 1, 1), (1, 1.2, 1), (1.5, 1, 1)])
        blur(self.scene)
        self.assert_parity("Motion blur: moving, turning, stretching object")

    def test_steps(self):
        self._slide(self.box)
        move(self.box, "rotation_euler", [(0, 0, -2.5), (0, 0, 0), (0, 0, 2.5)])
        self.box.cycles.motion_steps = 3
        blur(self.scene, 1.5)
        self.assert_parity("Motion blur: steps, a long shutter")

    def test_position_and_curve(self):
        self._slide(self.box)
        self.scene.render.motion_blur_shutter_curve.curves[0].points[0].location = (0, 0)
        self.scene.render.motion_blur_shutter_curve.update()
        for position in ("START", "END"):
            with self.subTest(position=position):
                blur(self.scene, 0.7, position)
                self.assert_parity(f"Motion blur: {position.lower()} on frame, a curve")

    def _ball(self, smooth):
        ball = stage.sphere(0.7, 0.7, 24, 12, smooth)
        ball.location = (-1.2, -1, 0.8)
        return ball

    def _bend(self, ball, bent):
        ball.shape_key_add(name="Basis")
        key = ball.shape_key_add(name="Bent")
        for point in key.data:
            point.co = bent(point.co)
        move(key, "value", [0.0, 0.4, 1.0])

    def test_shape_key(self):
        self._bend(self._ball(smooth=False), lambda p: (p.x + 1.2 * p.z**2, p.y, 1.4 * p.z))
        blur(self.scene)
        self.assert_parity("Motion blur: shape key")

    def test_smooth_shape_key(self):
        """Moved by a key, as Cycles shows it moved as a whole: Cycles 3.4 shades the two differently."""
        ball = self._ball(smooth=True)
        self._bend(ball, lambda p: (p.x + 1.2, p.y, p.z))
        blur(self.scene)
        ours = self.pictures("VELOUR")
        bpy.data.objects.remove(ball)
        ball = self._ball(smooth=True)
        move(ball, "location", [(-1.2 + 1.2 * value, -1, 0.8) for value in (0.0, 0.4, 1.0)])
        blur(self.scene)
        verdict = judge_renders(ours, self.pictures("CYCLES"))
        record("Motion blur: smooth shape key", verdict, "honored")
        self.assertTrue(verdict.agrees, verdict)

    def test_modifier(self):
        """An object that moves while a modifier twists it."""
        twist = self.box.modifiers.new("Twist", "SIMPLE_DEFORM")
        twist.deform_method, twist.deform_axis = "TWIST", "Z"
        move(twist, "angle", [-0.8, 0.0, 1.0])
        self._slide(self.box, (0.4, 0, 0.1))
        blur(self.scene)
        self.assert_parity("Motion blur: modifier")

    def _flow(self, obj, flow, name="velocity"):
        """Stores velocities per second; `flow`: of a vertex."""
        self.scene.render.fps, self.scene.render.fps_base = 25, 1.25
        attribute = obj.data.attributes.new(name, "FLOAT_VECTOR", "POINT")
        for element, vertex in zip(attribute.data, obj.data.vertices, strict=True):
            element.vector = flow(vertex.co)

    def test_shown_from_the_middle_on(self):
        """Hidden at the frame itself, and shown from the middle of the open shutter on."""
        self._slide(self.box)
        move(self.box, "hide_render", [True, False, False])
        blur(self.scene, 2.0, "START", frame=0)
        self.assert_parity("Motion blur: shown from the middle of the shutter on")

    def test_velocities(self):
        """Stored in a mesh that stays as it is, as a liquid's."""
        self._flow(self.box, lambda p: (30 * p.z, -10 * p.z, 8))
        blur(self.scene, 0.8)
        self.assert_parity("Motion blur: velocities of a mesh")

    def test_velocities_of_a_smooth_mesh_that_turns(self):
        ball = self._ball(smooth=True)
        self._flow(ball, lambda p: (20 - 8 * p.y, 8 * p.x, 0))
        blur(self.scene, 0.8)
        self.assert_parity("Motion blur: velocities of a smooth mesh")

    def test_velocities_beside_a_shape_key(self):
        ball = self._ball(smooth=False)
        self._flow(ball, lambda p: (60 * p.z, 0, 40))
        self._bend(ball, lambda p: (p.x, p.y, 1.8 * p.z))
        blur(self.scene, 0.8)
        self.assert_parity("Motion blur: velocities beside a shape key")

    def test_velocities_without_deformation(self):
        self._flow(self.box, lambda p: (30 * p.z, -10 * p.z, 8))
        self.box.cycles.use_deform_motion = False
        blur(self.scene, 0.8)
        self.assert_parity("Motion blur: velocities, Deformation off")

    def test_instances(self):
        points = stage.mesh([(-1, 0, 0), (1, 0, 0.3), (0.4, -1.5, 0)], [(0, 1, 2)], stage.gray(0.4), "Points")
        points.location.z = 1
        points.instance_type, points.show_instancer_for_render = "VERTS", False
        self.box.parent, self.box.scale = points, (0.7, 0.7, 0.7)
        move(points, "rotation_euler", [(0, 0, -0.3), (0, 0, 0), (0.2, 0, 0.3)])
        blur(self.scene)
        self.assert_parity("Motion blur: instances")

    def test_lights_stand_still(self):
        lamp = stage.lamp("AREA", 200, (0, -1, 2.5), size=0.5)
        self._slide(lamp, (1.5, 0, 0))
        blur(self.scene)
        self.assert_parity("Motion blur: moving light")

    def test_glow(self):
        material = bpy.data.materials.new("Glow")
        tree = Tree(material)
        tree.end(tree.emission((1, 0.7, 0.4), 20.0))
        corners = [(-0.3, -0.3, 0), (0.3, -0.3, 0), (0.3, 0.3, 0), (-0.3, 0.3, 0)]
        glow = stage.mesh(corners, [(0, 1, 2, 3)], material, "Glow")
        glow.location, glow.rotation_euler = (0.8, -1, 1.4), (0.3, 0, 0)
        self._slide(glow, (1.0, 0.3, 0.2))
        blur(self.scene)
        self.assert_parity("Motion blur: moving emissive mesh", samples=2)

    def test_objects_that_do_not_blur(self):
        self._slide(self.box)
        self.box.cycles.use_motion_blur = False
        blur(self.scene)
        sharp = self.pictures("VELOUR")
        self.scene.render.use_motion_blur = False
        np.testing.assert_array_equal(sharp, self.pictures("VELOUR"))

    def test_vector(self):
        """Pixels to the previous and from the next frame, of camera, object and shape key."""
        self._bend(self._ball(smooth=True), lambda p: (2 * p.x, p.y, p.z))
        self._flow(self.box, lambda p: (10 * p.z, 0, 0))
        self._slide(self.box)
        move(self.box, "rotation_euler", [(0, 0, -1), (0, 0.2, 0), (0, 0, 1.1)])
        self._slide(self.camera, (0.3, 0, 0.1))
        self.scene.frame_set(1)
        layer = bpy.context.view_layer
        layer.use_pass_vector = True
        show, found = scenes.composite(self.scene), []
        self.effort = engines.WHOLE
        engines.set_size(self.effort)
        for engine in ("CYCLES", "VELOUR"):
            self.scene.render.engine = engine
            layer.update_render_passes()
            show("Vector")
            self.scene.cycles.samples = self.scene.velour.samples = 64
            found.append(scenes.render(self.folder, f"vector-{engine.lower()}"))
        theirs, ours = found
        self.assertGreater(np.abs(theirs).max(), 10)  # pixels
        off = np.abs(ours - theirs) > 0.02 * np.abs(theirs) + 0.1
        # Pixels of edges have the mean of both sides, of which each engine has its own share.
        self.assertLess(off.any(axis=-1).mean(), 0.05)
        self.assertLess(np.abs(np.median(ours - theirs, axis=(0, 1))).max(), 0.01)
        self.assertGreater((np.abs(ours[..., ::-1] - theirs) > 1).mean(), 0.3)  # the control: other channels
