"""What is exported of meshes, against what Blender says of their corners."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

SPLITS_AT_FACES = bpy.app.version >= (5, 0)  # Cycles does; no property reveals it


def _export(name):
    return _module("export", name)


def _module(layer, name):
    return inputs.module(f"{layer}.{name}")


def _blenders_normals(mesh):
    """[triangles x 3 x 3] But for auto smooth, of flat faces those of their triangles, as Cycles has them."""
    by_corners = _by_corners(mesh)
    if not hasattr(mesh, "corner_normals"):
        mesh.calc_normals_split()
        normals = _vectors(mesh.loops, "normal")
    elif by_corners:
        normals = _vectors(mesh.corner_normals, "vector")
    else:
        normals = _vectors(mesh.vertex_normals, "vector")[[loop.vertex_index for loop in mesh.loops]]
    mesh.calc_loop_triangles()
    return np.array(
        [
            [normals[corner] for corner in t.loops] if by_corners or t.use_smooth else [t.normal] * 3
            for t in mesh.loop_triangles
        ]
    )


def _vectors(collection, attribute):
    vectors = np.empty((len(collection), 3), np.float32)
    collection.foreach_get(attribute, vectors.reshape(-1))
    return vectors


def _by_corners(mesh):
    """Whether Cycles takes normals of corners. Where smooth faces meet flat ones, it does so from 5.0 on."""
    if hasattr(mesh, "use_auto_smooth"):  # gone in 4.1
        return mesh.use_auto_smooth
    return SPLITS_AT_FACES and mesh.normals_domain == "CORNER"


class MeshArrays(BlenderTest):
    """A ball of quads and triangles, dented so that no face is plane."""

    def setUp(self):
        super().setUp()
        self.ball = scenes.add_sphere()
        for i, vertex in enumerate(self.ball.data.vertices):
            vertex.co *= 1 + 0.05 * (i % 7)

    def _arrays(self, uv_maps=()):
        self.evaluated = self.ball.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return _export("meshes").object_arrays(self.evaluated, uv_maps)

    def _assert_normals(self, *given):
        arrays = self._arrays()
        there = [
            name
            for name in ("corner_normals", "vertex_normals", "smooth")
            if getattr(arrays, name) is not None
        ]
        self.assertEqual(there, list(given))
        np.testing.assert_allclose(
            arrays.normals(slice(None)), _blenders_normals(self.evaluated.data), atol=1e-6
        )

    def _shade(self, smooth):
        self.ball.data.polygons.foreach_set("use_smooth", smooth)
        self.ball.data.update()

    def test_a_duplicate_of_a_mesh_in_edit_mode(self):
        """It is in object mode itself, and its mesh is in edit mode."""
        before = self._export_arrays(self.ball)
        twin = self.ball.copy()
        bpy.context.scene.collection.objects.link(twin)
        bpy.context.view_layer.objects.active = self.ball
        bpy.ops.object.mode_set(mode="EDIT")
        try:
            for obj in (self.ball, twin):
                np.testing.assert_allclose(self._export_arrays(obj), before, atol=1e-6)
        finally:
            bpy.ops.object.mode_set(mode="OBJECT")

    def _export_arrays(self, obj):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return _export("meshes").object_arrays(obj.evaluated_get(depsgraph)).positions

    def test_smooth(self):
        self._assert_normals("vertex_normals")

    def test_flat(self):
        self._shade([False] * len(self.ball.data.polygons))
        self._assert_normals("smooth")

    def test_mixed(self):
        self._shade([i % 3 == 0 for i in range(len(self.ball.data.polygons))])
        self._assert_normals(*(("corner_normals",) if SPLITS_AT_FACES else ("vertex_normals", "smooth")))

    def test_auto_smooth(self):
        if not hasattr(self.ball.data, "use_auto_smooth"):
            self.skipTest("auto smooth is a modifier since Blender 4.1")
        self.ball.data.use_auto_smooth, self.ball.data.auto_smooth_angle = True, 0.2
        self._assert_normals("corner_normals")

    def test_slots(self):
        """Only where some face is not of the first."""
        self.assertIsNone(self._arrays().material_slots)
        for _ in range(2):
            self.ball.data.materials.append(None)
        faces = [i % 2 for i in range(len(self.ball.data.polygons))]
        self.ball.data.polygons.foreach_set("material_index", faces)
        slots = self._arrays().slots
        triangles = self.evaluated.data.loop_triangles
        self.assertEqual(list(slots), [faces[t.polygon_index] for t in triangles])

    def test_coordinates_only_where_they_are_looked_at(self):
        self.assertIsNotNone(self._arrays().corner_uvs)
        self.assertIsNone(self._arrays(None).corner_uvs)

    def test_coordinates_of_slots(self):
        """A face has the UV maps that its material asks for, or else the one that renders."""
        mesh, uv_maps = self.ball.data, _export("uv_maps")
        other = mesh.uv_layers.new(name="other")
        other.data.foreach_set("uv", np.arange(2 * len(mesh.loops), dtype=np.float32))
        mesh.polygons.foreach_set("material_index", [i % 2 for i in range(len(mesh.polygons))])
        for _ in range(2):
            mesh.materials.append(None)
        asked = (uv_maps.UvMaps(("other", "UVMap"), "missing"), uv_maps.RENDERED)
        arrays = self._arrays(asked)
        first, rendered = np.empty((2, len(mesh.loops), 2), np.float32)
        other.data.foreach_get("uv", first.reshape(-1))
        mesh.uv_layers["UVMap"].data.foreach_get("uv", rendered.reshape(-1))
        odd = arrays.material_slots == 1
        np.testing.assert_array_equal(arrays.uvs(~odd), first[arrays.triangles[~odd]])
        np.testing.assert_array_equal(arrays.uvs(odd), rendered[arrays.triangles[odd]])
        np.testing.assert_array_equal(arrays.more_uvs, rendered[None])
        np.testing.assert_array_equal(arrays.relief_uvs, rendered)


class MeshQueue(BlenderTest):
    """Meshes of several sets of arrays, of which one leaves nothing and one has no room beside others."""

    def _meshes(self):
        grid = _export("meshes").mesh_arrays
        flat, soft, flat_again = (scenes.add_sphere().data for _ in range(3))
        soft.polygons.foreach_set("use_smooth", [True] * len(soft.polygons))
        for mesh in (flat, flat_again):
            mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))
        nothing = bpy.data.meshes.new("nothing")
        nothing.from_pydata([(0, 0, 0)] * 3, [], [(0, 1, 2)])
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=240, y_subdivisions=240)
        return [flat, soft, nothing, bpy.context.object.data, flat_again], grid

    def test_as_added_one_by_one(self):
        native = inputs.module("native")
        meshes, read = self._meshes()
        notes = _export("notes").Notes()
        with native.Scene() as together, native.Scene() as single:
            queue = _module("core", "mesh_queue").MeshQueue(together, notes)
            places = [queue.add(read(mesh, empty=queue.empty), mesh.name) for mesh in meshes]
            for mesh in meshes:
                single.add_mesh(**read(mesh)._asdict())
            self.assertEqual([queue.numbers()[place] for place in places], [0, 1, None, 3, 4])
            self.assertEqual(
                [sentence for sentence in notes if "'nothing': 1 triangles" in sentence], list(notes)
            )
            for scene in (together, single):
                material = scene.add_principled_material()
                for number in (0, 1, 3, 4):
                    scene.add_instance(number, np.eye(4), [material])
                scene.set_world_color((1, 1, 1))
                scene.frame_camera(1.0)
                scene.commit()
            pictures = [self._picture(native, scene) for scene in (together, single)]
            self.assertEqual(together.info()["triangles"], single.info()["triangles"])
            self.assertGreater(pictures[0][..., :3].max(), 0.1)
            np.testing.assert_array_equal(*pictures)

    def _picture(self, native, scene):
        with native.render_job(scene, width=24, height=24, spp=4) as job:
            job.run()
            return job.read_pass("Combined")
