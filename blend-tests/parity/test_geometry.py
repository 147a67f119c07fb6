"""Geometry: normals, transforms, what is visible."""

import math

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest
from parity.shaders import image

_SQUARE = [(-2, 0, -1), (2, 0, -1), (2, 0, 1), (-2, 0, 1)]


def auto_smooth(mesh, angle):
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, angle
    else:
        mesh.set_sharp_from_angle(angle=angle)  # 4.1 and newer


class Geometry(ParityTest):
    def setUp(self):
        super().setUp()
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))
        stage.lamp("SUN", 3.0, rotation=(1.2, 0.3, 0.2), angle=0.0)
        stage.world((0.3, 0.3, 0.3))

    def test_flat(self):
        stage.sphere(smooth=False)
        self.assert_parity("Normals: flat")

    def test_smooth(self):
        stage.sphere(segments=32, rings=16)
        self.assert_parity("Normals: smooth, fine mesh")

    def test_coarse_smooth(self):
        stage.sphere(segments=10, rings=6)
        self.assert_parity("Normals: smooth, coarse mesh")

    def test_facing_away(self):
        sheet = stage.mesh(_SQUARE, [(0, 1, 2, 3)], stage.gray(0.7), "Sheet", smooth=True)
        sheet.rotation_euler.z = 1.2
        auto_smooth(sheet.data, math.pi)
        sheet.data.normals_split_custom_set([(math.sin(0.5), -math.cos(0.5), 0)] * 4)
        self.assert_parity("Normals: facing away from the viewer")

    def test_along_the_face(self):
        """Leaves are lit as the ground below them, whichever side of the face the normal lies on."""
        for side, winding in (("front", (0, 1, 2, 3)), ("back", (3, 2, 1, 0))):
            for y in (-0.2, 0.2):
                with self.subTest(side=side, y=y):
                    leaf = stage.mesh(_SQUARE, [winding], stage.gray(0.7), "Leaf", smooth=True)
                    auto_smooth(leaf.data, math.pi)
                    leaf.data.normals_split_custom_set([(0, y, math.sqrt(1 - y * y))] * 4)
                    self.assert_parity(f"Normals: along the face, {side}, {y}")
                    bpy.data.objects.remove(leaf)

    def test_auto_smooth(self):
        obj = stage.sphere(segments=16, rings=6)
        auto_smooth(obj.data, math.radians(28))
        self.assert_parity("Normals: auto smooth")

    def test_sharp_edges(self):
        # Fine enough that few normals face away from the viewer, which is a question of its own.
        obj = stage.sphere(segments=48, rings=24)
        auto_smooth(obj.data, math.pi)
        for edge in obj.data.edges:  # in newer Blenders they come in any order
            edge.use_edge_sharp = sum(edge.vertices) % 3 == 0
        self.assert_parity("Normals: sharp edges")

    def test_custom(self):
        obj = stage.sphere(segments=24, rings=12)
        auto_smooth(obj.data, math.pi)
        normals = np.array([v.normal[:] for v in obj.data.vertices]) + np.array((0.3, -0.2, 0.4))
        obj.data.normals_split_custom_set_from_vertices([tuple(n / np.linalg.norm(n)) for n in normals])
        self.assert_parity("Normals: custom")

    def test_scale(self):
        """Cycles interpolates the normals of a mesh with one user in the world, of others before."""
        obj = stage.sphere(segments=32, rings=16)
        obj.scale = (1.5, 1, 0.4)
        self.assert_approximate("Scale: not uniform", 1.0)
        stage.twin(obj)
        self.assert_parity("Scale: not uniform, several users")

    def test_negative_scale(self):
        obj = stage.sphere(segments=32, rings=16)
        obj.scale, obj.rotation_euler = (-1.4, 0.8, 1), (0.3, 0.2, 0.1)
        stage.twin(obj)
        self.assert_parity("Scale: negative")

    def test_zero_scale(self):
        stage.sphere(segments=32, rings=16).scale = (1, 0, 1)
        self.assert_ignored("Scale: zero along one axis", "'Sphere': its scale is zero")

    def test_parent(self):
        parent = stage.link(bpy.data.objects.new("Parent", None))
        parent.scale, parent.rotation_euler = (1.6, 1, -0.6), (0, 0.3, 0)
        obj = stage.sphere(segments=32, rings=16)
        obj.rotation_euler, obj.parent = (0.5, 0.4, 0.3), parent
        stage.twin(obj)
        self.assert_parity("Parent with scale: shear")

    def test_seen_from_inside(self):
        stage.sphere(3.0, segments=32, rings=16).location = (0, -4, 0)
        stage.lamp("POINT", 100, (0.5, -3.0, 0.8), shadow_soft_size=0.0)
        self.assert_parity("Back faces")

    def test_instances(self):
        stage.sphere(0.5)
        group = bpy.data.collections.new("Group")
        obj = bpy.context.object
        group.objects.link(obj)
        self.scene.collection.objects.unlink(obj)
        for x in (-1.2, 0, 1.2):
            empty = stage.link(bpy.data.objects.new("Instance", None))
            empty.instance_type, empty.instance_collection = "COLLECTION", group
            empty.location, empty.scale, empty.rotation_euler = (x, x, 0), (1, 1.5 + x, 1), (x, 0.3, 0)
        self.assert_parity("Instances of a collection")

    def test_scene_units(self):
        self.scene.unit_settings.scale_length = 0.01
        stage.sphere()
        self.assert_parity("Unit scale")

    def test_far_from_the_origin(self):
        stage.sphere()
        for obj in self.scene.objects:
            obj.location.x += 5000
        self.assert_parity("5 km from the origin")


class Sheet(ParityTest):
    """Quads whose corners go up and down at random, under a low sun: no face is plane."""

    def setUp(self):
        super().setUp()
        heights = np.random.default_rng(3).uniform(0, 0.6, (7, 7))
        points = [(x - 3, y - 3, heights[x, y]) for x in range(7) for y in range(7)]
        faces = [(7 * x + y, 7 * x + 7 + y, 7 * x + 8 + y, 7 * x + y + 1) for x in range(6) for y in range(6)]
        self.sheet = stage.mesh(points, faces, stage.gray(0.7), "Sheet").data
        stage.camera((0, -6, 6), (0.78, 0, 0), 45)
        stage.sharp_sun()

    def test_flat(self):
        self.assert_parity("Normals: flat, warped faces")

    def test_mixed(self):
        self.sheet.polygons.foreach_set("use_smooth", [i % 2 == 0 for i in range(36)])
        self.assert_parity("Normals: flat and smooth faces")

    def test_sharp_edges_alone(self):
        """Cycles asks faces whether they are flat, not their edges."""
        self.sheet.polygons.foreach_set("use_smooth", [True] * 36)
        self.sheet.edges.foreach_set("use_edge_sharp", [True] * len(self.sheet.edges))
        self.assert_parity("Normals: smooth faces, all edges sharp")

    def test_normals_of_faces(self):
        """Cycles does not use them, and Blender before 4.5 does not either."""
        self.sheet.polygons.foreach_set("use_smooth", [i % 3 > 0 for i in range(36)])
        normals = self.sheet.attributes.new("custom_normal", "FLOAT_VECTOR", "FACE")
        values = np.random.default_rng(4).normal((0, 0, 1), 0.3, (36, 3)).astype(np.float32)
        normals.data.foreach_set("vector", values.ravel())
        self.assert_parity("Normals: custom normals of faces")

    def test_auto_smooth(self):
        auto_smooth(self.sheet, 0.6)
        self.assert_parity("Normals: auto smooth, warped faces")


class Visibility(ParityTest):
    def setUp(self):
        super().setUp()
        stage.ground(12)
        self.sphere = stage.sphere(0.8, smooth=False)
        self.sphere.location.z = 1
        stage.camera()
        stage.sharp_sun()
        stage.world((0.3, 0.3, 0.3))

    def _collection(self):
        """A collection of the sphere alone, in the view layer."""
        group = bpy.data.collections.new("Group")
        self.scene.collection.children.link(group)
        self.scene.collection.objects.unlink(self.sphere)
        group.objects.link(self.sphere)
        return self.scene.view_layers[0].layer_collection.children["Group"]

    def test_camera(self):
        self.sphere.visible_camera = False
        self.assert_parity("Object: hidden from the camera")

    def test_shadow(self):
        """Cycles finds a sky of one color by rays that see the object."""
        self.sphere.visible_shadow = False
        self.assert_parity("Object: casts no shadow, under a sky of one color")
        self.scene.world = None
        self.assert_parity("Object: casts no shadow")

    def _image_sky(self):
        tree = self.scene.world.node_tree
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        picture.image = image(4, 16)
        tree.links.new(picture.outputs["Color"], tree.nodes["Background"].inputs["Color"])

    def test_shadow_under_an_image(self):
        """Cycles mixes rays that see the object with such that do not."""
        self._image_sky()
        self.sphere.visible_shadow = False
        self.assert_approximate("Object: casts no shadow, under an image", 30)

    def test_bounces_under_a_sky(self):
        self.sphere.visible_diffuse = self.sphere.visible_glossy = False
        self.assert_parity("Object: hidden from diffuse and glossy rays, under a sky of one color")
        self._image_sky()
        self.assert_ignored(
            "Object: hidden from diffuse and glossy rays, its shadow under an image",
            "it is hidden from diffuse and glossy rays but blocks light of the world",
        )

    def test_bounces(self):
        self.sphere.visible_diffuse = self.sphere.visible_glossy = False
        self.scene.cycles.max_bounces = self.scene.cycles.diffuse_bounces = self.scene.velour.bounces = 2
        self.scene.world = None
        self.assert_parity("Object: hidden from diffuse and glossy rays")

    def test_bounces_under_wide_lights(self):
        self.scene.world = None
        self.sphere.visible_diffuse = self.sphere.visible_glossy = False
        stage.lamp("AREA", 200, (0, 0, 2.2), size=2.0)
        self.assert_ignored(
            "Object: hidden from diffuse and glossy rays, its shadow under an area light",
            "but blocks light of lights with a size, which",
        )

    def test_holdout(self):
        self.sphere.is_holdout = True
        self.assert_parity("Object: holdout")
        self.scene.render.film_transparent = True
        self.assert_parity("Object: holdout, transparent film")

    def test_holdout_collection(self):
        self._collection().holdout = True
        self.assert_parity("Collection: holdout")

    def test_indirect_only_collection(self):
        self._collection().indirect_only = True
        self.assert_parity("Collection: indirect only")
