"""Missing files, broken geometry, circles and films without pixels: a sentence each."""

import math

import bpy

from support import scenes
from support.bad_input import BadInputTest


class MissingFiles(BadInputTest):
    def test_texture(self):
        tree = self.ball.active_material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new("wood.png", 1, 1)
        node.image.source, node.image.filepath_raw = "FILE", "//wood.png"
        shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
        tree.links.new(node.outputs["Color"], shader.inputs["Color"])
        middle = self._middle("Material 'Diffuse'", str(self.folder / "wood.png"), "Find Missing Files")
        red, green, blue = middle[:3]
        self.assertGreater(min(red, blue), 0.2)
        self.assertEqual(green, 0.0, "It is not magenta, as in Cycles.")

    def _linked_prop(self):
        path = self.folder / "props.blend"
        bpy.data.libraries.write(str(path), {self.ball})
        bpy.data.objects.remove(self.ball)
        with bpy.data.libraries.load(str(path), link=True) as (there, here):
            here.objects = there.objects
        return path, here.objects[0]

    def test_library(self):
        path, prop = self._linked_prop()
        self.scene.collection.objects.link(prop)
        self.assertGreater(self._middle().min(), 0.2)  # the control
        (self.folder / "out_0001.exr").unlink()
        path.unlink()
        self._refused("Object 'Sphere'", "props.blend", "Find Missing Files")

    def test_library_of_a_material(self):
        path = self.folder / "paints.blend"
        bpy.data.libraries.write(str(path), {self.ball.active_material})
        with bpy.data.libraries.load(str(path), link=True) as (there, here):
            here.materials = there.materials
        self.ball.data.materials[0] = here.materials[0]
        self._run()
        (self.folder / "out_0001.exr").unlink()
        path.unlink()
        self._refused("Material 'Diffuse'", "paints.blend")

    def test_library_of_a_library(self):
        """Its path is relative to the file that is open, not to the library that uses it."""
        shot, first, second = (
            self.folder / name for name in ("shot.blend", "lib/a.blend", "lib/sub/b.blend")
        )
        second.parent.mkdir(parents=True)
        bpy.data.libraries.write(str(second), {self.ball})
        bpy.data.objects.remove(self.ball)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "lib/work.blend"))
        prop = self._linked(second, "objects")
        group = bpy.data.collections.new("Props")
        group.objects.link(prop)
        bpy.data.libraries.write(str(first), {group}, path_remap="RELATIVE_ALL")
        bpy.data.batch_remove([group, prop, *bpy.data.libraries])
        bpy.ops.wm.save_as_mainfile(filepath=str(shot))
        self.scene.collection.children.link(self._linked(first, "collections"))
        self.assertGreater(self._middle().min(), 0.2)
        (self.folder / "out_0001.exr").unlink()
        second.unlink()
        self._refused("Object 'Sphere'", "lib/sub/b.blend", "Find Missing Files")

    def _linked(self, path, kind):
        with bpy.data.libraries.load(str(path), link=True, relative=True) as (there, here):
            setattr(here, kind, getattr(there, kind))
        return getattr(here, kind)[0]

    def test_library_of_a_modifier(self):
        path = self.folder / "groups.blend"
        group = bpy.data.node_groups.new("Nothing", "GeometryNodeTree")
        bpy.data.libraries.write(str(path), {group})
        bpy.data.node_groups.remove(group)
        modifier = self.ball.modifiers.new("Nodes", "NODES")
        modifier.node_group = self._linked_absolute(path)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"))
        path.unlink()
        self._refused("'Nothing'", "groups.blend")

    def _linked_absolute(self, path):
        with bpy.data.libraries.load(str(path), link=True) as (there, here):
            here.node_groups = there.node_groups
        return here.node_groups[0]

    def test_library_of_another_scene(self):
        """What this picture does not show may be gone."""
        path, prop = self._linked_prop()
        bpy.data.scenes.new("Other").collection.objects.link(prop)
        scenes.add_sphere(scenes.diffuse_material())
        self._run()
        (self.folder / "out_0001.exr").unlink()
        path.unlink()
        self.assertGreater(self._middle().min(), 0.2)


class BrokenGeometry(BadInputTest):
    def test_some_vertices(self):
        self.ball.data.vertices[0].co.z = math.nan
        self.assertGreater(self._middle("Object 'Sphere'", "triangles", "NaN").min(), 0.2)

    def test_all_vertices(self):
        for vertex in self.ball.data.vertices:
            vertex.co.x = math.nan
        self._refused("no object with faces")

    def test_loose(self):
        """Vertices and edges without faces are no reason for words, and may be nowhere."""
        self.ball.data.vertices.add(3)
        self.ball.data.edges.add(1)
        first = len(self.ball.data.vertices) - 3
        self.ball.data.edges[-1].vertices = (first, first + 1)
        self.ball.data.vertices[first + 2].co = (math.nan, 0, math.inf)
        wire = bpy.data.objects.new("Wire", bpy.data.meshes.new("Wire"))
        wire.data.from_pydata([(0, 0, 2), (1, 0, 2)], [(0, 1)], [])
        self.scene.collection.objects.link(wire)
        child = self._run()
        self.assertEqual(child.returncode, 0, child.stdout)
        self.assertNotIn("Velour: ", child.stdout)
        self.assertGreater(scenes.middle(self._picture(1)).min(), 0.2)

    def test_transform(self):
        other = bpy.data.objects.new("Lost", self.ball.data)
        other.location.x = math.nan
        self.scene.collection.objects.link(other)
        self.assertGreater(self._middle("Object 'Lost'", "not finite").min(), 0.2)

    def test_camera_transform(self):
        self.camera.location.x = math.nan
        self._refused("Camera 'Camera'", "not finite")


class RecursiveInstances(BadInputTest):
    def test_collection_in_itself(self):
        """Blender breaks the circle, one way or another; the picture is of what is left."""
        collection = bpy.data.collections.new("Circle")
        self.scene.collection.children.link(collection)
        collection.objects.link(self.ball)
        empty = bpy.data.objects.new("Again", None)
        collection.objects.link(empty)
        empty.instance_type = "COLLECTION"
        empty.instance_collection = collection
        self.assertGreater(self._middle().min(), 0.2)

    def test_children_on_vertices_of_children(self):
        """Nine deep, beyond what Blender follows."""
        parent = self.ball
        for _ in range(9):
            bpy.ops.mesh.primitive_circle_add(vertices=3, radius=0.1, fill_type="TRIFAN")
            child = bpy.context.object
            child.parent, parent.instance_type = parent, "VERTS"
            parent.show_instancer_for_render = True
            parent = child
        bpy.data.objects.remove(self.ball)
        self.assertGreater(self._rendered()[..., :3].max(), 0.2)


class NoFilm(BadInputTest):
    """Blender refuses before it asks an engine, with a status of 0, and writes nothing."""

    def _too_small(self):
        child = self._run()
        self.assertEqual(self._written(), [], child.stdout)
        self._said(child, "Error: Image too small")

    def test_no_pixels(self):
        self.scene.render.resolution_x = self.scene.render.resolution_y = 4
        self.scene.render.resolution_percentage = 1
        self._too_small()

    def test_empty_border(self):
        self.scene.render.use_border = True
        self.scene.render.border_min_x = self.scene.render.border_max_x = 0.5
        self._too_small()
