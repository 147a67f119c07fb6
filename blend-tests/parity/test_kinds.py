"""Everything that shows faces, and what scene, view layer and libraries say of it."""

import contextlib
import math
from pathlib import Path

import bpy
from velour.export.camera import final_view
from velour.export.notes import Notes
from velour.export.scene import export_scene

from parity import stage
from parity.ground import KindTest
from parity.shaders import Tree, geometry_nodes
from support import level, scenes
from support.judge import judge_renders


class Kinds(KindTest):
    def test_curves(self):
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(-1.5, 0, 0.5))
        self.made(bevel_depth=0.25, bevel_resolution=6)
        bpy.ops.curve.primitive_nurbs_path_add(location=(1.5, 0.5, 0.6))
        self.made(0.4, extrude=0.3)
        self.assert_parity("Curves: bevel and extrusion")

    def test_text(self):
        bpy.ops.object.text_add(location=(-2, -0.5, 0.1), rotation=(0.4, 0, 0))
        self.made(body="Velour", size=1.4, extrude=0.1)
        self.assert_parity("Text")

    def test_surface(self):
        bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=1.2, location=(0, 0, 0.6))
        self.made()
        self.assert_parity("Surfaces")

    def test_metaballs(self):
        for x in (-0.6, 0.5):
            bpy.ops.object.metaball_add(type="BALL", radius=1.0, location=(x, 0, 0.8))
            self.made(resolution=0.15, render_resolution=0.1)
        self.assert_parity("Metaballs")

    def test_modifiers(self):
        small = self.small()
        small.scale = (1.5, 1.5, 1.5)
        array, bend = small.modifiers.new("Array", "ARRAY"), small.modifiers.new("Bend", "SIMPLE_DEFORM")
        array.count, bend.deform_method, bend.angle = 5, "BEND", 0.9
        array.relative_offset_displace = (1.1, 0.2, 0.1)
        self.assert_parity("Modifiers")


class Emissive(KindTest):
    """Whatever has become a mesh shines once: Blender lists both the object and the mesh made of it."""

    def setUp(self):
        super().setUp()
        for light in [obj for obj in self.scene.objects if obj.type == "LIGHT"]:
            bpy.data.objects.remove(light)
        stage.world((0, 0, 0))
        self.glow = bpy.data.materials.new("Glow")
        tree = Tree(self.glow)
        tree.end(tree.emission((1, 0.7, 0.4), 3.0))

    def _assert_once(self, feature, meshes, **settings):
        """`meshes`: how many meshes beside the ground are expected. Their number tells what shines twice; the
        long tests look at all pictures as well, the short ones at that of a surface."""
        obj = stage.without_terminator(bpy.context.object)
        obj.data.materials.append(self.glow)
        for name, value in settings.items():
            setattr(obj.data, name, value)
        obj.visible_camera = False  # its light alone is judged
        self.assertEqual(self._instances(), 1 + meshes)
        if level.LONG or obj.type == "SURFACE":
            self.assert_parity(f"Emissive {feature}", samples=6, seen=8)

    def _instances(self):
        """Number of instances in the library's scene."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        export = export_scene(depsgraph, final_view(depsgraph), Notes(), strict=False)
        with contextlib.closing(export.scene) as scene:
            return scene.info()["instances"]

    def test_text(self):
        bpy.ops.object.text_add(location=(-1.5, 0.3, 0.6), rotation=(1.2, 0, 0))
        self._assert_once("text", 1, body="NEON", extrude=0.1)

    def test_metaballs(self):
        """One mesh for the family."""
        bpy.ops.object.metaball_add(type="BALL", radius=0.8, location=(0.6, 0, 1.2))
        self.made().data.render_resolution = 0.15
        bpy.ops.object.metaball_add(type="BALL", radius=1.0, location=(-0.4, 0, 1.2))
        first = bpy.data.objects["Mball"]
        first.data.materials.clear()
        first.data.materials.append(self.glow)
        first.visible_camera = False
        self._assert_once("metaballs", 1, render_resolution=0.15)

    def test_bevelled_curve(self):
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(0, 0, 0.8))
        self._assert_once("curve with a bevel", 1, bevel_depth=0.25)

    def test_surface(self):
        bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=0.9, location=(0, 0, 1.1))
        self._assert_once("NURBS surface", 1)

    def test_curve_to_mesh(self):
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(0, 0, 0.8))
        tree, nodes = geometry_nodes(bpy.context.object, "GeometryNodeCurveToMesh", "GeometryNodeSetMaterial")
        profile = tree.nodes.new("GeometryNodeCurvePrimitiveCircle")
        profile.inputs["Radius"].default_value = 0.2
        tree.links.new(profile.outputs["Curve"], nodes[0].inputs["Profile Curve"])
        nodes[1].inputs["Material"].default_value = self.glow
        self._assert_once("mesh of a curve by geometry nodes", 1)

    def test_bare_curve(self):
        """It has no mesh: Cycles does not show it either."""
        stage.sharp_sun()
        bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(0, 0, 0.8))
        self._assert_once("curve without a bevel", 0)


class Shown(KindTest):
    def test_slots_of_objects(self):
        first = self.small()
        second = stage.link(first.copy())
        for obj, x in ((first, -1), (second, 1)):
            obj.location, obj.scale = (x, 0, 0), (4, 4, 4)
        second.material_slots[0].link = "OBJECT"
        second.material_slots[0].material = stage.gray(0.1)
        self.assert_parity("Material slots of objects")

    def test_override(self):
        self.carrier()
        self.scene.view_layers[0].material_override = stage.gray(0.25)
        self.assert_parity("View layer: material override")

    def test_coat_beyond_one(self):
        """Cycles adds it as often as it says, since 4.0."""
        material = bpy.data.materials.new("Coated")
        material.use_nodes = True
        shader = material.node_tree.nodes["Principled BSDF"]
        if "Coat Weight" not in shader.inputs:
            self.skipTest("before 4.0 a coat has another formula")
        shader.inputs["Coat Weight"].default_value = 2.0
        bpy.data.objects["Ground"].data.materials[0] = material
        self.assert_ignored("Principled BSDF: coat above 1", "'Coat Weight' is 2; 1 is used instead")

    def test_excluded(self):
        """One collection is excluded from the view layer, one switched off for renders."""
        for i, name in enumerate(("Shown", "Excluded", "Off")):
            group = bpy.data.collections.new(name)
            self.scene.collection.children.link(group)
            small = self.small()
            self.scene.collection.objects.unlink(small)
            group.objects.link(small)
            small.location, small.scale = (1.5 * i - 1.5, 0, 0), (4, 4, 4)
        self.scene.view_layers[0].layer_collection.children["Excluded"].exclude = True
        bpy.data.collections["Off"].hide_render = True
        self.assert_parity("View layer: excluded collection, collection off for renders")

    def test_library(self):
        """Linked with its parent, moved by an override."""
        parent, small = self.carrier(), self.small()
        small.parent, small.scale = parent, (3, 3, 3)
        path = self.folder / "props.blend"
        bpy.data.libraries.write(str(path), {parent, small})
        for obj in (parent, small):
            bpy.data.objects.remove(obj)
        with bpy.data.libraries.load(str(path), link=True) as (there, here):
            here.objects = there.objects
        for obj in here.objects:
            stage.link(obj)
        small = next(obj for obj in here.objects if obj.name.startswith("Small"))
        small.override_create(remap_local_usages=True).location = (0.5, -0.8, 0.4)
        self.assert_parity("Linked library, overridden object")

    def _turned_sheet(self):
        """A sheet whose backs look at the camera, without the sky, whose light rays find through it."""
        stage.world((0, 0, 0))
        sheet = self.carrier()
        for vertex in sheet.data.vertices:
            vertex.co.z *= 0.3  # no face looks at the camera
        sheet.rotation_euler.x = math.pi
        sheet.location.z = 1.5
        return sheet

    def test_backface_culling(self):
        self._turned_sheet().data.materials[0].use_backface_culling = True
        self.assert_parity("Material: Backface Culling")

    def test_backface_culling_of_measured_materials(self):
        """The backs are as if they were hidden from these rays."""
        sheet = self._turned_sheet()
        data = (Path(scenes.__file__).parents[1] / "scenes/data/paint.velour").read_bytes()
        material = sheet.data.materials[0] = scenes.measured_material(data)
        material.use_backface_culling = True
        ours = self.pictures("VELOUR")
        material.use_backface_culling = False
        self.assertFalse(judge_renders(self.pictures("VELOUR"), ours).agrees)
        sheet.visible_camera = sheet.visible_diffuse = sheet.visible_glossy = False
        verdict = judge_renders(self.pictures("VELOUR", first_seed=100), ours)
        self.assertTrue(verdict.agrees, verdict)
