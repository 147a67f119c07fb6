"""Procedural tiles as objects: what they are made of, and shown repeated."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

TYPES = ("WEAVE", "TWILL", "NET", "CHAINMAIL", "GRAVEL", "CORDUROY")


def _add(**arguments):
    result = bpy.ops.velour.add_mesostructure(**arguments)
    assert result == {"FINISHED"}
    return bpy.context.object


def _positions(obj):
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


class AddMesostructure(BlenderTest):
    def test_every_type(self):
        for kind in TYPES:
            obj = _add(type=kind)
            self.assertEqual(obj.type, "MESH")
            self.assertIs(bpy.context.view_layer.objects.active, obj)
            self.assertTrue(obj.select_get())
            self.assertFalse(obj.data.validate(verbose=True), "Blender had to correct the mesh")
            self.assertGreater(len(obj.data.polygons), 2000)
            self.assertTrue(all(polygon.use_smooth for polygon in obj.data.polygons))
            self.assertEqual([layer.name for layer in obj.data.uv_layers], ["UVMap"])
            self.assertGreater(min(obj.velour.period), 0.001)
            used = {polygon.material_index for polygon in obj.data.polygons}
            self.assertEqual(used, set(range(len(obj.data.materials))))
            self._check_materials(obj)

    def _check_materials(self, obj):
        for material in obj.data.materials:
            self.assertTrue(material.name.startswith(obj.name.split(".")[0]), material.name)
            shader = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
            color = tuple(shader.inputs["Base Color"].default_value)
            self.assertEqual(tuple(material.diffuse_color), color)
            self.assertLess(max(color[:3]), 0.9)

    def test_most_faces_are_quads(self):
        mesh = _add(type="WEAVE").data
        self.assertEqual({polygon.loop_total for polygon in mesh.polygons}, {4})
        self.assertEqual(len(mesh.polygons) * 2, 2 * 4 * 64 * 16 * 2)

    def test_textures_lie_along_the_yarn(self):
        obj = _add(type="WEAVE", count=2)
        uvs = np.empty(2 * len(obj.data.loops), np.float32)
        obj.data.uv_layers[0].data.foreach_get("uv", uvs)
        corners = np.empty(len(obj.data.loops), np.int32)
        obj.data.loops.foreach_get("vertex_index", corners)
        uvs, places = uvs.reshape(-1, 2), _positions(obj)[corners] / obj.velour.period[0]
        weft = np.repeat([p.material_index == 1 for p in obj.data.polygons], 4)
        self.assertLess(np.abs(uvs[weft, 0] - places[weft, 0]).max(), 1e-5)
        self.assertLess(np.abs(uvs[~weft, 0] - places[~weft, 1]).max(), 1e-5)

    def test_size_is_true_to_life_in_any_unit(self):
        own = _add(type="GRAVEL")
        self.assert_close(own.velour.period[0], 0.02, 1e-6)
        bpy.context.scene.unit_settings.scale_length = 0.001  # a unit is a millimeter
        large = _add(type="GRAVEL")
        self.assert_close(large.velour.period[0], 20, 1e-3)
        self.assertLess(np.abs(_positions(large) - 1000 * _positions(own)).max(), 1e-3)
        given = _add(type="GRAVEL", size=5.0)  # units
        self.assert_close(given.velour.period[0], 5, 1e-5)

    def test_shape_is_what_was_asked_for(self):
        few, many = _add(type="NET", count=2), _add(type="NET", count=6)
        self.assertEqual(len(few.data.polygons) * 9, len(many.data.polygons))
        thick = _add(type="CORDUROY", thickness=2.0, irregularity=0.0)
        self.assert_close(_positions(thick)[:, 2].max(), 2 * 0.006 / 4, 2e-5)
        self.assertTrue(np.array_equal(_positions(_add(type="GRAVEL")), _positions(_add(type="GRAVEL"))))
        again = _positions(_add(type="GRAVEL", seed=1))
        self.assertFalse(np.array_equal(_positions(_add(type="GRAVEL"))[: len(again)], again))

    def test_one_undo_step(self):
        bpy.ops.ed.undo_push(message="before")
        _add(type="NET")
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        self.assertEqual(len(bpy.data.objects), 0)

    def test_is_offered_in_object_mode_alone(self):
        bpy.context.view_layer.objects.active = _add(type="NET")
        self.assertTrue(bpy.ops.velour.add_mesostructure.poll())
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertFalse(bpy.ops.velour.add_mesostructure.poll())

    def test_period_is_saved(self):
        _add(type="NET", size=0.5)
        path = self.folder / "net.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        bpy.ops.wm.open_mainfile(filepath=str(path))
        self.assertEqual(tuple(bpy.data.objects["Net"].velour.period), (0.5, 0.5))

    def test_placed_like_any_mesh(self):
        obj = _add(type="NET", location=(1, 2, 3), rotation=(0, 0, 1))
        self.assertEqual(tuple(obj.location), (1, 2, 3))
        self.assert_close(obj.rotation_euler.z, 1, 1e-6)

    def test_refused_by_name(self):
        with self.assertRaisesRegex(RuntimeError, "count of a twill"):
            bpy.ops.velour.add_mesostructure(type="TWILL", count=5)
        self.assertEqual(len(bpy.data.objects), 0)
        self.assertEqual(len(bpy.data.materials), 0)

    def test_renders(self):
        obj = _add(type="GRAVEL", size=1.0, count=3, resolution=8, location=(-0.5, -0.5, 0))
        scenes.use_engine()
        scenes.set_world()
        scenes.add_camera(ortho_scale=0.9)
        pixels = scenes.render(self.folder)
        self.assertTrue((pixels[..., 3] == 1).all(), "the floor has no hole")
        grays = [m.node_tree.nodes["Principled BSDF"].inputs[0].default_value[1] for m in obj.data.materials]
        self.assertLess(scenes.middle(pixels).max(), max(grays) + 0.05)
        self.assertGreater(scenes.middle(pixels).min(), 0.3 * min(grays))


class ShowRepeated(BlenderTest):
    def _places(self, obj):
        """World places of the object and of its copies, in units of its period."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        places = [
            instance.matrix_world.translation.copy()
            for instance in depsgraph.object_instances
            if instance.object.original == obj
        ]
        return sorted(tuple(round(place[k] / obj.velour.period[k], 3) for k in (0, 1)) for place in places)

    def test_nine_and_back_to_one(self):
        obj = _add(type="NET")
        bpy.ops.velour.repeat_tile()
        grid = sorted((float(x), float(y)) for x in (-1, 0, 1) for y in (-1, 0, 1))
        self.assertEqual(self._places(obj), grid)
        self.assertEqual(bpy.context.object, obj)
        bpy.ops.velour.repeat_tile()
        self.assertEqual(self._places(obj), [(0.0, 0.0)])
        self.assertEqual(len(bpy.data.objects), 1)
        self.assertEqual([c for c in bpy.data.collections if c.velour.is_repeat], [])

    def test_the_panel_leaves_the_rest_of_the_file_alone(self):
        """Reading settings would create them, in all of a large file with each redraw."""
        obj, other = _add(type="NET"), bpy.data.objects.new("Other", None)
        bpy.ops.velour.repeat_tile()
        collection = bpy.data.collections.new("Others")
        repeats = inputs.module("operators.repeat_tile")
        self.assertTrue(repeats.is_repeated(obj))
        self.assertFalse(repeats.is_repeated(other))
        self.assertFalse(other.is_property_set("velour"))
        self.assertFalse(collection.is_property_set("velour"))

    def test_copies_follow(self):
        obj = _add(type="NET")
        bpy.ops.velour.repeat_tile()
        obj.location = (2 * obj.velour.period[0], 0, 0)
        bpy.context.view_layer.update()
        self.assertIn((3.0, 1.0), self._places(obj))

    def test_copies_follow_period_rotation_and_scale(self):
        obj = _add(type="NET")
        bpy.ops.velour.repeat_tile()
        obj.velour.period = (0.5, 0.25)
        self.assertEqual(self._places(obj)[0], (-1.0, -1.0))
        obj.rotation_euler.z = np.pi / 2
        obj.scale = (3, 3, 3)
        self.assertIn((-3.0, 0.0), self._offsets(obj, turned=True))
        self.assertIn((3.0, -3.0), self._offsets(obj, turned=True))
        obj.velour.period = (0, 0)
        side = 3 * max(obj.bound_box[k][0] for k in range(8)) - 3 * min(obj.bound_box[k][0] for k in range(8))
        obj.rotation_euler.z = 0
        bpy.context.view_layer.update()
        empties = [o for o in bpy.data.objects if o.velour.is_repeat]
        self.assert_close(max(e.matrix_world.translation.x for e in empties), side, 1e-5)

    def _offsets(self, obj, turned):
        """Along the tile's own x and y, in periods without its scale; `turned`: by a quarter."""
        bpy.context.view_layer.update()
        own = obj.velour.period
        places = [o.matrix_world.translation for o in bpy.data.objects if o.velour.is_repeat]
        steps = [(place.y, -place.x) if turned else place[:2] for place in places]
        return [tuple(round(step[k] / own[k], 3) + 0.0 for k in (0, 1)) for step in steps]

    def test_copies_of_a_collection_follow_its_period(self):
        bpy.ops.mesh.primitive_cube_add(size=0.5)
        collection = bpy.data.collections.new("Bricks")
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(bpy.context.object)
        bpy.ops.velour.repeat_tile(collection="Bricks")
        collection.velour.period = (2, 1)
        places = {tuple(o.location[:2]) for o in bpy.data.objects if o.velour.is_repeat}
        self.assertEqual(places, {(2.0 * x, 1.0 * y) for x in (-1, 0, 1) for y in (-1, 0, 1)} - {(0, 0)})

    def test_along_the_axes_of_the_tile(self):
        obj = _add(type="NET", rotation=(0, 0, np.pi / 2))
        obj.scale = (3, 3, 3)
        bpy.context.view_layer.update()
        bpy.ops.velour.repeat_tile()
        self.assertEqual(self._places(obj)[0], (-3.0, -3.0))

    def test_of_a_collection(self):
        for x in (0, 1):
            bpy.ops.mesh.primitive_cube_add(size=0.5, location=(x, 0, 0))
        collection = bpy.data.collections.new("Bricks")
        bpy.context.scene.collection.children.link(collection)
        for obj in list(bpy.data.objects):
            collection.objects.link(obj)
        collection.velour.period = (2, 1)
        bpy.ops.velour.repeat_tile(collection="Bricks")
        cube = bpy.data.objects["Cube"]
        places = {
            tuple(round(v, 3) for v in instance.matrix_world.translation[:2])
            for instance in bpy.context.evaluated_depsgraph_get().object_instances
            if instance.object.original == cube
        }
        self.assertEqual(places, {(2.0 * x, 1.0 * y) for x in (-1, 0, 1) for y in (-1, 0, 1)})
        bpy.ops.velour.repeat_tile(collection="Bricks")
        self.assertEqual(len(bpy.data.objects), 2)

    def test_without_a_period_the_bounding_box_is_it(self):
        bpy.ops.mesh.primitive_cube_add(size=2)
        bpy.context.object.scale = (1, 2, 1)
        bpy.ops.velour.repeat_tile()
        empties = [o for o in bpy.data.objects if o.velour.is_repeat]
        self.assertEqual(max(e.location.x for e in empties), 2)
        self.assertEqual(max(e.location.y for e in empties), 4)

    def test_refused(self):
        with self.assertRaisesRegex(RuntimeError, "no active object"):
            bpy.ops.velour.repeat_tile()
        with self.assertRaisesRegex(RuntimeError, "Nothing at all"):
            bpy.ops.velour.repeat_tile(collection="Nothing at all")
