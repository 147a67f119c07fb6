"""Ways of instancing, and materials that geometry nodes set."""

import itertools

import bpy

from parity.ground import KindTest
from parity.shaders import Tree


class Instances(KindTest):
    def _on(self, kind, **settings):
        carrier, small = self.carrier(), self.small()
        small.parent, carrier.instance_type = carrier, kind
        for name, value in settings.items():
            setattr(carrier, name, value)

    def test_vertices(self):
        self._on("VERTS", use_instance_vertices_rotation=True, show_instancer_for_render=False)
        self.assert_parity("Instances on vertices")

    def test_faces(self):
        self._on("FACES", use_instance_faces_scale=True, instance_faces_scale=1.3)
        self.assert_parity("Instances on faces, their carrier shown")

    def test_particles(self):
        carrier, small = self.carrier(), self.small()
        carrier.modifiers.new("Scatter", "PARTICLE_SYSTEM")
        settings = carrier.particle_systems[0].settings
        settings.type, settings.count, settings.render_type = "HAIR", 60, "OBJECT"
        settings.use_advanced_hair, settings.hair_length = True, 1.0
        settings.instance_object, settings.particle_size, settings.size_random = small, 0.8, 0.7
        small.location.x = 30
        self.assert_parity("Instances of particles")

    def _nodes(self, obj, *kinds):
        """A modifier of nodes in a row, each of which takes and gives geometry; those nodes."""
        tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
        if hasattr(tree, "interface"):  # 4.0 and newer
            for direction in ("INPUT", "OUTPUT"):
                tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
        else:
            tree.inputs.new("NodeSocketGeometry", "Geometry")
            tree.outputs.new("NodeSocketGeometry", "Geometry")
        nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", *kinds, "NodeGroupOutput")]
        for node, following in itertools.pairwise(nodes):
            tree.links.new(node.outputs[0], following.inputs[0])
        obj.modifiers.new("Nodes", "NODES").node_group = tree
        return tree, nodes[1:-1]

    def test_geometry_nodes(self):
        carrier, small = self.carrier(), self.small()
        tree, (points, *_) = self._nodes(carrier, "GeometryNodeInstanceOnPoints")
        source = tree.nodes.new("GeometryNodeObjectInfo")
        source.inputs["Object"].default_value = small
        source.inputs["As Instance"].default_value = True
        tree.links.new(source.outputs["Geometry"], points.inputs["Instance"])
        points.inputs["Rotation"].default_value = (0.3, 0.5, 0.7)
        small.location.x = 30
        self.assert_parity("Instances of geometry nodes")

    def test_materials_of_geometry_nodes(self):
        """The mesh says what it shows, whatever the slots of its object do."""
        carrier = self.carrier()
        material = bpy.data.materials.new("Set")
        tree = Tree(material)
        tree.end(tree.diffuse((0.8, 0.2, 0.1)))
        _, (node,) = self._nodes(carrier, "GeometryNodeSetMaterial")
        node.inputs["Material"].default_value = material
        self.assert_parity("Materials set by geometry nodes")
