"""Ways of instancing, and materials that geometry nodes set."""

import bpy

from parity import stage
from parity.ground import KindTest
from parity.shaders import Tree, geometry_nodes


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

    def test_geometry_nodes(self):
        carrier, small = self.carrier(), self.small()
        tree, (points, *_) = geometry_nodes(carrier, "GeometryNodeInstanceOnPoints")
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
        _, (node,) = geometry_nodes(carrier, "GeometryNodeSetMaterial")
        node.inputs["Material"].default_value = material
        self.assert_parity("Materials set by geometry nodes")


class Instancers(KindTest):
    """Settings of what instances a collection, and of the collection itself."""

    def setUp(self):
        super().setUp()
        self.kit = bpy.data.collections.new("Kit")
        self.scene.collection.children.link(self.kit)
        small = self.small()
        self.scene.collection.objects.unlink(small)
        self.kit.objects.link(small)
        small.location, small.scale = (-1.2, 0, 0.2), (4, 4, 4)
        self.instancer = bpy.data.objects.new("Instancer", None)
        self.instancer.instance_type, self.instancer.instance_collection = "COLLECTION", self.kit
        self.instancer.location = (2.4, 0, 0)
        self.own = bpy.data.collections.new("Own")
        self.scene.collection.children.link(self.own)
        self.own.objects.link(self.instancer)

    def _layer(self, collection):
        return self.scene.view_layers[0].layer_collection.children[collection.name]

    def test_camera(self):
        self.instancer.visible_camera = False
        self.assert_parity("Instancer: hidden from the camera")

    def test_shadows(self):
        """Without the sky, whose light Cycles finds behind what is hidden from shadow rays."""
        self.scene.world = None
        self.instancer.visible_shadow = False
        self.assert_parity("Instancer: hidden from shadow rays")

    def test_holdout(self):
        self.instancer.is_holdout = True
        self.assert_parity("Instancer: holdout")

    def test_carrier(self):
        carrier, small = self.carrier(), self.small()
        small.parent, carrier.instance_type = carrier, "VERTS"
        carrier.visible_camera = False
        self.assert_parity("Instances on vertices, their carrier hidden from the camera")

    def test_collection_of_instancer(self):
        for name in ("holdout", "indirect_only"):
            with self.subTest(name):
                setattr(self._layer(self.own), name, True)
                self.assert_parity(f"Instancer in a collection: {name.replace('_', ' ')}")
                setattr(self._layer(self.own), name, False)

    def test_instanced_collection(self):
        """It is itself shown so, but its instances are not."""
        for name in ("holdout", "indirect_only"):
            with self.subTest(name):
                setattr(self._layer(self.kit), name, True)
                self.assert_parity(f"Instanced collection: {name.replace('_', ' ')}")
                setattr(self._layer(self.kit), name, False)

    def test_light(self):
        """Since 4.4, lights follow what instances them."""
        for obj in self.kit.objects:
            bpy.data.objects.remove(obj)
        lamp = stage.lamp("AREA", 300, (0, 0, 3), size=0.5)
        self.scene.collection.objects.unlink(lamp)
        self.kit.objects.link(lamp)
        self.scene.view_layers[0].layer_collection.children[self.kit.name].exclude = True
        self.instancer.visible_diffuse = False
        if bpy.app.version < (4, 4):
            self.assert_parity("Instanced light, its instancer hidden from diffuse rays")
        else:
            self.assert_ignored(
                "Instanced light, its instancer hidden from diffuse rays",
                f"Light '{lamp.name}': hiding it from diffuse rays is not supported",
            )

    def test_shadow_catcher(self):
        self.instancer.is_shadow_catcher = True
        self.assert_ignored(
            "Instancer: shadow catcher", "Object 'Instancer': Shadow Catcher is not supported"
        )
