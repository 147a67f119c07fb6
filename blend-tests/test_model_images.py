"""Models are images of a .blend: Blender may read them as pictures, and lives on, whatever it makes of it."""

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


class ModelImages(BlenderTest):
    def _materials(self):
        models = {
            "brushed": inputs.brushed_model(),
            "lambert": inputs.model_bytes(inputs.lambert_measurement()),
            "lobes": inputs.quarters_model(),
            "tensors": inputs.quarters_model(method="kcta"),
            "values": inputs.quarters_model(method="svd"),
        }
        for name, data in models.items():
            with self.subTest(name):
                yield scenes.measured_material(data, name)

    def test_their_pixels_can_be_asked_for(self):
        for material in self._materials():
            image = scenes.velour_node(material).image
            width, height = image.size
            self.assertEqual(len(image.pixels), width * height * image.channels)

    def test_cycles_can_read_them(self):
        """It reads the images of all nodes that are not muted."""
        scene = scenes.use_engine(size=8)
        scene.render.engine, scene.cycles.samples = "CYCLES", 1
        scene.cycles.use_denoising = False
        scenes.add_camera()
        for material in self._materials():
            scenes.velour_node(material).texture.mute = False
            obj = scenes.add_plane(material)
            bpy.ops.render.render()
            bpy.data.objects.remove(obj)
