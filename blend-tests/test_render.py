"""What the engine draws: known pictures, pixel by pixel."""

import math

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

STRATEGIES = ("AUTO", "UNIFORM", "COSINE", "TABLE", "SRBF", "LIGHT", "MIS", "GGX", "MIS_GGX", "PRODUCT")
ALBEDO = (0.8, 0.5, 0.2)


class Furnace(BlenderTest):
    """A sphere under a constant world of 1 shows its albedo."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=256)
        scenes.add_camera(ortho_scale=1.2)  # all of the picture lies on the sphere
        scenes.set_world()

    def test_diffuse(self):
        scenes.add_sphere(scenes.diffuse_material(ALBEDO))
        np.testing.assert_allclose(scenes.middle(scenes.render(self.folder), 1.0), ALBEDO, rtol=0.01)

    def test_strategies_agree(self):
        scenes.add_sphere(scenes.diffuse_material(ALBEDO))
        self._strategies(ALBEDO)

    def test_measured_strategies_agree(self):
        scenes.add_sphere(scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement(ALBEDO))))
        self._strategies(ALBEDO, rtol=0.06)  # the coarse fit's own error

    def _strategies(self, expected, rtol=0.02):
        for strategy in STRATEGIES:
            with self.subTest(strategy=strategy):
                bpy.context.scene.velour.strategy = strategy
                mean = scenes.middle(scenes.render(self.folder, strategy), 1.0)
                np.testing.assert_allclose(mean, expected, rtol=rtol)

    def test_reference_mode(self):
        scenes.add_sphere(scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement(ALBEDO))))
        path = inputs.lambert_measurement(ALBEDO)
        bpy.ops.velour.load_material(filepath=str(path), fit=False)
        node = scenes.velour_node(bpy.context.object.active_material)
        node.velour.use_reference = True
        mean = scenes.middle(scenes.render(self.folder), 1.0)
        np.testing.assert_allclose(mean, ALBEDO, rtol=0.02)

    def test_world_strength_and_color(self):
        bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 2.0
        bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (
            1,
            0.5,
            0.25,
            1,
        )
        scenes.add_sphere(scenes.diffuse_material((0.5, 0.5, 0.5)))
        np.testing.assert_allclose(scenes.middle(scenes.render(self.folder), 1.0), (1, 0.5, 0.25), rtol=0.01)

    def test_world_without_nodes(self):
        bpy.context.scene.world.use_nodes = False
        if bpy.context.scene.world.use_nodes:
            self.skipTest("every world of this Blender has nodes")
        bpy.context.scene.world.color = (0.3, 0.2, 0.1)
        scenes.add_sphere(scenes.diffuse_material())
        np.testing.assert_allclose(scenes.middle(scenes.render(self.folder), 1.0), (0.3, 0.2, 0.1), rtol=0.01)

    def test_no_world(self):
        """Black things before nothing; a black picture and no more would be refused (test_bad_inputs.py)."""
        bpy.context.scene.world = None
        bpy.context.scene.render.film_transparent = True
        scenes.add_sphere(scenes.diffuse_material())
        self.assertEqual(float(np.abs(scenes.render(self.folder)[..., :3]).max()), 0.0)

    def test_emission(self):
        material = bpy.data.materials.new("Glow")
        material.use_nodes = True
        tree = material.node_tree
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = (1, 0.5, 0.25, 1)
        shader.inputs["Strength"].default_value = 3.0
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.add_sphere(material)
        bpy.context.scene.world = None
        np.testing.assert_allclose(scenes.middle(scenes.render(self.folder), 1.0), (3, 1.5, 0.75), rtol=0.01)


class Lamps(BlenderTest):
    """A small diffuse plane 10 m under one lamp: the irradiance of Blender's units, as Cycles shows it."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=512, size=8)
        scenes.add_camera(distance=1.0, ortho_scale=0.05)
        scenes.add_plane(scenes.diffuse_material(), size=0.2)

    def _radiance(self, kind, scale=1.0, **settings):
        lamp = bpy.data.lights.new("Lamp", kind)
        for name, value in settings.items():
            setattr(lamp, name, value)
        obj = bpy.data.objects.new("Lamp", lamp)
        obj.location, obj.scale = (0, 0, 10), (scale,) * 3
        bpy.context.scene.collection.objects.link(obj)
        pixels = scenes.render(self.folder, kind)
        bpy.data.objects.remove(obj)
        return float(scenes.middle(pixels, 1.0)[1])

    def test_sun(self):
        self.assert_close(self._radiance("SUN", energy=3, angle=0.01), 3 / math.pi, 0.003)

    def test_wide_sun(self):
        expected = 0.8069 if bpy.app.version < (4, 0) else 3 / math.pi  # the first measured with Cycles 3.4.1
        self.assert_close(self._radiance("SUN", energy=3, angle=1.5), expected, 0.01)

    def test_point(self):
        expected = 1000 / (4 * math.pi) / 100 / math.pi
        self.assert_close(
            self._radiance("POINT", energy=1000, shadow_soft_size=0.1), expected, 0.01 * expected
        )

    @staticmethod
    def _of_area(power):
        """Blender's radiance was P / (4 A) before 4.0."""
        return power / (4 if bpy.app.version < (4, 0) else math.pi) / 100 / math.pi

    def test_area_shapes(self):
        expected = self._of_area(1000)
        for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
            with self.subTest(shape=shape):
                radiance = self._radiance("AREA", energy=1000, shape=shape, size=0.1, size_y=0.2)
                self.assert_close(radiance, expected, 0.01 * expected)

    def test_scale_keeps_the_power(self):
        expected = self._of_area(1000)
        radiance = self._radiance("AREA", scale=3.0, energy=1000, shape="SQUARE", size=0.1)
        self.assert_close(radiance, expected, 0.01 * expected)

    def test_color(self):
        lamp = bpy.data.lights.new("Lamp", "SUN")
        lamp.energy, lamp.color, lamp.angle = math.pi, (1, 0.5, 0.25), 0.0
        obj = bpy.data.objects.new("Lamp", lamp)
        bpy.context.scene.collection.objects.link(obj)
        np.testing.assert_allclose(scenes.middle(scenes.render(self.folder), 1.0), (1, 0.5, 0.25), rtol=0.005)


class Camera(BlenderTest):
    """Where things fall in the picture."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64, size=64)
        scenes.set_world((0, 0, 0))

    def _blob(self, location, color=(1, 1, 1), radius=0.1):
        material = bpy.data.materials.new("Blob")
        material.use_nodes = True
        tree = material.node_tree
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = (*color, 1)
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        obj = scenes.add_sphere(material, radius)
        obj.location = location

    @staticmethod
    def _center(pixels):
        """In fractions of the picture, from the left and from the bottom."""
        weight = pixels[..., 1]
        height, width = weight.shape
        x = (weight.sum(axis=0) * (np.arange(width) + 0.5)).sum() / weight.sum() / width
        y = (weight.sum(axis=1) * (np.arange(height) + 0.5)).sum() / weight.sum() / height
        return x, y

    def test_orthographic(self):
        scenes.add_camera(ortho_scale=4)
        self._blob((1, 0.5, 0))
        np.testing.assert_allclose(self._center(scenes.render(self.folder)), (0.75, 0.625), atol=0.01)

    def test_perspective(self):
        """Against Blender's own projection."""
        from bpy_extras.object_utils import world_to_camera_view

        scene = bpy.context.scene
        camera = scenes.add_camera()
        camera.location = (1, -4, 2)
        camera.rotation_euler = (1.1, 0.1, 0.2)
        camera.data.lens, camera.data.shift_x, camera.data.shift_y = 35, 0.05, -0.1
        scene.render.resolution_x, scene.render.resolution_y = 96, 64
        scene.render.pixel_aspect_x = 1.5
        self._blob((0.3, 0.2, 0.4), radius=0.05)
        bpy.context.view_layer.update()
        for fit in ("AUTO", "HORIZONTAL", "VERTICAL"):
            with self.subTest(fit=fit):
                camera.data.sensor_fit = fit
                expected = world_to_camera_view(scene, camera, bpy.context.object.location)
                np.testing.assert_allclose(self._center(scenes.render(self.folder)), expected[:2], atol=0.01)

    def test_resolution_percentage(self):
        scenes.add_camera(ortho_scale=4)
        bpy.context.scene.render.resolution_percentage = 50
        self._blob((1, 0.5, 0))
        pixels = scenes.render(self.folder)
        self.assertEqual(pixels.shape, (32, 32, 4))
        np.testing.assert_allclose(self._center(pixels), (0.75, 0.625), atol=0.02)

    def test_border(self):
        render = bpy.context.scene.render
        scenes.add_camera(ortho_scale=4)
        self._blob((1, 0.5, 0))
        render.use_border, render.border_min_x, render.border_min_y = True, 0.5, 0.25
        np.testing.assert_allclose(self._center(scenes.render(self.folder)), (0.75, 0.625), atol=0.01)
        render.use_crop_to_border = True
        pixels = scenes.render(self.folder, "cropped")
        self.assertEqual(pixels.shape[:2], (48, 32))
        np.testing.assert_allclose(self._center(pixels), (0.5, 0.5), atol=0.02)

    def test_panorama_is_refused(self):
        camera = scenes.add_camera()
        camera.data.type = "PANO"
        with self.assertRaisesRegex(RuntimeError, "Camera 'Camera'.*not supported"):
            scenes.render(self.folder)


class Film(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64)
        scenes.add_camera(ortho_scale=4)
        scenes.set_world()
        scenes.add_sphere(scenes.diffuse_material())

    def test_transparent(self):
        self.assertEqual(scenes.render(self.folder)[0, 0].tolist(), [1, 1, 1, 1])
        bpy.context.scene.render.film_transparent = True
        pixels = scenes.render(self.folder, "transparent")
        self.assertEqual(pixels[0, 0].tolist(), [0, 0, 0, 0])
        self.assert_close(pixels[16, 16, 3], 1.0, 1e-6)

    def test_bits_do_not_depend_on_threads(self):
        render = bpy.context.scene.render
        render.threads_mode = "FIXED"
        pictures = []
        for threads in (1, 2, 3):
            render.threads = threads
            pictures.append(scenes.render(self.folder, f"threads{threads}"))
        np.testing.assert_array_equal(pictures[0], pictures[1])
        np.testing.assert_array_equal(pictures[0], pictures[2])
        bpy.context.scene.velour.seed = 1
        self.assertTrue((scenes.render(self.folder, "seed") != pictures[0]).any())

    def test_sequence_share_and_heuristic_reach_the_library(self):
        settings = bpy.context.scene.velour
        before = scenes.render(self.folder)
        for name, value in (("sequence", "RANDOM"), ("share", 0.3), ("heuristic", "POWER")):
            with self.subTest(name):
                setattr(settings, name, value)
                after = scenes.render(self.folder, name)
                self.assertTrue((after != before).any())
                self.assert_close(after.mean(), before.mean(), 0.01)
                before = after

    def test_light_paths_reach_the_library(self):
        settings = bpy.context.scene.velour
        settings.clamp_direct = 0.1
        self.assertLess(scenes.render(self.folder).mean(), 0.5)
        self.assertIn(b"velour.biased_by", (self.folder / "picture.exr").read_bytes())

    def test_noise_threshold(self):
        """The empty corner is left alone after the fewest samples, whatever else takes."""
        scene, layer = bpy.context.scene, bpy.context.view_layer
        scene.render.resolution_x = scene.render.resolution_y = 64
        scene.velour.samples = 1024
        scene.velour.use_noise_target, scene.velour.noise_target = True, 0.0005
        layer.velour.use_pass_sample_count = True
        show = scenes.composite(scene)
        layer.update_render_passes()
        show("Sample Count")
        counts = scenes.render(self.folder, "counts")[..., 0]
        self.assertEqual(counts[0, 0], 128)
        self.assertGreater(counts.max(), 128)

    def test_passes(self):
        """Through the compositor, as artists use them."""
        scene, layer = bpy.context.scene, bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = True
        layer.velour.use_pass_sample_count = True
        scene.camera.data.type, scene.camera.location = "PERSP", (0, 0, 5)
        show = scenes.composite(scene)
        layer.update_render_passes()

        def shown(name):
            show(name)
            return scenes.render(self.folder, name)

        depth = shown("Depth")[..., 0]
        self.assert_close(depth[16, 16], 4.0, 0.02)
        self.assertGreater(depth[0, 0], 1e9)
        np.testing.assert_allclose(shown("Normal")[15:17, 15:17, :3].mean(axis=(0, 1)), (0, 0, 1), atol=0.1)
        np.testing.assert_array_equal(shown("Sample Count")[..., 0], 64)

    def test_depth_is_planar(self):
        """A wall across the view has one depth, corners included."""
        scenes.add_plane(scenes.diffuse_material(), size=20)
        scene = bpy.context.scene
        scene.camera.data.type, scene.camera.location = "PERSP", (0, 0, 5)
        bpy.data.objects.remove(bpy.data.objects["Sphere"])
        bpy.context.view_layer.use_pass_z = True
        show = scenes.composite(scene)
        show("Depth")
        np.testing.assert_allclose(scenes.render(self.folder)[..., 0], 5.0, rtol=0.01)


class Objects(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64)
        scenes.add_camera(ortho_scale=4)
        scenes.set_world()

    def _pixel(self, pixels, x, y):
        """The picture at world (x, y)."""
        size = pixels.shape[0]
        return pixels[int((y / 4 + 0.5) * size), int((x / 4 + 0.5) * size), :3]

    def test_material_slots(self):
        """Faces show their own slot; a slot of the object goes before the data's."""
        mesh = bpy.data.meshes.new("Faces")
        points = [(x, y, 0) for x in (-2, 0, 2) for y in (-2, 2)]
        mesh.from_pydata(points, [], [(0, 2, 3, 1), (2, 4, 5, 3)])
        mesh.polygons[1].material_index = 1
        for color in ((1, 0, 0), (0, 1, 0)):
            mesh.materials.append(scenes.diffuse_material(color))
        obj = bpy.data.objects.new("Faces", mesh)
        bpy.context.scene.collection.objects.link(obj)
        pixels = scenes.render(self.folder)
        np.testing.assert_allclose(self._pixel(pixels, -1, 0), (1, 0, 0), atol=0.05)
        np.testing.assert_allclose(self._pixel(pixels, 1, 0), (0, 1, 0), atol=0.05)
        obj.material_slots[1].link = "OBJECT"
        obj.material_slots[1].material = scenes.diffuse_material((0, 0, 1))
        np.testing.assert_allclose(self._pixel(scenes.render(self.folder), 1, 0), (0, 0, 1), atol=0.05)

    def test_instances_and_modifiers(self):
        """A collection instance of an object with an Array modifier."""
        plane = scenes.add_plane(scenes.diffuse_material((0, 1, 0)), size=0.5)
        array = plane.modifiers.new("Array", "ARRAY")
        array.use_relative_offset, array.use_constant_offset = False, True
        array.constant_offset_displace = (1, 0, 0)
        group = bpy.data.collections.new("Group")
        group.objects.link(plane)
        bpy.context.scene.collection.objects.unlink(plane)
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, (-1, 1, 0)
        bpy.context.scene.collection.objects.link(empty)
        bpy.context.scene.world = None
        scenes.set_world((1, 1, 1))
        pixels = scenes.render(self.folder)
        for x, y, color in ((-1, 1, (0, 1, 0)), (0, 1, (0, 1, 0)), (1, 1, (1, 1, 1)), (-1, -1, (1, 1, 1))):
            np.testing.assert_allclose(self._pixel(pixels, x, y), color, atol=0.05)

    def test_instances_show_the_slots_of_their_objects(self):
        """Two objects of one mesh, each with a material of its own, in one instanced collection."""
        group = bpy.data.collections.new("Group")
        first = scenes.add_plane(scenes.diffuse_material((1, 1, 0)), size=0.5)
        for x, color in ((-1, (1, 0, 0)), (1, (0, 0, 1))):
            obj = bpy.data.objects.new("Half", first.data)
            obj.location.x = x
            obj.material_slots[0].link = "OBJECT"
            obj.material_slots[0].material = scenes.diffuse_material(color)
            group.objects.link(obj)
        bpy.data.objects.remove(first)
        for y in (-1, 1):
            empty = bpy.data.objects.new("Instance", None)
            empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, (0, y, 0)
            bpy.context.scene.collection.objects.link(empty)
        bpy.context.scene.world = None
        scenes.set_world((1, 1, 1))
        pixels = scenes.render(self.folder)
        for y in (-1, 1):
            np.testing.assert_allclose(self._pixel(pixels, -1, y), (1, 0, 0), atol=0.05)
            np.testing.assert_allclose(self._pixel(pixels, 1, y), (0, 0, 1), atol=0.05)

    def test_other_geometry(self):
        """Text, curves, surfaces and metaballs are meshes to a renderer."""
        makers = (
            lambda: bpy.ops.object.metaball_add(type="BALL", radius=1.5),
            lambda: bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=1.5),
            lambda: bpy.ops.curve.primitive_bezier_circle_add(radius=1.5),
        )
        for make in makers:
            make()
            obj = bpy.context.object
            with self.subTest(type=obj.type):
                if obj.type == "CURVE":
                    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
                obj.data.materials.append(scenes.diffuse_material((0, 1, 0)))
                np.testing.assert_allclose(
                    self._pixel(scenes.render(self.folder), 0, 0), (0, 1, 0), atol=0.05
                )
            bpy.data.objects.remove(obj)

    def test_hidden(self):
        scenes.add_sphere(scenes.diffuse_material((0, 1, 0))).hide_render = True
        np.testing.assert_allclose(self._pixel(scenes.render(self.folder), 0, 0), (1, 1, 1), atol=1e-6)

    def test_nothing_at_all(self):
        np.testing.assert_allclose(scenes.render(self.folder)[..., :3], 1.0, atol=1e-6)

    def test_geometry_with_nan(self):
        obj = scenes.add_plane(scenes.diffuse_material((0, 1, 0)))
        obj.data.vertices[0].co = (float("nan"), 0, 0)
        scenes.render(self.folder)

    def test_material_override(self):
        scenes.add_sphere(scenes.diffuse_material((0, 1, 0)))
        bpy.context.view_layer.material_override = scenes.diffuse_material((1, 0, 0))
        np.testing.assert_allclose(self._pixel(scenes.render(self.folder), 0, 0), (1, 0, 0), atol=0.05)

    def test_shading_normals(self):
        """A flat-shaded coarse sphere differs from a smooth one; both see the same silhouette."""
        bpy.ops.mesh.primitive_uv_sphere_add(segments=6, ring_count=5)
        obj = bpy.context.object
        bpy.context.scene.world = None
        lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        lamp.data.energy, lamp.rotation_euler = 3, (0.5, 0.4, 0)
        bpy.context.scene.collection.objects.link(lamp)
        flat = scenes.render(self.folder, "flat")
        for polygon in obj.data.polygons:
            polygon.use_smooth = True
        smooth = scenes.render(self.folder, "smooth")
        self.assertGreater(np.abs(flat - smooth)[..., 1].max(), 0.1)
