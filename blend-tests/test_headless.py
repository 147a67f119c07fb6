"""`blender -b scene.blend -E VELOUR -o out_#### -f 1` and its relatives, as a farm calls them."""

import json

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest, run_blender


class Headless(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64)
        self.camera = scenes.add_camera(ortho_scale=1.2)
        scenes.set_world()
        self.blend = self.folder / "scene.blend"

    def _save(self):
        bpy.ops.wm.save_as_mainfile(filepath=str(self.blend))

    def _render(self, *frames, arguments=(), **keywords):
        output = self.folder / "out_####"
        child = run_blender(
            *arguments, self.blend, "-E", "VELOUR", "-o", output, "-F", "OPEN_EXR", *frames, **keywords
        )
        self.assertEqual(child.returncode, 0, child.stdout)
        return child.stdout

    def test_same_pixels_as_from_python(self):
        scenes.add_sphere(scenes.measured_material(inputs.model_bytes(inputs.glossy_measurement())))
        self._save()
        here = scenes.render(self.folder)
        self._render("-f", 1)
        np.testing.assert_allclose(scenes.read(self.folder / "out_0001.exr"), here, rtol=2e-3)  # half floats

    def test_animation(self):
        sphere = scenes.add_sphere(scenes.diffuse_material((0, 1, 0)))
        for frame, x in ((1, 0), (2, 5)):
            sphere.location.x = x
            sphere.keyframe_insert("location", frame=frame)
        self._save()
        self._render("-s", 1, "-e", 2, "-a")
        first, second = (scenes.middle(scenes.read(self.folder / f"out_000{n}.exr")) for n in (1, 2))
        np.testing.assert_allclose(first, (0, 1, 0), atol=0.01)
        np.testing.assert_allclose(second, (1, 1, 1), atol=0.01)

    def test_threads_option(self):
        """-t reaches the library."""
        scenes.add_sphere(scenes.diffuse_material())
        self._save()
        spy = (
            "import importlib; final = importlib.import_module('velour.engine.final');"
            " make = final.render_job;"
            " final.render_job = lambda *a, **o: (print('THREADS', o['threads']), make(*a, **o))[1]"
        )
        text = self._render("-f", 1, arguments=("-t", 3, "--python-expr", spy))
        self.assertIn("THREADS 3", text)

    def test_progress_and_notes_on_the_console(self):
        bpy.context.scene.velour.samples = 1 << 13
        material = scenes.diffuse_material()
        tree = material.node_tree
        toon = tree.nodes.new("ShaderNodeBsdfToon")
        tree.links.new(toon.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.add_sphere(material)
        self._save()
        text = self._render("-f", 1)
        self.assertIn("Velour: Material 'Diffuse'", text)
        rays = bpy.context.scene.velour.camera_samples
        self.assertEqual(rays, (1 << 13) // 8)
        self.assertRegex(text, rf"Fra: ?1 .*\| Sample \d+/{rays} \| Remaining \d\d:\d\d")
        self.assertRegex(text, rf"\| {rays} samples \| .* M light directions/s")

    def test_fit_in_a_script(self):
        """Import, fit and save without a window, then render in another process."""
        scenes.add_sphere()
        self._save()
        script = self.folder / "fit.py"
        path = inputs.lambert_measurement()
        script.write_text(
            "import bpy\n"
            "bpy.context.view_layer.objects.active = bpy.data.objects['Sphere']\n"
            f"bpy.ops.velour.load_material(filepath={json.dumps(str(path))}, fit=False)\n"
            "bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)\n"
            "bpy.ops.wm.save_mainfile()\n"
        )
        child = run_blender(self.blend, "--python-exit-code", 1, "--python", script)
        self.assertEqual(child.returncode, 0, child.stdout)
        self._render("-f", 1)
        mean = scenes.middle(scenes.read(self.folder / "out_0001.exr"), 1.0)
        np.testing.assert_allclose(mean, (0.8, 0.5, 0.2), rtol=0.06)
