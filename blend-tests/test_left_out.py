"""What is left out of a scene, or refused, is named: kinds of objects, links of lights, worlds, outputs."""

import math
import unittest

import bpy
from mathutils import Matrix

from parity.shaders import node_group
from support import inputs, scenes
from support.notes import NotesTest


def _link(name, data):
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _first_of(*names):
    """That data, which is called one or another name in the versions; None: there is none."""
    return next((getattr(bpy.data, name) for name in names if hasattr(bpy.data, name)), None)


class Objects(NotesTest):
    def _left_out(self, words, *names):
        data = _first_of(*names)
        if data is None:
            self.skipTest(f"this Blender makes no {words}")
        _link("Fluff", data.new("Fluff"))
        self.assert_said("Object 'Fluff'", words)

    def test_point_clouds(self):
        self._left_out("point clouds", "pointclouds")

    def test_hair_curves(self):
        self._left_out("hair curves", "hair_curves")

    def test_grease_pencil_of_a_tile(self):
        """In pictures Blender itself draws it (test_drawn_by_blender.py); of a capture nobody does."""
        tiles = inputs.module("export.tiles")
        # Blender 4.3 keeps the old kind beside the new one, which 5.0 has alone.
        pencils = _first_of("grease_pencils_v3", "grease_pencils")
        scenes.add_plane(scenes.diffuse_material())
        _link("Fluff", pencils.new("Fluff"))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        source = tiles.collection_tile(bpy.context.scene.collection, depsgraph)
        scene, _, notes = tiles.export_tile(source, depsgraph)
        scene.close()
        self.assertEqual(notes, ["Object 'Fluff': Grease Pencil strokes are not supported; left out."])

    @unittest.skipUnless("light_linking" in bpy.types.Object.bl_rna.properties, "Blender 4.0 and newer")
    def test_light_linking(self):
        lamp = _link("Key", bpy.data.lights.new("Key", "POINT"))
        self.assertEqual(self.notes(), [])
        lamp.light_linking.receiver_collection = bpy.data.collections.new("Lit")
        self.assert_said("Light 'Key'", "light linking")

    def test_a_portal_is_no_lamp(self):
        lamp = bpy.data.lights.new("Portal", "AREA")
        if not hasattr(lamp, "cycles"):
            self.skipTest("Cycles is not enabled")
        _link("Portal", lamp)
        lights = inputs.module("export.lights")
        for is_portal in (False, True):
            lamp.cycles.is_portal = is_portal
            lamp.update_tag()  # which a property of an add-on does not do by itself
            self.assertEqual(self.notes(), [])
            self.assertEqual(self._shines(lights, "Portal"), not is_portal)

    def _shines(self, lights, name):
        class Scene:
            def add_light(self, *_args, **_values):
                pass

        depsgraph = bpy.context.evaluated_depsgraph_get()
        return lights.add_light(Scene(), bpy.data.objects[name].evaluated_get(depsgraph), Matrix(), [])


class Materials(NotesTest):
    def _tree(self):
        material = bpy.data.materials.new("Bare")
        material.use_nodes = True
        scenes.add_sphere(material)
        return material.node_tree

    def test_without_a_surface_shader(self):
        tree = self._tree()
        tree.links.clear()
        self.assert_said("Material 'Bare'", "no surface shader", "black")

    def test_an_output_of_another_engine(self):
        self._tree().nodes["Material Output"].target = "EEVEE"
        self.assert_said("Material 'Bare'", "no surface shader", "black")

    def test_volume(self):
        tree = self._tree()
        node = tree.nodes.new("ShaderNodeVolumeScatter")
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
        self.assert_said("Material 'Bare'", "olume")

    def test_inputs_that_a_group_sets(self):
        """Inside they are 0."""
        tree = self._tree()
        principled = tree.nodes["Principled BSDF"]
        name = next(n for n in ("Subsurface Weight", "Subsurface") if n in principled.inputs)
        self.assertEqual(self.notes(), [])
        group, given, end = node_group({"Depth": "NodeSocketFloat"}, "BSDF")
        inner = group.nodes.new("ShaderNodeBsdfPrincipled")
        group.links.new(given.outputs[0], inner.inputs[name])
        group.links.new(inner.outputs[0], end.inputs[0])
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        node.inputs[0].default_value = 0.0
        self.assertEqual(self.notes(), [])
        node.inputs[0].default_value = 0.5
        self.assert_said("Material 'Bare'", f"'{name}' is not supported")

    def test_movies_and_sequences(self):
        tree = self._tree()
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new("clip", 4, 4)
        tree.links.new(node.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
        for node.image.source in ("SEQUENCE", "MOVIE"):
            self.assert_said("Material 'Bare'", "the image 'clip' is not a single image")

    def test_opaque_shadows_of_what_is_transparent(self):
        tree = self._tree()
        material = bpy.data.materials["Bare"]
        owner = material if hasattr(material, "use_transparent_shadow") else material.cycles
        owner.use_transparent_shadow = False
        self.assertFalse(any("shadow" in note for note in self.notes()))  # nothing of it is transparent
        tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.5
        self.assert_said("Material 'Bare'", "opaque shadows")


class Worlds(NotesTest):
    def _environment(self):
        tree = bpy.context.scene.world.node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.new("sky", 8, 4, float_buffer=True)
        node.image.generated_color = (0.5, 0.5, 0.5, 1)
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
        return node

    def _refused(self, words):
        export = inputs.module("export")
        with self.assertRaisesRegex(export.ExportError, words):
            self.notes()

    def test_movies_and_sequences(self):
        """Those of OpenEXR files are rendered (test_render.py)."""
        image = self._environment().image
        image.source = "MOVIE"
        self._refused("World 'World': the image 'sky' is a movie")
        image.source, image.filepath = "SEQUENCE", "//sky0001.png"
        self._refused("World 'World': the image 'sky' is .*convert its frames")
        image.filepath = "//sky0007.exr"
        self._refused("World 'World': the image 'sky' has no file '.*sky0001.exr' for frame 1")

    def test_an_environment_without_an_image(self):
        node = self._environment()
        node.image = None
        self._refused("has no image")

    def test_coordinates(self):
        node = self._environment()
        tree = bpy.context.scene.world.node_tree
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], node.inputs["Vector"])
        self.assertEqual(self.notes(), [])
        tree.links.new(coordinates.outputs["Window"], node.inputs["Vector"])
        self.assert_said("World 'World'", "output 'Window' of 'Texture Coordinate' is not supported")
        tree.links.new(coordinates.outputs["UV"], node.inputs["Vector"])
        self.assert_said("World 'World'", "a world has no UV maps")

    def test_shaders_that_are_no_background(self):
        tree = bpy.context.scene.world.node_tree
        node, both = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeAddShader")
        for shader, socket in zip((node, tree.nodes["Background"]), both.inputs, strict=True):
            tree.links.new(shader.outputs[0], socket)
        tree.links.new(both.outputs[0], tree.nodes["World Output"].inputs["Surface"])
        self.assert_said("World 'World'", "Diffuse BSDF emits no light here; rendered black")

    def test_hidden_from_diffuse_rays(self):
        world = bpy.context.scene.world
        if not hasattr(world, "cycles_visibility"):
            self.skipTest("Cycles is not enabled")
        world.cycles_visibility.diffuse = False
        self.assert_said("World 'World'", "diffuse")


class Cameras(NotesTest):
    def test_stereoscopy_is_refused(self):
        scenes.add_sphere()
        bpy.context.scene.render.use_multiview = True
        with self.assertRaisesRegex(RuntimeError, "Stereoscopy is not supported"):
            bpy.ops.render.render()

    def test_focus_on_a_bone(self):
        armature = bpy.data.armatures.new("Puppet")
        obj = _link("Puppet", armature)
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        bone = armature.edit_bones.new("Head")
        bone.head, bone.tail = (0, 0, 2), (0, 0, 3)
        bpy.ops.object.mode_set(mode="OBJECT")
        camera = bpy.context.scene.camera
        camera.matrix_world = Matrix.Translation((0, 0, 10))
        dof = camera.data.dof
        dof.use_dof, dof.focus_object = True, obj
        self.assertAlmostEqual(self._focus(), 10, places=4)
        dof.focus_subtarget = "Head"
        self.assertAlmostEqual(self._focus(), 8, places=4)
        obj.rotation_euler = (math.pi, 0, 0)
        self.assertAlmostEqual(self._focus(), 12, places=4)

    def _focus(self):
        aperture = inputs.module("export.aperture")
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera = bpy.context.scene.camera.evaluated_get(depsgraph)
        return aperture.aperture(camera, depsgraph)["focus"]
