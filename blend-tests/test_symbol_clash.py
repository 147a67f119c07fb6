"""Another Embree in Blender's process must not be bound by accident: it would miss every ray, silently."""

import subprocess

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest, run_blender

# What a foreign Embree looks like to a library that asks the process for `rtc*`: every ray misses, no error.
_NAMES = """
NewDevice ReleaseDevice RetainDevice GetDeviceProperty SetDeviceProperty GetDeviceError
SetDeviceErrorFunction SetDeviceMemoryMonitorFunction NewScene ReleaseScene RetainScene CommitScene
JoinCommitScene SetSceneFlags GetSceneFlags SetSceneBuildQuality GetSceneBounds NewGeometry
ReleaseGeometry RetainGeometry CommitGeometry AttachGeometry AttachGeometryByID DetachGeometry GetGeometry
SetSharedGeometryBuffer SetNewGeometryBuffer SetGeometryBuffer GetGeometryBufferData UpdateGeometryBuffer
SetGeometryTransform SetGeometryInstancedScene SetGeometryTimeStepCount SetGeometryBuildQuality
EnableGeometry DisableGeometry Intersect1 Intersect4 Intersect8 Intersect16 Intersect1M Occluded1
Occluded4 Occluded8 Occluded16 Occluded1M IntersectNM OccludedNM
"""


class SymbolClash(BlenderTest):
    def _foreign_embree(self):
        source = "static int thing;\n" + "".join(
            f"void* rtc{n}(void) {{ return &thing; }}\n" for n in _NAMES.split()
        )
        path = self.folder / "libembree_foreign.so"
        command = [
            "gcc",
            "-shared",
            "-fPIC",
            "-x",
            "c",
            "-",
            "-o",
            str(path),
            "-Wl,-soname,libembree_foreign.so",
        ]
        subprocess.run(command, input=source.encode(), check=True)
        return path

    def _scene(self):
        scenes.use_engine(samples=64)
        scenes.add_camera(ortho_scale=1.2)
        scenes.set_world()
        scenes.add_sphere(scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement())))
        blend = self.folder / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        return blend

    def _check(self, *before, environment=None):
        output = self.folder / "out_####"
        options = ("-E", "VELOUR", "-o", output, "-F", "OPEN_EXR", "-f", 1)
        child = run_blender(*before, self._scene(), *options, environment=environment)
        self.assertEqual(child.returncode, 0, child.stdout)
        mean = scenes.middle(scenes.read(self.folder / "out_0001.exr"), 1.0)
        np.testing.assert_allclose(mean, (0.8, 0.5, 0.2), rtol=0.06)

    def test_loaded_globally_first(self):
        expression = f"import ctypes; ctypes.CDLL({str(self._foreign_embree())!r}, ctypes.RTLD_GLOBAL)"
        self._check("--python-expr", expression)

    def test_preloaded(self):
        """Before everything, as Blender's own Embree is when versions differ."""
        self._check(environment={"LD_PRELOAD": str(self._foreign_embree())})
