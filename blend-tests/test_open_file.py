"""Files that are chosen in the Material tab: what is taken, remembered and refused."""

import bpy
from velour.export import files

from support import inputs, scenes
from support.blender import BlenderTest


class OpenFile(BlenderTest):
    """Files that are chosen in the panel."""

    def setUp(self):
        super().setUp()
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.velour.add_material()
        self.node = scenes.velour_node(bpy.context.object.active_material)

    def _path(self, name, data):
        path = self.folder / name
        path.write_bytes(data)
        return str(path)

    def test_a_change_of_a_measurement_is_noticed(self):
        path = self._path("paint.binary", inputs.lambert_measurement().read_bytes())
        self.assertEqual(bpy.ops.velour.open_measurement(filepath=path), {"FINISHED"})
        image = self.node.velour.measurement
        files.read_measurement(image, "Paint").close()
        self._path("paint.binary", inputs.glossy_measurement().read_bytes())
        with self.assertRaisesRegex(files.ChangedFileError, "has changed since it was chosen"):
            files.read_measurement(image, "Paint")
        bpy.ops.velour.accept_file()
        files.read_measurement(image, "Paint").close()

    def test_models(self):
        data = inputs.model_bytes(inputs.lambert_measurement())
        path = self._path("paint.velour", data)
        bpy.ops.velour.open_model(filepath=path)
        bpy.ops.velour.open_scene_model(filepath=path, pack=False)
        self.assertEqual(bytes(self.node.image.packed_file.data), data)
        self.assertIsNone(self.node.velour.scene_model.packed_file)
        digests = {image.velour.sha256 for image in (self.node.image, self.node.velour.scene_model)}
        self.assertEqual(digests, {files.sha256(data)})

    def test_other_engines_show_the_model(self):
        """Whatever the kind of the previous one."""
        group = inputs.module("operators.approximation_image")
        for name, data in (
            ("brdf", inputs.model_bytes(inputs.lambert_measurement())),
            ("btf", inputs.quarters_model()),
            ("another", inputs.model_bytes(inputs.glossy_measurement())),
        ):
            bpy.ops.velour.open_model(filepath=self._path(f"{name}.velour", data))
            tree = self.node.group.node_tree
            self.assertEqual(tree.velour.model, files.sha256(data))
            self.assertEqual(group.images_of(tree).colors is not None, name == "btf")

    def test_what_the_browser_shows(self):
        shown = bpy.ops.velour.open_measurement.get_rna_type().properties["filter_glob"].default.split(";")
        self.assertLessEqual({"*.binary", "*.bsdf", "*.brdf", "*.btf", "btf.json", "btf.csv"}, set(shown))
        self.assertNotIn("*.velour", shown)
        shown = bpy.ops.velour.open_model.get_rna_type().properties["filter_glob"].default
        self.assertIn("*.velour", shown)

    def test_refused(self):
        model = self._path("paint.velour", inputs.model_bytes(inputs.lambert_measurement()))
        for words, operator, path in (
            ("is a model; choose a measurement or a BTF", bpy.ops.velour.open_measurement, model),
            (
                "is a measurement; choose a model",
                bpy.ops.velour.open_model,
                str(inputs.lambert_measurement()),
            ),
        ):
            with self.assertRaisesRegex(RuntimeError, words):
                operator(filepath=path)
        bpy.context.object.active_material = bpy.data.materials.new("Plain")
        with self.assertRaisesRegex(RuntimeError, "'Plain' is not measured"):
            bpy.ops.velour.open_model(filepath=model)
