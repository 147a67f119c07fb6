"""What a newer Blender has stored: every enumeration reads as '', and properties that will go are gone."""

import types

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


def _module(name):
    return inputs.module(f"export.{name}")


class _Newer:
    """A datablock or node whose enumerations this Blender does not know."""

    def __init__(self, real):
        self._real = real

    def __getattr__(self, name):
        described = self._real.bl_rna.properties.get(name)
        if described is not None and described.type == "ENUM" and name != "bl_idname":
            return ""
        return getattr(self._real, name)


class _Lights:
    """Stands for the library's scene."""

    def __init__(self):
        self.kinds = []

    def add_light(self, kind, *_arguments, **_values):
        self.kinds.append(kind)


class UnknownEnumerations(BlenderTest):
    def setUp(self):
        super().setUp()
        self.notes = _module("notes").Notes()
        self.plugs = _module("plugs")

    def _plug(self, idname, output):
        tree = scenes.diffuse_material().node_tree
        node = tree.nodes.new(idname)
        read = self.plugs.Plug
        return node, types.SimpleNamespace(
            node=_Newer(node), socket=node.outputs[output], input=lambda name: read(node.inputs[name])
        )

    def _assert_noted(self, *words):
        (note,) = self.notes
        for word in words:
            self.assertIn(word, note)

    def test_an_image_is_repeated(self):
        node, plug = self._plug("ShaderNodeTexImage", "Color")
        node.image, node.extension = bpy.data.images.new("Picture", 4, 4), "CLIP"
        picture = _module("image_nodes").picture_of(
            types.SimpleNamespace(**{**vars(plug), "node": _Known(node)}), "M", self.notes
        )
        self.assertEqual((picture.wrap, len(self.notes)), ("repeat", 1))
        self._assert_noted(
            "M: node 'Image Texture'", "extension", "unknown to this version", "'REPEAT' is used"
        )

    def test_an_attribute_is_not_supported(self):
        _node, plug = self._plug("ShaderNodeAttribute", "Color")
        with self.assertRaisesRegex(_module("image_nodes").UnsupportedError, "unknown to this version"):
            _module("corner_colors").corner_colors_of(plug, False)

    def test_settings_of_shaders_have_a_name(self):
        node, _plug = self._plug("ShaderNodeBsdfGlossy", "BSDF")
        node.distribution = "GGX"
        label = inputs.module("export.shaders.readers")._label
        self.assertEqual(label(node, "distribution"), "GGX")
        self.assertIn("unknown to this version", label(_Newer(node), "distribution"))

    def test_a_wave_is_not_supported(self):
        node, _plug = self._plug("ShaderNodeTexWave", "Color")
        known, axes = (
            inputs.module("export.programs.math_nodes").known,
            inputs.module("export.programs.texture_nodes")._WAVE_AXES,
        )
        self.assertEqual(known(node, "bands_direction", axes), "x")
        with self.assertRaisesRegex(_module("image_nodes").UnsupportedError, "unknown to this version"):
            known(_Newer(node), "bands_direction", axes)

    def test_a_lamp_without_a_size_is_a_point(self):
        """What Blender makes of a type that it does not know has no properties of any type."""
        lamp = types.SimpleNamespace()
        _kind, _factor, values = _module("lights")._point(lamp, None)
        self.assertEqual(values["size"], (0.0, 0.0))

    def test_a_lamp_is_a_point(self):
        lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "SPOT"))
        lights = _Lights()
        obj = types.SimpleNamespace(name="Lamp", data=_Newer(lamp.data), visible_transmission=True)
        _module("lights").add_light(lights, obj, lamp.matrix_world, self.notes)
        self.assertEqual(lights.kinds, ["point"])
        self._assert_noted("Light 'Lamp'", "type", "'POINT' is used")

    def test_a_camera_is_refused_by_name(self):
        camera = scenes.add_camera()
        looks = types.SimpleNamespace(name="Eye", type="CAMERA", data=_Newer(camera.data))
        looks.evaluated_get = lambda _depsgraph: looks
        scene = types.SimpleNamespace(camera=looks, render=bpy.context.scene.render)
        depsgraph = types.SimpleNamespace(scene_eval=scene)
        with self.assertRaisesRegex(_module("notes").ExportError, "Camera 'Eye': its type is unknown"):
            _module("camera").final_view(depsgraph)


class _Known(_Newer):
    """An Image Texture whose extension alone is new."""

    def __getattr__(self, name):
        return "" if name == "extension" else getattr(self._real, name)


class MissingProperties(BlenderTest):
    def test_without_use_nodes(self):
        """Announced to go with Blender 6.0: what has a node tree uses it."""
        has_nodes = _module("newer").has_nodes
        tree = object()
        self.assertTrue(has_nodes(types.SimpleNamespace(node_tree=tree)))
        self.assertFalse(has_nodes(types.SimpleNamespace(node_tree=None)))
        self.assertFalse(has_nodes(types.SimpleNamespace(node_tree=tree, use_nodes=False)))
