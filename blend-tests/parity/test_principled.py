"""Principled and Glossy BSDFs at all angles of view and light."""

import math

import bpy
import numpy as np

from parity import engines, stage
from parity.case import ParityTest, record_row
from parity.shaders import Tree

_VIEWS = (2, 15, 30, 45, 60, 75, 83, 88)  # degrees from the normal: a column each
_ROWS = 6  # turns of the normal about the view
_SUNS = (8, 65, 115)  # degrees between camera and sun, so that light comes in from 0 to 90 degrees
_MOST = 0.5  # per cent of a plate; dark ones count as a hundredth of the mean
ROUGH = (0.2, 0.55, 1.0)
_GOLD = (0.9, 0.6, 0.3, 1)


class Plates(ParityTest):
    """Plates that fill the squares of a picture, each at an angle of its own to the camera and to the sun."""

    effort = engines.Effort(1, 1, 96, 72)  # a plate has one color, without noise

    def setUp(self):
        super().setUp()
        stage.world((0, 0, 0))
        self.material = bpy.data.materials.new("Plates")
        self.tree = Tree(self.material)
        turns = 2 * math.pi * (np.arange(_ROWS) + 0.3) / _ROWS
        normals = [_direction(math.radians(theta), turn) for turn in turns for theta in _VIEWS]
        self.plates = stage.mesh(*_plates(normals), self.material, "Plates")
        self.plates.visible_shadow = False
        camera = stage.camera((0, 0, 50), (0, 0, 0)).data
        camera.type, camera.ortho_scale, camera.clip_end = "ORTHO", len(_VIEWS), 1000
        self.sun = stage.sharp_sun()

    def assert_angles(self, feature, shader, most=_MOST):
        """`shader` makes the nodes; `most`: per cent that a plate may be off."""
        self.tree.nodes.clear()
        self.tree.end(shader())
        theirs, ours = self._colors("CYCLES"), self._colors("VELOUR")
        error = (ours - theirs) / np.maximum(theirs, 0.01 * theirs.mean())
        worst = 100 * float(np.abs(error).max())
        word = "honored" if most == _MOST else "approximated"
        record_row(f"{feature}, at all angles", word, percent=worst, z=None)
        lit = (theirs > 0.01 * theirs.mean()).mean()
        self.assertGreater(lit, 0.15, f"{feature}: few plates show anything.")
        self.assertLess(worst, most, f"{feature}: per cent off by sun, row and column:\n{_rounded(error)}")

    def _colors(self, engine):
        """[suns x rows x columns x 3]: the middle of each plate."""
        return np.stack([self._colors_under(engine, degrees) for degrees in _SUNS])

    def _colors_under(self, engine, degrees):
        self.sun.rotation_euler = (0, math.radians(degrees), 0.4)
        picture = self.pictures(engine)[0, ..., :3]
        side = self.effort.width // len(_VIEWS)
        cells = picture.reshape(_ROWS, side, len(_VIEWS), side, 3)
        return cells[:, 3:-3, :, 3:-3].mean(axis=(1, 3))


def _direction(theta, phi):
    return np.array([math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)])


def _plates(normals):
    """Corners and faces; a plate's corners lie in its plane, however deep that is."""
    corners, faces = [], []
    for i, normal in enumerate(normals):
        x, y = i % len(_VIEWS) - len(_VIEWS) / 2, _ROWS / 2 - 1 - i // len(_VIEWS)
        faces.append(tuple(range(len(corners), len(corners) + 4)))
        for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1)):
            depth = -(normal[0] * (dx - 0.5) + normal[1] * (dy - 0.5)) / normal[2]
            corners.append((x + dx, y + dy, depth))
    return corners, faces


def _rounded(error):
    return np.array2string(100 * error.max(axis=-1), precision=2, suppress_small=True)


class Principled(Plates):
    def _assert_angles(self, feature, distribution=None, most=_MOST, **inputs):
        settings = {"distribution": distribution} if distribution else {}
        self.assert_angles(
            f"Principled BSDF: {feature}",
            lambda: self.tree.node("ShaderNodeBsdfPrincipled", settings=settings, **inputs),
            most,
        )

    def test_default(self):
        self._assert_angles("as it comes")

    def test_dielectrics(self):
        for specular in (0.0, 0.5, 1.0):
            for roughness in ROUGH:
                feature = f"specular {specular:g}, roughness {roughness:g}"
                self._assert_angles(feature, Base_Color=_GOLD, Specular=specular, Roughness=roughness)

    def test_metals(self):
        for metallic in (0.4, 1.0):
            for roughness in ROUGH:
                feature = f"metallic {metallic:g}, roughness {roughness:g}"
                self._assert_angles(feature, Base_Color=_GOLD, Metallic=metallic, Roughness=roughness)

    def test_single_scattering(self):
        self._assert_angles("GGX, roughness 0.8", "GGX", Base_Color=_GOLD, Metallic=0.5, Roughness=0.8)

    def test_specular_tint(self):
        tint = 0.7 if bpy.app.version < (4, 0, 0) else (0.9, 0.3, 0.5, 1)
        for metallic in (0.0, 0.6):
            feature = f"specular tint, metallic {metallic:g}"
            self._assert_angles(
                feature, Base_Color=_GOLD, Metallic=metallic, Specular=1.0, Specular_Tint=tint
            )

    def test_clear_coats(self):
        if bpy.app.version >= (4, 0, 0):
            self.skipTest("since 4.0 a coat has another formula")
        for weight, roughness in ((1.0, 0.2), (0.5, 0.6), (1.0, 1.0)):
            feature = f"clear coat {weight:g}, roughness {roughness:g}"
            coat = {"Clearcoat": weight, "Clearcoat_Roughness": roughness}
            self._assert_angles(feature, Base_Color=_GOLD, Roughness=0.7, **coat)

    def test_sheen(self):
        if bpy.app.version < (4, 0, 0):
            for tint in (0.0, 0.7):
                feature = f"sheen, tint {tint:g}"
                self._assert_angles(feature, Base_Color=_GOLD, Metallic=0.2, Sheen=1.0, Sheen_Tint=tint)
            return
        for roughness in (0.3, 0.6, 1.0):
            sheen = {"Sheen_Weight": 1.0, "Sheen_Roughness": roughness, "Sheen_Tint": (1, 0.5, 0.4, 1)}
            feature = f"sheen, roughness {roughness:g}"
            self._assert_angles(feature, Base_Color=_GOLD, **sheen)

    def test_coats(self):
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 a coat has another formula")
        tint = (0.9, 0.5, 0.2, 1)
        for weight, roughness, index in ((1.0, 0.2, 1.5), (0.4, 0.6, 1.5), (1.0, 0.4, 2.5)):
            for metallic in (0.0, 1.0):
                coat = {"Coat_Weight": weight, "Coat_Roughness": roughness, "Coat_IOR": index}
                feature = f"coat {weight:g}, roughness {roughness:g}, IOR {index:g}, metallic {metallic:g}"
                self._assert_angles(
                    feature, Base_Color=_GOLD, Metallic=metallic, Roughness=0.6, Coat_Tint=tint, **coat
                )

    def test_index_of_refraction(self):
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 it is of transmission alone")
        for index, level in ((1.25, 0.5), (2.4, 0.5), (2.0, 0.8), (0.8, 0.5)):
            for roughness in (0.3, 0.8):
                feature = f"IOR {index:g}, level {level:g}, roughness {roughness:g}"
                self._assert_angles(feature, IOR=index, Specular=level, Roughness=roughness)


class Linked(Plates):
    """Inputs that nodes provide, with a value of its own for each plate."""

    def _of_plate(self, axis, low, high):
        """A number from `low` to `high` by the plate's column (X) or row (Y)."""
        place = self.tree.node("ShaderNodeTexCoord", "Object")
        apart = self.tree.node("ShaderNodeSeparateXYZ", axis, Vector=place)
        whole = self.tree.node("ShaderNodeMath", settings={"operation": "FLOOR"}, Value=apart)
        count = len(_VIEWS) if axis == "X" else _ROWS
        limits = {"From_Min": -count / 2, "From_Max": count / 2 - 1, "To_Min": low, "To_Max": high}
        return self.tree.node("ShaderNodeMapRange", Value=whole, **limits)

    def _color_of_plate(self):
        parts = {"X": self._of_plate("X", 0.9, 0.2), "Y": self._of_plate("Y", 0.3, 1.0), "Z": 0.5}
        return self.tree.node("ShaderNodeCombineXYZ", **parts)

    def _shader(self, **inputs):
        return self.tree.node("ShaderNodeBsdfPrincipled", settings={"distribution": "GGX"}, **inputs)

    def test_specular(self):
        def shader():
            inputs = {"Specular": self._of_plate("X", 0.0, 1.0), "Base_Color": (0.1, 0.1, 0.1, 1)}
            if bpy.app.version >= (4, 0, 0):
                inputs |= {"Specular_Tint": self._color_of_plate(), "IOR": self._of_plate("Y", 0.8, 2.2)}
            return self._shader(**inputs)

        self.assert_angles("Principled BSDF: specular, linked", shader)

    def test_coat_and_sheen(self):
        is_newer = bpy.app.version >= (4, 0, 0)

        def shader():
            weight, roughness = self._of_plate("Y", 0.0, 1.0), self._of_plate("X", 0.8, 0.3)
            if not is_newer:
                return self._shader(Clearcoat=weight, Clearcoat_Roughness=roughness, Sheen=weight)
            return self._shader(
                Coat_Weight=weight,
                Coat_Roughness=roughness,
                Coat_IOR=self._of_plate("X", 1.3, 2.0),
                Coat_Tint=self._color_of_plate(),
                Sheen_Weight=self._of_plate("X", 0.0, 1.0),
                Sheen_Roughness=self._of_plate("Y", 0.4, 1.0),
                Sheen_Tint=self._color_of_plate(),
            )

        self.assert_angles("Principled BSDF: coat and sheen, linked", shader)

    def test_coat_normal(self):
        """The coat alone is tilted, or all but the coat."""
        coat = "Coat" if bpy.app.version >= (4, 0, 0) else "Clearcoat"
        weight = f"{coat}_Weight" if coat == "Coat" else coat
        for name in (f"{coat}_Normal", "Normal"):

            def shader(name=name):
                own = self.tree.node("ShaderNodeNewGeometry", "Normal")
                tilted = self.tree.node("ShaderNodeVectorMath", Vector=own)
                tilted.node.inputs[1].default_value = (0.15, 0.1, 0.0)
                unit = self.tree.node(
                    "ShaderNodeVectorMath", settings={"operation": "NORMALIZE"}, Vector=tilted
                )
                return self._shader(**{weight: 1.0, f"{coat}_Roughness": 0.4, name: unit}, Roughness=0.6)

            with self.subTest(name):
                self.assert_angles(f"Principled BSDF: coat, {name.replace('_', ' ')} linked", shader)


class Sheen(Plates):
    def test_microfiber(self):
        if not hasattr(bpy.types, "ShaderNodeBsdfSheen"):
            self.skipTest("before 4.0 there is no Sheen BSDF")
        for roughness in ROUGH:
            inputs = {"Color": (0.9, 0.5, 0.3, 1), "Roughness": roughness}
            self.assert_angles(
                f"Sheen BSDF: roughness {roughness:g}",
                lambda inputs=inputs: self.tree.node("ShaderNodeBsdfSheen", **inputs),
            )


class Glossy(Plates):
    def _assert_angles(self, roughness, distribution):
        feature = f"Glossy BSDF: {distribution}, roughness {roughness:g}"
        self.assert_angles(feature, lambda: self.tree.glossy(roughness, distribution=distribution))

    def test_single_scattering(self):
        for roughness in ROUGH:
            self._assert_angles(roughness, "GGX")

    def test_multiple_scattering(self):
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 it is a random walk, whose values are random numbers")
        for roughness in ROUGH:
            self._assert_angles(roughness, "MULTI_GGX")
