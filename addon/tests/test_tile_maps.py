"""Maps of a tile's approximation: of its own pictures, and only where they bring them nearer."""

import numpy as np
import pytest
from velour.core import tile_maps
from velour.core.approximation import Steps
from velour.core.heights import heights_of
from velour.core.tile_maps import TileMapsJob
from velour.native import Model, Scene, Shader, Texture, TextureSlot, Tile, VelourError, votf_job

SIZE = 48


@pytest.fixture(scope="module")
def paint(model_file):
    with Model.load(model_file) as model:
        yield model


@pytest.fixture(scope="module")
def wires(paint):
    """A net of that paint: no BTF, but an outline."""
    with Tile.create("net") as tile, Scene() as scene:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, np.eye(3, 4), materials)
        scene.commit()
        options = {"texels": SIZE, "period": tile.info()["period"], "reference_height": 0}
        with votf_job(scene, paint, **options) as job:
            job.run()
            with job.result_model() as model:
                yield model


@pytest.fixture(scope="module")
def steps(wires):
    """Run to the end, with what was said meanwhile."""
    steps, said = Steps(wires, has_layers=True, masking=None), []
    while job := steps.next_job():
        job.start().wait(lambda state: said.append((state.stage, state.fraction)))
    return steps.result, said


def _job(model, approximation, **principled):
    values = approximation.principled | principled
    return TileMapsJob(model, values, approximation.diffuse, approximation.color_map)


def _made(*arguments, **principled):
    job = _job(*arguments, **principled)
    job.start().wait()
    return job.result()


def test_an_outline_gets_one(steps):
    normals = steps[0].normal_map
    assert normals.shape == (SIZE, SIZE, 3)
    np.testing.assert_allclose((normals**2).sum(-1), 1, rtol=1e-6)
    tilted = normals[..., 2] < np.cos(np.radians(20))
    assert 0.1 < tilted.mean() < 0.6


def test_the_same_again_is_the_same_to_the_bit(wires, steps):
    again = _made(wires, steps[0])
    assert again.errors[1] < 0.9 * again.errors[0]
    np.testing.assert_array_equal(again.normals, steps[0].normal_map)


def test_what_is_flat_gets_none(paint, steps):
    assert _made(paint, steps[0]).normals is None


def test_none_where_it_would_make_pictures_worse(wires, steps, monkeypatch):
    """On a net shown as a metal mirror, a normal map puts highlights where the model has none."""
    mirror = {"metallic": 1.0, "roughness": 0.1}
    found = _made(wires, steps[0], **mirror)
    assert found.errors[1] > 0.9 * found.errors[0]
    assert found.normals is None
    monkeypatch.setattr(tile_maps, "_LEAST_GAIN", -1e9)
    assert _made(wires, steps[0], **mirror).normals is not None, "that was not why"


def test_its_progress_is_told(steps):
    fractions = [fraction for stage, fraction in steps[1] if stage == "computing maps"]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1


def test_it_ends_when_it_is_cancelled(wires, steps):
    job = _job(wires, steps[0])
    job.start().cancel()
    with pytest.raises(VelourError, match="canceled"):
        job.wait()
    job._thread.join(timeout=60)
    assert not job._thread.is_alive()
    assert job._done < job._all


def _rough(scene, rough, slopes, metallic):
    """A gray surface of these roughnesses [rows x columns], with waves of these slopes."""
    shader, slot = (
        Shader.new(),
        TextureSlot(Texture.from_pixels(np.ascontiguousarray(rough[..., None], np.float32), channel=0)),
    )
    relief = TextureSlot(Texture.from_pixels(tile_maps.encoded(_waves(slopes)))) if slopes else None
    shader.add_layer(
        "principled", {"roughness": slot}, normal=relief, base_color=(0.5,) * 3, metallic=metallic
    )
    return scene.add_shader_material(shader)


def _waves(slope):
    """Normals [SIZE x SIZE x 3] of waves along x, two to a tile."""
    x = (np.arange(SIZE) + 0.5) / SIZE
    along = np.broadcast_to(slope * np.cos(4 * np.pi * x), (SIZE, SIZE))
    normals = np.dstack([-along, np.zeros_like(along), np.ones_like(along)])
    return (normals / np.linalg.norm(normals, axis=-1, keepdims=True)).astype(np.float32)


@pytest.fixture
def maps(monkeypatch):
    """Makes the maps of a metal or plastic with these roughnesses and slopes, in place of a model."""

    def make(rough, slopes=0.0, fitted=0.4, metallic=1.0):
        monkeypatch.setattr(
            Scene, "add_model_material", lambda scene, _model: _rough(scene, rough, slopes, metallic)
        )
        values = {"metallic": metallic, "roughness": fitted, "specular": 0.5}
        colors = np.full((SIZE, SIZE, 4), 0.5, np.float32)
        colors[..., 3] = 1
        job = TileMapsJob(None, values, None, colors)
        job.start().wait()
        return job.result()

    return make


def test_roughness_is_found_where_it_changes(maps):
    halves = np.full((SIZE, SIZE), 0.25)
    halves[:, SIZE // 2 :] = 0.6
    found = maps(halves)
    assert found.errors[-1] < 0.9 * found.errors[-2]
    inner = np.abs(np.arange(SIZE) % (SIZE // 2) - SIZE // 4) < SIZE // 4 - 2  # away from the borders
    np.testing.assert_allclose(found.roughness[:, inner], halves[:, inner], rtol=0.2)


def test_roughness_needs_no_map_where_the_fit_has_it(maps):
    found = maps(np.full((SIZE, SIZE), 0.4))
    assert found.roughness is None
    assert found.relative_l2 < 0.01
    assert set(found.by_view_angle) == {"5", "30", "60", "75", "85"}


def test_errors_are_those_of_another_roughness_at_each_view(maps):
    found = maps(np.full((SIZE, SIZE), 0.4), fitted=0.41)
    assert all(0.002 < error < 0.2 for error in found.by_view_angle.values()), found.by_view_angle


def test_heights_are_those_of_the_surface():
    x, y = np.meshgrid(*2 * [(np.arange(SIZE) + 0.5) / SIZE])
    wanted = 0.02 * np.sin(2 * np.pi * x) + 0.01 * np.cos(2 * np.pi * (x - 2 * y))
    along_x = 0.04 * np.pi * np.cos(2 * np.pi * x) - 0.02 * np.pi * np.sin(2 * np.pi * (x - 2 * y))
    along_y = 0.04 * np.pi * np.sin(2 * np.pi * (x - 2 * y))
    normals = np.dstack([-along_x, -along_y, np.ones_like(x)])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    np.testing.assert_allclose(heights_of(normals), wanted, atol=1e-6)
    long = np.dstack(
        [-along_x, -along_y / 3, np.ones_like(x)]
    )  # the same heights on a tile three times as long
    np.testing.assert_allclose(heights_of(long, 3.0), wanted, atol=1e-6)
    turned = np.dstack([normals[..., 1], normals[..., 0], normals[..., 2]])
    assert np.abs(heights_of(turned) - wanted).max() > 0.01, "axes may be exchanged"


def test_the_lowest_cost_may_be_at_an_end():
    costs = np.array([[0.2, 1.0, 1.1, 1.1], [3.0, 2.8, 2.5, 1.0], [4.0, 1.0, 0.0, 1.0]]).T
    np.testing.assert_allclose(tile_maps._lowest(costs), [0, 3, 2])


def test_a_relief_has_heights(maps):
    found = maps(np.full((SIZE, SIZE), 0.4), slopes=0.3, metallic=0.0)
    expected = 0.3 / (4 * np.pi)  # amplitude of waves of this slope
    assert found.height.max() == pytest.approx(expected, rel=0.15)
