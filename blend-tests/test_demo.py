"""The demo's Blender scripts, from an empty scene to their reports, small."""

import json
import unittest.mock

from support import blender, inputs
from support.blender import BlenderTest

SMALL = {
    "SIZE": (32, 24),
    "SAMPLES": 4,
    "PLOT_REDUCTION": 2,
    "PLOT_REFERENCE_SAMPLES": 16,
    "PLOT_SAMPLES": (2, 4),
}
SMALL_BTF = {
    "SIZE": (32, 24),
    "BTF_SAMPLES": 4,
    "CAPTURE": {"texels": 8, "views": 20, "lights": 20, "samples": 1, "bounces": 0},
}


class Demo(BlenderTest):
    def test_a_btf(self):
        scene, folder = inputs.script("bench.inside.demo"), self.folder
        with unittest.mock.patch.multiple(scene, **SMALL_BTF):
            report = scene.main({"folder": str(folder)})
        self.assertGreater(report["btf_bytes"], report["model_bytes"])
        for name in ("model.exr", "model.png", "reference.exr", "reference.png"):
            self.assertTrue((folder / name).is_file(), name)
        self.assertGreater(report["reference_seconds"], 0)

    def test_pictures_and_curves(self):
        scene, folder = inputs.script("bench.inside.demo"), blender.folder()
        model = folder / "demo.velour"
        model.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        task = {"model": str(model), "measurement": str(inputs.glossy_measurement()), "folder": str(folder)}
        with unittest.mock.patch.multiple(scene, **SMALL):
            report = json.loads(json.dumps(scene.main(task)))
        self.assertEqual(set(report["curves"]), set(scene.PLOT_STRATEGIES))
        for points in report["curves"].values():
            self.assertEqual(len(points), 2)
        for name in ("model.exr", "model.png", "reference.exr", "reference.png"):
            self.assertTrue((folder / name).is_file(), name)
