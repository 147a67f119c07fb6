"""Frames that are read for motion, what comes back afterwards, and what is said."""

import contextlib
import importlib
import io
from unittest import mock

import addon_utils
import bpy

from support import inputs, scenes
from support.blender import BlenderTest
from support.motion import blur, move


class MotionBlur(BlenderTest):
    def setUp(self):
        super().setUp()
        addon_utils.enable("cycles")  # whose settings of objects are read
        self.scene = scenes.use_engine(samples=8, size=16)
        scenes.add_camera()
        scenes.set_world()
        self.plane = scenes.add_plane(scenes.diffuse_material())
        move(self.plane, "location", [(-1, 0, 0), (0, 0, 0), (1, 0, 0)], first=2)
        blur(self.scene, 0.5, frame=3)
        self.read = []
        bpy.app.handlers.frame_change_post.append(self._note)
        self.addCleanup(bpy.app.handlers.frame_change_post.remove, self._note)

    def _note(self, scene, *_):
        self.read.append(scene.frame_current + scene.frame_subframe)

    def _rendered(self, name="picture"):
        self.read.clear()
        pixels = scenes.render(self.folder, name)
        self.assertEqual(self.scene.frame_current, 3)
        self.assertEqual(self.scene.frame_subframe, 0.0)
        return pixels

    def test_frames(self):
        """The middle is read last, and then the frame itself is back."""
        for steps, position, expected in (
            (1, "CENTER", [2.75, 3.25, 3.0, 3.0]),
            (2, "CENTER", [2.75, 2.875, 3.125, 3.25, 3.0, 3.0]),
            (1, "START", [3.0, 3.5, 3.25, 3.0]),
            (1, "END", [2.5, 3.0, 2.75, 3.0]),
        ):
            with self.subTest(steps=steps, position=position):
                self.plane.cycles.motion_steps = steps
                blur(self.scene, 0.5, position, 3)
                self._rendered()
                self._assert_read(expected)

    def _assert_read(self, expected):
        """Blender itself evaluates the frame before and after."""
        runs = [self.read[i : i + len(expected)] for i in range(len(self.read))]
        self.assertIn(expected, runs, self.read)
        self.assertEqual(self.read[-1], 3.0)

    def test_no_other_frame_without_motion(self):
        self.scene.render.use_motion_blur = False
        self._rendered()
        self.assertLessEqual(set(self.read), {3.0})

    def test_vector_reads_the_frames_beside(self):
        self.scene.render.use_motion_blur = False
        bpy.context.view_layer.use_pass_vector = True
        self._rendered()
        self._assert_read([2.0, 4.0, 3.0, 3.0])

    def test_blur(self):
        """Both edges of the plane take two pixels, and it covers as much as without blur."""
        self.scene.render.film_transparent, self.scene.velour.samples = True, 512
        rows = []
        for enabled in (False, True):
            self.scene.render.use_motion_blur = enabled
            rows.append(self._rendered()[8, :, 3])
        partly = [int(((row > 0.05) & (row < 0.95)).sum()) for row in rows]
        self.assertLessEqual(partly[0], 2)
        self.assertGreaterEqual(partly[1], 4)
        self.assertAlmostEqual(rows[0].sum(), rows[1].sum(), delta=0.1)

    def test_the_frame_is_back_after_an_error(self):
        module = importlib.import_module(f"{inputs.ADDON}.export.motion")
        breaks = mock.patch.object(module.Motion, "finish", side_effect=ZeroDivisionError)
        with breaks, self.assertRaisesRegex(RuntimeError, "ZeroDivisionError"):
            self._rendered()
        self.assertEqual(self.read[-1], 3.0)
        self.assertEqual(self.scene.frame_current, 3)

    def test_a_mesh_whose_vertices_come_and_go(self):
        build = self.plane.modifiers.new("Build", "SUBSURF")
        build.levels = build.render_levels = 1
        self.plane.shape_key_add(name="Basis")
        move(build, "render_levels", [1, 1, 2], first=2)
        self.scene.render.motion_blur_shutter = 2.0
        words = "Object 'Plane': its number of vertices changes while the shutter is open"
        self.assertIn(words, self._said())
        velocity = self.plane.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
        for element in velocity.data:
            element.vector = (1, 0, 0)
        self.assertNotIn(words, self._said())

    def _said(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self._rendered()
        return said.getvalue()

    def test_memory_counts_the_shapes(self):
        """A mesh of 33 thousand triangles in 9 shapes takes 12 MB more, and its hierarchy."""
        more = self.plane.modifiers.new("More", "SUBSURF")
        more.subdivision_type, more.levels, more.render_levels = "SIMPLE", 7, 7
        self.plane.shape_key_add(name="Basis")
        key = self.plane.shape_key_add(name="Up")
        for point in key.data:
            point.co.z += 1
        move(key, "value", [0.0, 0.0, 1.0], first=2)
        self.plane.cycles.motion_steps = 3
        memory, sizes = importlib.import_module(f"{inputs.ADDON}.engine.memory"), []
        estimate = memory.estimate

        def noted(*arguments):
            sizes.append(estimate(*arguments).parts["scene"])
            return estimate(*arguments)

        with mock.patch.object(memory, "estimate", noted):
            for deforms in (False, True):
                self.plane.cycles.use_deform_motion = deforms
                self._rendered()
        self.assertGreater(sizes[1], sizes[0] + 12e6)
