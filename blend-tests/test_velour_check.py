"""velour-check: other seeds and samples pass, one per cent of exposure does not."""

import importlib
import shutil
import sys
import unittest
from unittest import mock

import bpy

from support import scenes
from support.blender import BlenderTest
from support.check_folder import ROOT, SAMPLES, CheckFolderTest


class VelourCheck(CheckFolderTest):
    def test_chance_passes_and_one_percent_does_not(self):
        self.save("shot")
        self.update()
        expected = {"shot": True}
        for name, change in _CHANGES.items():
            bpy.ops.wm.open_mainfile(filepath=str(self.shots / "shot.blend"))
            expected[name] = change(bpy.context.scene)
            self.save(name)
        self.references(*_CHANGES)
        # The same for references that nobody wrote errors of: one render, in half floats.
        for name in ("more", "brighter"):
            shutil.copy(self.shots / f"{name}.blend", self.shots / f"plain {name}.blend")
            expected[f"plain {name}"] = expected[name]
        bpy.ops.wm.open_mainfile(filepath=str(self.shots / "shot.blend"))
        bpy.context.scene.velour.samples = SAMPLES // 8
        self.save("plain few")
        expected["plain few"] = True
        for name in ("few", "more", "brighter"):
            self._render(self.shots / f"plain {name}.exr")
        status, said, outcomes = self.check()
        self.assertEqual({name: o["passed"] for name, o in outcomes.items()}, expected, said)
        self.assertEqual(status, 1, said)
        blind = [name for name, o in outcomes.items() if o["sees"] > 1]
        self.assertEqual(blind, ["plain few"])
        self.assertIn("Too noisy to tell", (self.shots / "velour-check/index.html").read_text())
        self._assert_page(said)

    def _render(self, path):
        """Renders "shot" as a user would."""
        bpy.ops.wm.open_mainfile(filepath=str(self.shots / "shot.blend"))
        settings = bpy.context.scene.render.image_settings
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "16"
        bpy.context.scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)

    def _assert_page(self, said):
        """Pictures lie beside it; failing ones have a magnified crop."""
        page = self.shots / "velour-check"
        text = (page / "index.html").read_text()
        pictures = {path.name for path in (page / "pictures").iterdir()}
        for name in pictures:
            self.assertIn(f'src="pictures/{name}"', text)
        crops = [name for name in pictures if "crop" in name]
        self.assertEqual(len(crops), 3 * said.count("FAILED"))
        crop = scenes.read(page / "pictures" / crops[0])
        self.assertGreater(crop.shape[1], 4 * 32)

    def test_studio_and_denoising(self):
        """A black world, and pixels that the renderer would blend."""
        self.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
        self.save("shot")
        self.update("--seeds", 4)
        self.references("denoised", "lit")
        self.scene.velour.use_denoising = True
        self.save("denoised")
        scenes.set_world(strength=0.01)
        self.save("lit")
        _, said, outcomes = self.check()
        passed = {name: outcome["passed"] for name, outcome in outcomes.items()}
        self.assertEqual(passed, {"shot": True, "denoised": True, "lit": False}, said)
        self.assertIn("world", outcomes["lit"]["sentence"])

    def test_two_frames(self):
        light = bpy.data.lights["Lamp"]
        for frame, watts in ((1, 100), (20, 400)):
            light.energy = watts
            light.keyframe_insert("energy", frame=frame)
        self.save("shot")
        self.update("--frame", 2, "--frame", 19, "--seeds", 4)
        found = sorted(path.name for path in self.shots.glob("*.exr") if "error" not in path.name)
        self.assertEqual(found, ["shot_0002.exr", "shot_0019.exr"])
        status, said, outcomes = self.check()
        self.assertEqual((status, len(outcomes)), (0, 2), said)
        shutil.copy(self.shots / "shot_0002.exr", self.shots / "shot_0019.exr")
        status, said, outcomes = self.check()
        self.assertEqual(status, 1, said)
        self.assertTrue(outcomes["shot, frame 2"]["passed"])
        self.assertFalse(outcomes["shot, frame 19"]["passed"])


def _seed(scene):
    scene.velour.seed = 77
    return True


def _keyed_seed(scene):
    for frame in (1, 100):
        scene.velour.seed = frame
        scene.velour.keyframe_insert("seed", frame=frame)
    return True


def _driven_seed(scene):
    scene.driver_add("velour.seed").driver.expression = "frame"
    return True


def _fewer(scene):
    scene.velour.samples = SAMPLES // 4
    return True


def _more(scene):
    scene.velour.samples = 2 * SAMPLES
    return True


def _brighter(scene):
    scene.cycles.film_exposure *= 1.01
    return False


_CHANGES = {
    "seed": _seed,
    "keyed": _keyed_seed,
    "driven": _driven_seed,
    "fewer": _fewer,
    "more": _more,
    "brighter": _brighter,
}


class Samples(BlenderTest):
    def test_those_of_the_command_line_count_in_all_view_layers(self):
        with mock.patch.object(sys, "path", [str(ROOT / "blend-tests/regression"), *sys.path]):
            inside_render = importlib.import_module("inside_render")
        scene = bpy.context.scene
        layers = scene.view_layers[0], scene.view_layers.new("Second")
        for layer in layers:
            layer.samples = 7
        scene.keyframe_insert('view_layers["Second"].samples')
        inside_render._set_samples(scene, None)
        self.assertEqual([layer.samples for layer in layers], [7, 7])
        inside_render._set_samples(scene, 64)
        scene.frame_set(2)
        self.assertEqual([layer.samples for layer in layers], [0, 0])
        self.assertEqual(scene.velour.samples, 64)


if __name__ == "__main__":
    unittest.main()
