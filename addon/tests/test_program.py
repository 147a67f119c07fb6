"""Computed inputs through the wrapper classes: planes whose pixels are known."""

from __future__ import annotations

import math

import numpy as np
import planes
import pytest
from planes import SIDE
from velour.native import (
    Instruction,
    Output,
    Program,
    Scene,
    Shader,
    Texture,
    TextureSlot,
    VelourError,
)

PLACES = (np.arange(SIDE) + 0.5) / SIDE  # of pixels, from 0 to 1


def _rendered(shader, to_world=None, sun=None, transparent=False, spp=64):
    with Scene() as scene:
        to_world = np.eye(4) if to_world is None else to_world
        scene.add_instance(planes.add(scene), to_world, [scene.add_shader_material(shader)])
        if sun is not None:
            scene.add_light("sun", (1, 1, 1), sun)
        return planes.seen(scene, spp=spp, split=1, strategy="mis", transparent=int(transparent))


def _source(kind, number=0, shift="none", output=0):
    return Instruction("source", (kind, number, shift), (), output)


def _shown(kind, **settings):
    """Pixels of an emission of a source."""
    with (
        Program.new(3, [], [_source(kind)], [Output(0, "color")]) as program,
        program.texture(0) as texture,
        Shader.new() as shader,
    ):
        shader.add_layer("emission", {"base_color": TextureSlot(texture)})
        return _rendered(shader, **settings)[..., :3]


def test_coordinates():
    uv = _shown("uv")
    np.testing.assert_allclose(uv[..., 0], np.broadcast_to(PLACES, (SIDE, SIDE)), atol=2e-3)
    np.testing.assert_allclose(uv[..., 1], np.broadcast_to(PLACES[:, None], (SIDE, SIDE)), atol=2e-3)


def test_spaces():
    """A plane scaled by 2 and moved: the camera sees its middle."""
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 0.5, 0.25, 1.5
    world, own = _shown("position", to_world=matrix), _shown("object_position", to_world=matrix)
    np.testing.assert_allclose(world[0, :, 0], 2 * PLACES - 1, atol=4e-3)
    np.testing.assert_allclose(world[..., 2], 1.5, rtol=1e-5)
    np.testing.assert_allclose(own[0, :, 0], (2 * PLACES - 1 - 0.5) / 2, atol=4e-3)
    np.testing.assert_allclose(own[..., 2], 0, atol=1e-6)
    for kind in ("normal", "object_normal", "geometric_normal", "incoming"):
        np.testing.assert_allclose(_shown(kind, to_world=matrix), [[(0, 0, 1)] * SIDE] * SIDE, atol=1e-6)
    np.testing.assert_array_equal(_shown("backfacing", to_world=matrix), 0)


def test_backs():
    """The plane turned over: normals stay on the viewer's side."""
    matrix = np.diag([1.0, -1.0, -1.0, 1.0])
    np.testing.assert_allclose(_shown("normal", to_world=matrix)[..., 2], 1, atol=1e-6)
    np.testing.assert_allclose(_shown("object_normal", to_world=matrix)[..., 2], -1, atol=1e-6)
    np.testing.assert_array_equal(_shown("backfacing", to_world=matrix)[..., 0], 1)


def _tilts(normals, turned=False):
    """Changes of the object-space normal along x at shifted points, for a plane with these corner normals."""
    steps = [
        _source("object_normal"),
        *(_source("object_normal", shift=shift, output=3 * i) for i, shift in enumerate("xy", 1)),
        *(Instruction("vector_math", ("subtract",), (3 * i, 0, 0, 0), 5 + 4 * i) for i in (1, 2)),
        Instruction("vector_math", ("absolute",), (9, 0, 0, 0), 17),
        Instruction("vector_math", ("absolute",), (13, 0, 0, 0), 21),
        Instruction("vector_math", ("add",), (17, 21, 0, 0), 25),
    ]
    to_world = np.diag([1.0, -1.0, -1.0, 1.0]) if turned else np.eye(4)
    with (
        Program.new(29, [], steps, [Output(25, "color")]) as program,
        program.texture(0) as texture,
        Shader.new() as shader,
        Scene() as scene,
    ):
        shader.add_layer("emission", {"base_color": TextureSlot(texture)})
        mesh = planes.add(scene, corner_normals=normals)
        scene.add_instance(mesh, to_world, [scene.add_shader_material(shader)])
        return planes.seen(scene, spp=16, split=1, strategy="mis")[..., 0]


def test_shifted_normals():
    """They vary where the mesh is smooth; on a flat one, they are the same bits."""
    up = np.broadcast_to(np.float32((0, 0, 1)), (2, 3, 3))
    np.testing.assert_array_equal(_tilts(np.ascontiguousarray(up)), 0)
    tilted = np.array(((0.6, 0.0, 0.8), (-0.6, 0.0, 0.8)), np.float32)
    smooth = np.stack((tilted[[0, 1, 1]], tilted[[0, 1, 0]]))  # from left to right
    for turned in (False, True):
        tilts = _tilts(np.ascontiguousarray(smooth), turned)
        assert tilts.min() > 0.01, tilts
        assert tilts.max() < 1.0, tilts


def _is_left(output=3):
    """1 where u is below a half: register 8."""
    less = Instruction("math", ("less_than", 0), (2, 0, 1), 5)
    return [0.5, 0.0], [_source("uv", output=2), less], [Output(5, "number")]


def test_opacity():
    """Camera rays pass where a program says so."""
    constants, steps, outputs = _is_left()
    with (
        Program.new(6, constants, steps, outputs) as program,
        program.texture(0) as texture,
        Shader.new() as shader,
    ):
        shader.add_layer("emission", base_color=(1, 0.5, 0))
        shader.weigh_layer("share", texture=texture)
        shader.add_layer("transparent", base_color=(1, 1, 1))
        shader.weigh_layer("rest", texture=texture)
        pixels = _rendered(shader, transparent=True)
    left = (PLACES < 0.5).astype(np.float32)
    np.testing.assert_array_equal(pixels[..., 3], np.broadcast_to(left, (SIDE, SIDE)))
    np.testing.assert_allclose(pixels[..., 1], np.broadcast_to(0.5 * left, (SIDE, SIDE)), atol=1e-6)


def test_images_are_read_at_a_point():
    """A fine checker has no gray, in however small a picture, so that thresholds see what is there."""
    checker = (np.indices((1024, 1024)).sum(axis=0) % 2).astype(np.float32)[..., None]
    with Texture.from_pixels(checker, channel=0, filter="closest") as image:
        steps = [_source("uv"), Instruction("image", (0,), (0,), 3)]
        with (
            Program.new(6, [], steps, [Output(3, "color")], [image]) as program,
            program.texture(0) as texture,
            Shader.new() as shader,
        ):
            shader.add_layer("emission", {"base_color": TextureSlot(texture)})
            pixels = _rendered(shader, spp=1)[..., 0]
        assert set(np.unique(pixels)) <= {0.0, 1.0}


@pytest.mark.parametrize("strength", [1.0, 0.5])
def test_bump(strength):
    """A height of 0.3 x tilts the normal, and sunlight with it."""
    slope, angle = 0.3, 0.6
    constants = [strength, 1.0, slope]
    steps, at = [], len(constants)
    heights = []
    for shift in ("none", "x", "y"):
        steps += [
            _source("position", shift=shift, output=at),
            Instruction("math", ("multiply", 0), (at, 2, 0), at + 3),
        ]
        heights.append(at + 3)
        at += 4
    for kind in ("normal", "step_x", "step_y"):
        steps.append(_source(kind, output=at))
        at += 3
    steps.append(Instruction("bump", (), (0, 1, *heights, at - 9, at - 6, at - 3), at))
    sun = np.array(
        [[math.cos(angle), 0, math.sin(angle), 0], [0, 1, 0, 0], [-math.sin(angle), 0, math.cos(angle), 0]]
    )
    with (
        Program.new(at + 3, constants, steps, [Output(at, "normal")]) as program,
        program.texture(0) as texture,
        Shader.new() as shader,
    ):
        shader.add_layer(
            "diffuse",
            normal=TextureSlot(texture),
            normal_correction="as-it-is",
            base_color=(0.5,) * 3,
            roughness=0.0,
        )
        pixels = _rendered(shader, sun=sun)[..., 0]
    raised = np.array((-slope, 0, 1)) / math.hypot(slope, 1)
    normal = strength * raised + (1 - strength) * np.array((0, 0, 1))
    cosine = normal @ (math.sin(angle), 0, math.cos(angle)) / np.linalg.norm(normal)
    np.testing.assert_allclose(pixels, 0.5 / math.pi * cosine, rtol=2e-3)


def test_refusals():
    steps = [Instruction("math", ("add", 0), (0, 1, 7), 2)]
    with pytest.raises(VelourError, match=r"instruction 0 \(math\): input 2 needs registers 7 to 7"):
        Program.new(3, [1.0, 2.0], steps, [])
    with pytest.raises(VelourError, match="operation is 'subtract'"):
        Program.new(3, [1.0, 2.0], [Instruction("subtract", (), (0, 1), 2)], [])
    with Program.new(1, [1.0], [], [Output(0, "number")]) as program:
        with pytest.raises(VelourError, match="has no output 1; it has 1"):
            program.texture(1)
        with (
            Program.new(1, [1.0], [], [Output(0, "number")]) as other,
            program.texture(0) as one,
            other.texture(0) as another,
            Shader.new() as shader,
        ):
            shader.add_layer("glossy", {"roughness": TextureSlot(one)})
            with pytest.raises(VelourError, match="two programs"):
                shader.weigh_layer("share", texture=another)
            with pytest.raises(VelourError, match="which is not a normal"):
                shader.add_layer("diffuse", normal=TextureSlot(one))
