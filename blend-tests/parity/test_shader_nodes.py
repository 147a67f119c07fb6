"""Texture and color nodes that feed shaders."""

import bpy

from parity import stage
from parity.board import COLUMNS, ROWS, BoardTest, Nodes
from parity.case import NEVER


def _items(idname, name):
    """Items of a node's enum property."""
    return [i.identifier for i in getattr(bpy.types, idname).bl_rna.properties[name].enum_items]


def _in_boards(items):
    most = COLUMNS * ROWS
    return [items[i : i + most] for i in range(0, len(items), most)]


class Numbers(BoardTest):
    def _assert_all(self, feature, builds):
        for number, board in enumerate(_in_boards(builds)):
            with self.subTest(number):
                for obj in [o for o in bpy.data.objects if o.type == "MESH"]:
                    bpy.data.objects.remove(obj)
                self.show(board)
                self.assert_parity(f"{feature}, board {number + 1}")

    def test_math(self):
        def build(operation):
            def built(nodes):
                x = nodes.add("MapRange", {"Value": nodes.ramp(), "To Min": -1.5, "To Max": 2.0})
                math = nodes.add("Math", {0: x, 1: 0.6, 2: 0.25}, operation=operation)
                # A tangent has poles.
                limited = nodes.add("Clamp", {"Value": math.outputs[0], "Min": -1.0, "Max": 3.0})
                return nodes.halved(limited.outputs[0])

            return built

        self._assert_all(
            "Math: all operations", [build(each) for each in _items("ShaderNodeMath", "operation")]
        )

    def test_vector_math(self):
        def build(operation):
            def built(nodes):
                inputs = {0: nodes.place(1), 1: (0.6, -1.2, 0.35), 2: (0.2, 0.9, -0.4), "Scale": 0.7}
                math = nodes.add("VectorMath", inputs, operation=operation)
                is_number = operation in ("DOT_PRODUCT", "DISTANCE", "LENGTH")
                return nodes.halved(math.outputs["Value" if is_number else "Vector"])

            return built

        self._assert_all(
            "Vector Math: all operations",
            [build(each) for each in _items("ShaderNodeVectorMath", "operation")],
        )

    def test_mix_color(self):
        def build(blend):
            def built(nodes):
                inputs = {"Factor_Float": 0.35, "A_Color": nodes.color(), "B_Color": (0.2, 0.75, 0.4, 1)}
                mix = nodes.add("Mix", inputs, data_type="RGBA", blend_type=blend)
                return mix.outputs[2]

            return built

        self._assert_all(
            "Mix Color: all blend modes", [build(each) for each in _items("ShaderNodeMix", "blend_type")]
        )

    def test_mixes(self):
        def numbers(nodes):
            return nodes.add("Mix", {"Factor_Float": nodes.ramp(), "A_Float": 0.9, "B_Float": 0.1}).outputs[0]

        def vectors(nodes):
            inputs = {
                "Factor_Vector": nodes.color(),
                "A_Vector": (0.9, 0.1, 0.4),
                "B_Vector": (0.2, 0.7, 0.3),
            }
            mix = nodes.add("Mix", inputs, data_type="VECTOR", factor_mode="NON_UNIFORM")
            return mix.outputs[1]

        def older(nodes):
            inputs = {"Fac": nodes.ramp(), "Color1": nodes.color(), "Color2": (0.5, 0.9, 0.2, 1)}
            return nodes.add("MixRGB", inputs, blend_type="OVERLAY", use_clamp=True).outputs[0]

        self.show([numbers, vectors, older])
        self.assert_parity("Mix: numbers, vectors, MixRGB")

    def test_colors(self):
        def simple(idname, inputs, **properties):
            def built(nodes):
                return nodes.add(idname, {"Color": nodes.color(), **inputs}, **properties).outputs[0]

            return built

        def curves(nodes):
            node = nodes.add("RGBCurve", {"Fac": 0.8, "Color": nodes.color()})
            node.mapping.curves[0].points.new(0.4, 0.7)
            node.mapping.curves[3].points.new(0.6, 0.3)
            return node.outputs[0]

        def float_curve(nodes):
            node = nodes.add("FloatCurve", {"Value": nodes.ramp()})
            node.mapping.curves[0].points.new(0.4, 0.7)
            return node.outputs[0]

        def vector_curves(nodes):
            node = nodes.add("VectorCurve", {"Vector": nodes.place(0.6)})
            node.mapping.curves[1].points.new(0.2, -0.5)
            return nodes.halved(node.outputs[0])

        def through(model):
            def built(nodes):
                apart = nodes.add("SeparateColor", {0: nodes.color()}, mode=model)
                parts = {0: apart.outputs[1], 1: apart.outputs[0], 2: apart.outputs[2]}
                return nodes.add("CombineColor", parts, mode=model).outputs[0]

            return built

        self.show(
            [
                simple("HueSaturation", {"Hue": 0.63, "Saturation": 1.4, "Value": 0.8, "Fac": 0.9}),
                simple("Invert", {"Fac": 0.7}),
                simple("Gamma", {"Gamma": 1.7}),
                simple("BrightContrast", {"Bright": 0.1, "Contrast": 0.4}),
                simple("RGBToBW", {}),
                curves,
                float_curve,
                vector_curves,
                through("RGB"),
                through("HSV"),
                through("HSL"),
            ]
        )
        self.assert_parity("Color nodes: Hue/Saturation, Invert, Gamma, Bright/Contrast, curves, channels")

    def test_ramps(self):
        def build(model, interpolation):
            def built(nodes):
                node = nodes.add("ValToRGB", {"Fac": nodes.ramp()})
                ramp = node.color_ramp
                ramp.color_mode = model
                if model == "RGB":
                    ramp.interpolation = interpolation
                ramp.elements[0].color, ramp.elements[1].color = (0.1, 0.6, 0.3, 1), (0.9, 0.2, 0.4, 0.5)
                ramp.elements.new(0.37).color = (0.2, 0.3, 0.9, 1)
                return node.outputs[0]

            return built

        kinds = ("EASE", "CARDINAL", "LINEAR", "B_SPLINE", "CONSTANT")
        self.show([build("RGB", kind) for kind in kinds] + [build("HSV", ""), build("HSL", "")])
        self.assert_parity("Color Ramp: interpolations and color models")

    def test_ranges(self):
        def build(curve, clamped):
            def built(nodes):
                inputs = {
                    "Value": nodes.ramp(),
                    "From Min": 0.2,
                    "From Max": 0.7,
                    "To Min": 0.9,
                    "Steps": 3.0,
                }
                range_of = nodes.add("MapRange", inputs, interpolation_type=curve, clamp=clamped)
                return nodes.halved(range_of.outputs[0])

            return built

        def clamp(nodes):
            inputs = {"Value": nodes.ramp(), "Min": 0.8, "Max": 0.3}
            return nodes.add("Clamp", inputs, clamp_type="RANGE").outputs[0]

        def vectors(nodes):
            inputs = {
                "Vector": nodes.color(),
                "From_Max_FLOAT3": (0.5, 0.7, 1),
                "To_Min_FLOAT3": (0.3, 0.6, 0),
            }
            range_of = nodes.add("MapRange", inputs, data_type="FLOAT_VECTOR")
            return range_of.outputs["Vector"]

        curves = ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP")
        self.show([build(curve, clamped) for curve in curves for clamped in (True, False)] + [clamp, vectors])
        self.assert_parity("Map Range, Clamp")

    def test_mappings(self):
        def build(kind):
            def built(nodes):
                inputs = {
                    "Vector": nodes.add("TexCoord").outputs["Object"],
                    "Rotation": (0.4, 0.3, 0.2),
                    "Scale": (0.9, 1.2, 0.6),
                }
                return nodes.halved(nodes.add("Mapping", inputs, vector_type=kind).outputs[0])

            return built

        self.show([build(kind) for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL")])
        self.assert_parity("Mapping: all types")


class Textures(BoardTest):
    def _of(self, idname, inputs, output=0, **properties):
        def built(nodes):
            node = nodes.add(idname, {"Vector": nodes.place(), **inputs}, **properties)
            return nodes.halved(node.outputs[output])

        return built

    def test_noise(self):
        dimensions = ("1D", "2D", "3D", "4D")
        inputs = {"W": 0.4, "Scale": 2.0, "Detail": 2.6, "Roughness": 0.6, "Distortion": 0.7}
        color = [self._of("TexNoise", inputs, "Color", noise_dimensions=each) for each in dimensions]
        plain = [self._of("TexNoise", {"Scale": 3.0}, 0, noise_dimensions=each) for each in dimensions[1:]]
        self.show(color + plain)
        self.assert_parity("Noise Texture: dimensions, detail, distortion")

    def test_fractals(self):
        kinds = ("FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN")
        inputs = {"Scale": 2.0, "Detail": 2.6, "Lacunarity": 1.9, "Offset": 0.4, "Gain": 1.3}
        if hasattr(bpy.types, "ShaderNodeTexMusgrave"):
            builds = [self._of("TexMusgrave", inputs, musgrave_type=kind) for kind in kinds]
        else:
            builds = [self._of("TexNoise", inputs, noise_type=kind, normalize=False) for kind in kinds]
        self.show(builds)
        self.assert_parity("Musgrave, or the fractals of Noise")

    def test_voronoi(self):
        inputs = {"W": 0.4, "Scale": 1.5, "Smoothness": 0.6, "Exponent": 0.7, "Randomness": 0.9}

        def build(dimensions, feature, output, metric="EUCLIDEAN"):
            names = {"voronoi_dimensions": dimensions, "feature": feature, "distance": metric}
            return self._of("TexVoronoi", inputs, output, **names)

        features = (("F1", "Color"), ("F2", "Distance"), ("SMOOTH_F1", "Color"))
        builds = [build(d, feature, out) for d in ("2D", "3D", "4D") for feature, out in features]
        builds += [
            build("3D", "F1", "Distance", metric) for metric in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI")
        ]
        builds += [build(d, "DISTANCE_TO_EDGE", "Distance") for d in ("2D", "3D", "4D")]
        builds += [build(d, "N_SPHERE_RADIUS", "Radius") for d in ("2D", "3D")]
        self.show(builds)
        self.assert_parity("Voronoi Texture: features, metrics, dimensions")

    def test_patterns(self):
        waves = {"Scale": 0.6, "Distortion": 1.5, "Detail": 1.5}
        builds = [
            self._of("TexWave", waves, 1, wave_type="BANDS", bands_direction="DIAGONAL", wave_profile="SIN"),
            self._of("TexWave", waves, 1, wave_type="RINGS", rings_direction="Z", wave_profile="SAW"),
            self._of("TexWave", {"Scale": 0.6}, 1, wave_type="RINGS", wave_profile="TRI"),
            self._of("TexChecker", {"Scale": 0.9}),
            self._of("TexBrick", {"Scale": 1.2, "Mortar Smooth": 0.2, "Mortar Size": 0.1}, squash=1.3),
            self._of("TexMagic", {"Scale": 0.8, "Distortion": 1.2}, turbulence_depth=3),
            self._of("TexWhiteNoise", {}, 0),
            lambda nodes: nodes.halved(nodes.add("TexWhiteNoise").outputs[1]),  # one color for all
        ]
        kinds = ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")
        builds += [self._of("TexGradient", {}, 1, gradient_type=kind) for kind in kinds]
        self.show(builds)
        self.assert_parity("Wave, Checker, Brick, Magic, White Noise, Gradient")


class Places(BoardTest):
    def test_coordinates(self):
        empty = stage.link(bpy.data.objects.new("Empty", None))
        empty.location, empty.rotation_euler, empty.scale = (1, 2, 0.3), (0.2, 0.4, 0.6), (2, 2, 2)

        def texture(output, other=None):
            def built(nodes):
                node = nodes.add("TexCoord")
                node.object = other
                return nodes.halved(node.outputs[output])

            return built

        def geometry(output):
            def built(nodes):
                shown = nodes.add("NewGeometry").outputs[output]
                return nodes.add("VectorMath", {0: shown, 1: (0.15,) * 3}, operation="MULTIPLY").outputs[0]

            return built

        names = ("Generated", "UV", "Object", "Normal", "Reflection")
        builds = [texture(name) for name in names] + [texture("Object", empty)]
        builds += [geometry(name) for name in ("Position", "Normal", "True Normal", "Incoming", "Backfacing")]
        self.show(builds)
        self.assert_parity("Texture Coordinate, Geometry")

    def test_image_on_an_object(self):
        """An Image Texture whose coordinates are computed."""
        image = bpy.data.images.new("colors", 4, 4, float_buffer=True)
        image.pixels = [0.1 + 0.8 * ((7 * i) % 16) / 16 for i in range(64)]
        image.pack()

        def built(nodes):
            node = nodes.add("TexImage", {"Vector": nodes.place(0.6)}, image=image)
            return node.outputs[0]

        self.show([built])
        self.assert_parity("Image Texture: computed coordinates")

    def test_mappings_of_textures(self):
        """Texture nodes map their coordinates by settings that only their sidebar shows."""
        image = bpy.data.images.new("colors", 4, 4, float_buffer=True)
        image.pixels = [0.1 + 0.8 * ((7 * i) % 16) / 16 for i in range(64)]
        image.pack()

        def texture(idname, kind, axes="XYZ", **properties):
            def built(nodes):
                node = nodes.add(idname, **properties)
                mapping = node.texture_mapping
                mapping.vector_type, mapping.translation = kind, (0.3, 0.1, -0.2)
                mapping.rotation, mapping.scale = (0.4, 0.2, 0.9), (1.7, -0.6, 1.2)
                mapping.mapping_x, mapping.mapping_y, mapping.mapping_z = axes
                return node.outputs[0]

            return built

        kinds = ("POINT", "TEXTURE", "VECTOR", "NORMAL")
        self.show(
            [texture("TexImage", kind, image=image) for kind in kinds]
            + [texture("TexChecker", kind) for kind in kinds]
            + [texture("TexImage", "POINT", ("Y", "X", "NONE"), image=image)]
        )
        self.assert_parity("Textures: mapping among their own settings")

    def test_units(self):
        """Places are in Blender's units whatever their size in meters."""
        empty = stage.link(bpy.data.objects.new("Empty", None))
        empty.location = (1, 2, 0.3)

        def of_empty(nodes):
            node = nodes.add("TexCoord")
            node.object = empty
            return nodes.halved(node.outputs["Object"])

        def position(nodes):
            return nodes.halved(nodes.add("NewGeometry").outputs["Position"])

        self.show([of_empty, position])
        self.scene.unit_settings.system = "METRIC"
        for length in (0.001, 10):
            with self.subTest(length):
                self.scene.unit_settings.scale_length = length
                self.assert_parity(f"Geometry: Position, Object coordinates, unit scale {length:g}")


class Conversions(BoardTest):
    """Sockets of node groups and muted nodes."""

    def _group(self, given, asked):
        """A group that passes on a value of socket type `given` as one of type `asked`."""
        tree = bpy.data.node_groups.new("Group", "ShaderNodeTree")
        if hasattr(tree, "interface"):
            tree.interface.new_socket("Value", in_out="INPUT", socket_type=f"NodeSocket{given}")
            tree.interface.new_socket("Value", in_out="OUTPUT", socket_type=f"NodeSocket{asked}")
        else:
            tree.inputs.new(f"NodeSocket{given}", "Value")
            tree.outputs.new(f"NodeSocket{asked}", "Value")
        start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        tree.links.new(start.outputs[0], end.inputs[0])
        return tree

    def test_groups(self):
        def through(given, asked, source):
            def built(nodes):
                return nodes.add("Group", {0: source(nodes)}, node_tree=self._group(given, asked)).outputs[0]

            return built

        def vector(nodes):
            return nodes.add("CombineXYZ", {"X": nodes.ramp(), "Y": 0.7, "Z": 0.1}).outputs[0]

        def constant(nodes):
            """5.0 and newer convert constants alone; colors with rounded weights, 0.01 % off Cycles'."""
            return nodes.add("CombineXYZ", {"X": 2.7, "Y": 0.4, "Z": 0.1}).outputs[0]

        def own(given, asked, value):
            return through(given, asked, lambda _nodes: value)

        pairs = (
            ("Float", "Color"),
            ("Color", "Float"),
            ("Vector", "Float"),
            ("Int", "Color"),
            ("Bool", "Color"),
        )
        colors = ("Color", "Float")
        self.show(
            [through(*pair, source) for pair in pairs for source in (Nodes.color, vector)]
            + [through(*pair, constant) for pair in pairs if pair != colors]
            + [
                own("Vector", "Float", (0.9, 0.2, 0.4)),
                own("Float", "Color", 0.4),
                own("Color", "Int", (4, 2, 1, 1)),
            ]
        )
        self.assert_parity("Node groups: sockets of other types")

    def test_muted(self):
        """Unlinked inputs of muted nodes and reroutes are 0; from 5.0 on, the fed input has its own value."""

        def muted(nodes):
            node = nodes.add("Gamma", {"Color": (0.3, 0.6, 0.9, 1)})
            node.mute = True
            return node

        def loose(nodes):
            return nodes.tree.nodes.new("NodeReroute")

        def grouped(nodes):
            return nodes.add("Group", {0: muted(nodes)}, node_tree=self._group("Color", "Color"))

        def shown(source):
            def built(nodes):
                mixed = nodes.add(
                    "Mix", {"A_Color": (0.4, 0.2, 0.1, 1), "B_Color": nodes.color()}, data_type="RGBA"
                )
                nodes.set(mixed, "A_Color", source(nodes))
                return mixed.outputs[2]

            return built

        self.show([shown(source) for source in (muted, loose, grouped)])
        self.assert_parity("Muted node without a link")


class Inputs(BoardTest):
    """What the outputs are used for."""

    def test_unsupported(self):
        def built(nodes):
            mixed = nodes.add("Mix", {"Factor_Float": 0.5, "B_Color": (0.2, 0.7, 0.3, 1)}, data_type="RGBA")
            nodes.set(mixed, "A_Color", nodes.add("Wireframe", {"Size": 0.4}))
            return mixed.outputs[2]

        self.show([built])
        self.assert_ignored(
            "Unsupported nodes below others", "'Wireframe' is not a node that Velour evaluates"
        )


class Views(BoardTest):
    """Nodes of the view and of normals, on spheres under a sharp sun."""

    def setUp(self):
        super().setUp()
        stage.sharp_sun()

    def _sphere(self, number, build):
        """A sphere whose diffuse shader `build` changes."""
        ball = stage.sphere(radius=0.45, segments=32, rings=16)
        ball.location = (number % COLUMNS + 0.5, number // COLUMNS + 0.5, 0)
        material = ball.data.materials[0].copy()
        ball.data.materials[0] = material
        nodes = Nodes(material.node_tree)
        shader = next(n for n in nodes.tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
        build(nodes, shader)

    def test_fresnel(self):
        def colored(idname, output, inputs):
            def built(nodes, shader):
                nodes.set(shader, "Color", nodes.add(idname, inputs).outputs[output])

            return built

        builds = [
            colored("Fresnel", 0, {"IOR": 1.45}),
            colored("LayerWeight", "Fresnel", {"Blend": 0.3}),
            colored("LayerWeight", "Facing", {"Blend": 0.3}),
            colored("LayerWeight", "Facing", {"Blend": 0.7}),
        ]
        for number, build in enumerate(builds):
            self._sphere(number, build)
        self.assert_parity("Fresnel, Layer Weight")

    def test_bump(self):
        def bumped(coordinates="Object", **settings):
            def built(nodes, shader):
                place = nodes.add("TexCoord").outputs[coordinates]
                height = nodes.add("TexNoise", {"Vector": place, "Scale": 4.0, "Detail": 0.0})
                inputs = {"Height": height.outputs[0], "Distance": 0.2, "Strength": 0.8}
                bump = nodes.add("Bump", inputs, **settings)
                nodes.set(shader, "Normal", bump.outputs[0])

            return built

        def chained(nodes, shader):
            wave = nodes.add("TexWave", {"Vector": nodes.add("TexCoord").outputs["Object"], "Scale": 1.5})
            first = nodes.add("Bump", {"Height": wave.outputs[1], "Distance": 0.05})
            place = nodes.add("TexCoord").outputs["Generated"]
            height = nodes.add("TexNoise", {"Vector": place, "Scale": 6.0, "Detail": 0.0})
            second = nodes.add(
                "Bump", {"Height": height.outputs[0], "Distance": 0.1, "Normal": first.outputs[0]}
            )
            nodes.set(shader, "Normal", second.outputs[0])

        for number, build in enumerate((bumped(), bumped(invert=True), chained, bumped("Normal"))):
            self._sphere(number, build)
        self.assert_parity("Bump: strength, distance, invert, chained, by normals")

    def test_bump_and_units(self):
        def bumped(nodes, shader):
            height = nodes.add("TexNoise", {"Vector": nodes.add("TexCoord").outputs["Object"], "Scale": 4.0})
            bump = nodes.add("Bump", {"Height": height.outputs[0], "Distance": 0.2})
            nodes.set(shader, "Normal", bump.outputs[0])

        self._sphere(0, bumped)
        self.scene.unit_settings.system = "METRIC"
        for length in (0.001, 10):
            with self.subTest(length):
                self.scene.unit_settings.scale_length = length
                self.assert_parity(f"Bump, unit scale {length:g}")

    def test_displacement(self):
        def displaced(nodes, _shader):
            place = nodes.add("TexCoord").outputs["Object"]
            height = nodes.add("TexNoise", {"Vector": place, "Scale": 4.0, "Detail": 0.0})
            moved = nodes.add("Displacement", {"Height": height.outputs[0], "Scale": 0.2})
            end = next(n for n in nodes.tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
            nodes.set(end, "Displacement", moved.outputs[0])

        self._sphere(0, displaced)
        self.assert_approximate("Displacement as bump", 2.5, exact=((4, 1, 0), NEVER))
