"""What velour-check names as the cause of a difference, on simulated renders of three materials."""

from __future__ import annotations

import json
import struct
import zipfile

import numpy as np
import pytest
from regression import causes, check, passes_file
from regression.case import Case
from regression.comparison import compare
from regression.passes import MIXED, NOTHING, Labels, Passes
from support import judge
from velour.core import files

HEIGHT, WIDTH = 48, 64
SEEDS, REFERENCE_SEEDS, RAYS = 4, 16, 32
NAMES = ("Floor", "Ball", "Box")
CHANNELS = {"picture": 4, "shape": 4, "coordinates": 2, "albedo": 3}
RELATIVE = {"picture": 0.02, "shape": 2e-3, "coordinates": 1e-3, "albedo": 1e-3}  # noise of one render
WORLD = 32


class Scene:
    """The expectation of all passes. Objects and materials have the same names; above is the background."""

    def __init__(self):
        rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
        self.objects = np.where(rows < 36, 1, NOTHING).astype(np.int32)
        self.objects[(rows - 20) ** 2 + (columns - 16) ** 2 < 100] = 2
        self.objects[12:30, 40:56] = 3
        edges = np.zeros_like(self.objects, bool)
        edges[:, 1:] |= self.objects[:, 1:] != self.objects[:, :-1]
        edges[1:] |= self.objects[1:] != self.objects[:-1]
        self.objects[edges] = MIXED
        self.materials = self.objects.copy()
        random = np.random.default_rng(1)
        surface = (self.objects != NOTHING)[..., None]
        normal = surface * np.dstack([np.sin(rows / 9), np.cos(columns / 7), 0.5 + rows / 99])
        nearness = np.choose(self.objects.clip(0), [10, 1, 0.6, 0.7])
        self.shape = np.dstack([normal, nearness * (0.1 + rows / 999)])
        self.coordinates = surface * np.dstack([rows / 7 % 1, columns / 5 % 1])
        tiles = 0.5 + 0.4 * np.sin(rows)[..., None] * np.cos(columns)[..., None]
        self.albedo = surface * tiles * np.array([0.8, 0.6, 0.4])
        light = 0.5 + columns[..., None] / WIDTH
        sky = np.array([0.3, 0.5, 0.9]) * (1 + 0.3 * np.sin(columns / 5)[..., None])
        colors = np.where(surface, light * self.albedo + 0.05, sky)
        self.picture = np.dstack([colors, np.ones((HEIGHT, WIDTH))])
        self.world = random.uniform(0.1, 1.0, (WORLD, WORLD, 3))
        self.larger_parts = None  # labels of pixels that are no one's alone
        self.opacity = np.ones((HEIGHT, WIDTH))  # chance that a ray ends at the surface
        self.blurred = None

    def where(self, name):
        return np.abs(self.objects - 1 - NAMES.index(name)) < 0.5

    def renders(self, seed, count=SEEDS):
        """The Estimate of the picture, and its Passes."""
        random = np.random.default_rng(seed)

        def seen(name, values):
            noise = RELATIVE.get(name, 0.01) * np.abs(values)
            if name == "picture":
                noise[..., 3] = 0
            return simulated(random, values, noise, count)

        passes = {name: seen(name, getattr(self, name)) for name in CHANNELS if name != "picture"}
        full = random.random(self.objects.shape) < self.opacity ** (RAYS * count)
        numbers = {kind: np.where(full, getattr(self, kind), MIXED) for kind in ("objects", "materials")}
        where = self.opacity > 0.6
        mostly = {kind: np.where(where, getattr(self, kind), MIXED) for kind in numbers}
        mostly = mostly if self.larger_parts is None else dict.fromkeys(numbers, self.larger_parts)
        labels = {kind: Labels(numbers[kind], NAMES, mostly[kind]) for kind in numbers}
        passes |= labels | {"world": seen("world", self.world)}
        if self.blurred is not None:
            passes["blurred"] = seen("shape", self.blurred)
        return seen("picture", self.picture), Passes(**passes)


def simulated(random, mean, noise, count):
    """The Estimate from `count` renders with normal noise, without making each."""
    error = noise / np.sqrt(count)
    spread = random.chisquare(count - 1, mean.shape) / (count - 1)
    return judge.Estimate(mean + error * random.standard_normal(mean.shape), error**2 * spread, count)


def _exposure(scene):
    scene.picture[..., :3] *= 1.01


def _lamp(scene):
    scene.picture[:36, :, :3] *= 1 + 0.2 * np.linspace(0, 1, WIDTH)[:, None]


def _world(scene):
    scene.world = np.roll(scene.world, 1, axis=1)
    scene.picture[36:, :, :3] = np.roll(scene.picture[36:, :, :3], 1, axis=1)
    scene.picture[:36, :, :3] *= 1.003


def _brighter_world(scene):
    scene.world *= 1.05
    scene.picture[..., :3] *= 1.05


def _background(scene):
    """A world that has changed where the mirror ball does not show it."""
    scene.picture[38:, 4:20, :3] *= 1.2


def _moved(scene):
    scene.shape[scene.where("Ball")] += (0.05, 0, 0, 0.01)
    scene.picture[scene.where("Ball"), :3] *= 1.1
    scene.picture[4:9, 8:24, :3] *= 0.9  # its shadow


def _silhouette(scene):
    """Two more columns of the box, whose front stays where it was."""
    for name in (*CHANNELS, "objects", "materials"):
        values = getattr(scene, name)
        values[12:30, 56:58] = values[12:30, 54:56]


def _edge(scene):
    """Less than a pixel of the edge of the box."""
    edges = scene.objects == MIXED
    edges[:, :36] = edges[32:] = False
    scene.shape[edges] *= 0.5


def _uv(scene):
    scene.coordinates[scene.where("Ball")] += 0.02
    scene.albedo[scene.where("Ball")] *= 1.1
    scene.picture[scene.where("Ball"), :3] *= 1.1


def _texture(scene):
    """The same values in other places."""
    mask = scene.where("Box")
    scene.albedo[mask] = scene.albedo[mask][::-1]
    scene.picture[mask] = scene.picture[mask][::-1]


def _refit(scene):
    scene.albedo[scene.where("Ball")] *= 1.01
    scene.picture[scene.where("Ball"), :3] *= 1.03
    scene.picture[4:9, 8:24, :3] *= 1.02  # reflected onto the floor


def _emission(scene):
    scene.picture[scene.where("Box"), :3] += 0.1


def _exchanged(scene):
    mask = scene.where("Box")
    scene.materials[mask] = 1
    scene.picture[mask, :3] *= 0.8


def _transparent(scene):
    mask = scene.where("Box")
    scene.objects[mask] = scene.materials[mask] = MIXED
    scene.picture[mask, :3] *= 0.7
    scene.shape[mask] *= 0.6


CHANGES = {
    _exposure: ("exposure", ()),
    _lamp: ("light", ()),
    _world: ("world", ()),
    _brighter_world: ("world", ()),
    _background: ("world", ()),
    _moved: ("geometry", ("Ball",)),
    _silhouette: ("geometry", ("Box",)),
    _edge: ("geometry", ("Box",)),
    _uv: ("geometry", ("Ball",)),
    _texture: ("material", ("Box",)),
    _refit: ("material", ("Ball",)),
    _emission: ("material", ("Box",)),
    _exchanged: ("material", ("Box", "Floor")),
    _transparent: ("material", ("Box",)),
}
WORDS = {
    _uv: "UV map of object 'Ball'",
    _texture: "its texture or model",
    _exposure: "times 1.0",
    _brighter_world: "light times 1.0",
    _refit: "albedo times 1.0",
    _exchanged: "exchanged",
    _transparent: "transparency",
}


def known():
    return Scene().renders(1, REFERENCE_SEEDS)


def judged(scene, seed=2, before=None):
    """`before`: the scene of the reference (Scene())."""
    picture, passes = scene.renders(seed)
    reference, its_passes = (before or Scene()).renders(1, REFERENCE_SEEDS)
    comparison = compare(picture, reference, 50, (passes, its_passes))
    return comparison, causes.find(picture, reference, (passes, its_passes))


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__[1:])
def test_change_is_found_and_named(change):
    kind, names = CHANGES[change]
    for seed in range(2, 12):
        scene = Scene()
        change(scene)
        comparison, found = judged(scene, seed)
        assert not comparison.agrees
        assert [cause.kind for cause in found] == [kind], found
        assert set(found[0].names[:2]) == set(names)
        assert WORDS.get(change, "") in str(found[0])


def _seen_through(opacity, name="Box"):
    """A scene whose material lets some rays through; of a range, more from left to right."""
    scene = Scene()
    mask = scene.where(name)
    scene.opacity[mask] = np.interp(np.argwhere(mask)[:, 1], (40, 55), opacity)
    return scene


@pytest.mark.parametrize(
    "opacity", [(0.95, 0.95), (0.99, 0.99), (0.996, 0.996), (0.9986, 0.9986), (1, 0.99), (1, 0.9)]
)
def test_nearly_opaque_material_is_not_named(opacity):
    """Far fewer pixels show nothing else in 16 renders than in 4."""
    for seed in range(2, 22):
        before, scene = _seen_through(opacity), _seen_through(opacity)
        _lamp(scene)
        _, found = judged(scene, seed, before)
        assert [cause.kind for cause in found] == ["light"], found


@pytest.mark.parametrize("opacities", [(1, 0.9), (1, 0.3), (0.9995, 0.9), (0.9, 1), (0.3, 1), (0.99, 1)])
def test_another_opacity_is_named(opacities):
    before, after = (_seen_through((each, each)) for each in opacities)
    for seed in range(2, 12):
        _lamp(after)
        _, found = judged(after, seed, before)
        assert found[0].kind == "material", found
        assert str(found[0]).endswith("'Box', its transparency")


def test_two_causes_are_both_named():
    scene = Scene()
    _refit(scene)
    _world(scene)
    _, found = judged(scene)
    assert [cause.kind for cause in found] == ["material", "world"]


def test_material_and_exposure_are_both_named():
    scene = Scene()
    _texture(scene)
    _exposure(scene)
    _, found = judged(scene)
    assert [cause.kind for cause in found] == ["material", "exposure"]


def _open_lens():
    """Each pixel of the ball shows other things, too."""
    scene = Scene()
    scene.larger_parts = scene.objects.copy()
    for labels in (scene.objects, scene.materials):
        labels[labels == 2] = MIXED
    scene.blurred = 0.9 * scene.shape
    return scene


def test_object_that_fills_no_pixel_alone_is_named():
    scene = _open_lens()
    mask = scene.larger_parts == 2
    scene.albedo[mask] *= 1.05
    scene.picture[mask, :3] *= 1.05
    _, found = judged(scene, before=_open_lens())
    assert [(cause.kind, cause.names) for cause in found] == [("material", ("Ball",))]


def test_depth_of_field_is_named():
    scene = _open_lens()
    scene.blurred *= 1.05
    scene.picture[10:30] *= 1.1
    _, found = judged(scene, before=_open_lens())
    assert len(found) == 1
    assert str(found[0]).startswith("geometry: depth of field or motion blur")
    scene.blurred = None
    _, found = judged(scene, before=_open_lens())
    assert str(found[0]) == "geometry: only one of both has depth of field or motion blur"


def test_camera_is_named_where_a_plane_slides_along_itself():
    scene = Scene()
    scene.coordinates[scene.where("Floor")] += 0.02
    for name in ("Ball", "Box"):
        scene.shape[scene.where(name)] *= 1.02
    _, found = judged(scene)
    assert [str(cause) for cause in found] == ["geometry: all visible objects, or the camera"]


def test_world_that_is_all_light_is_named_so():
    for seed in range(2, 12):
        scene = Scene()
        _brighter_world(scene)
        _, found = judged(scene, seed)
        assert [cause.kind for cause in found] == ["world"]
        assert str(found[0]).endswith("and all light of the scene with it")


def test_world_and_exposure_of_other_factors_are_both_named():
    """0.5 % apart, which is 17 standard errors."""
    for seed in range(2, 12):
        scene = Scene()
        _brighter_world(scene)
        scene.picture[..., :3] *= 1.005
        _, found = judged(scene, seed)
        assert [cause.kind for cause in found] == ["world", "exposure"], found
        assert "its light times 1.0" in str(found[0])
        assert not str(found[0]).endswith("with it")
        assert "unlike the world" in str(found[1])


def test_turned_world_is_not_said_to_scale_all_light():
    scene = Scene()
    scene.world = np.roll(scene.world, 1, axis=1)
    _exposure(scene)
    _, found = judged(scene)
    assert [str(cause) for cause in found] == ["world: its directions or colors (turned, or another picture)"]


def test_camera_is_named_where_everything_moves():
    scene = Scene()
    scene.shape[scene.objects > 0] *= 1.02
    _, found = judged(scene)
    assert str(found[0]) == "geometry: all visible objects, or the camera"


def test_no_cause_is_made_up():
    """Control: without a change the tests name nothing, at their level of one in a thousand each."""
    found = [cause for seed in range(60) for cause in judged(Scene(), 100 + seed)[1]]
    # 60 pictures with eight tests at 1e-3 each: 3 or more in one of 80 cases.
    assert sum(cause.kind != "unknown" for cause in found) <= 2


def false_alarms(runs, pictures=50, errors=1.0):
    """How many of `runs` runs of `pictures` unchanged scenes fail. `errors`: factor on the stated errors."""
    scene, alarms = Scene(), 0
    for name in (*CHANNELS, "objects", "materials", "opacity"):  # a part that has all kinds of pixels
        setattr(scene, name, getattr(scene, name)[:32, 8:40])
    for run in range(runs):
        agree = True
        for picture in range(pictures):
            ours, passes = scene.renders((5, run, picture))
            reference, its_passes = scene.renders((6, run, picture), REFERENCE_SEEDS)
            reference = reference._replace(variance=errors**2 * reference.variance)
            ours = ours._replace(variance=errors**2 * ours.variance)
            agree &= compare(ours, reference, pictures, (passes, its_passes)).agrees
        alarms += not agree
    return alarms


def test_chance_seldom_fails_a_run():
    """Ten runs of 50 scenes: none fails in 99 of 100 cases at a level of 0.001."""
    assert false_alarms(10) == 0


@pytest.mark.long
def test_chance_fails_one_run_in_a_thousand():
    # At a level of 0.001, four or more in 1000 runs are one case in fifty.
    assert false_alarms(1000) <= 3


def test_errors_that_are_too_small_fail_runs():
    """The control: renders and references said to be half as noisy as they are."""
    assert false_alarms(2, errors=0.5) == 2


@pytest.fixture
def stored(tmp_path):
    """A reference with its passes."""
    path = tmp_path / "shot.exr"
    check.write(path, check.Renders(*known()))
    return path


def judge_stored(path, renders=None):
    case = Case("shot", path.with_suffix(".blend"), {None: path}, path.parent / "work")
    return check.judged(case, None, check.Renders(*(renders or Scene().renders(2))), 1)


def test_passes_are_what_was_written(stored):
    _, passes = known()
    found = passes_file.read(stored, (HEIGHT, WIDTH))
    assert found.blurred is None
    np.testing.assert_array_equal(found.objects.mostly, passes.objects.mostly)
    np.testing.assert_array_equal(found.objects.numbers, passes.objects.numbers)
    assert found.materials.names == NAMES
    for name in ("shape", "coordinates", "albedo", "world"):
        mean, expected = getattr(found, name).mean, getattr(passes, name).mean
        assert np.abs(mean - expected).max() <= 2**-17 * 1.01 * np.abs(expected).max()
    outcome = judge_stored(stored)
    assert (outcome.passed, outcome.notes, outcome.causes) == (True, [], [])


def test_stored_reference_names_the_cause(stored):
    scene = Scene()
    _exposure(scene)
    outcome = judge_stored(stored, scene.renders(2))
    assert not outcome.passed
    assert outcome.line.startswith("FAILED: shot: exposure: all colors times 1.0")
    assert "--update" in outcome.sentence


FAULTS = {
    "missing": "has no shot.passes.npz",
    "another picture": "belongs to another shot.exr",
    "cut": "cannot be read",
    "damaged": "cannot be read",
    "no archive": "cannot be read",
    "newer": "has version 3, not 2",
    "size": "cannot be read",
    "not finite": "cannot be read",
}


@pytest.mark.parametrize("fault", FAULTS)
def test_reference_without_usable_passes_is_compared_without_causes(stored, fault):
    """As former references, and those whose update was cut off between two files."""
    path = passes_file.passes_path(stored)
    if fault == "missing":
        path.unlink()
    elif fault == "another picture":
        kept = path.read_bytes()
        check.write(stored, check.Renders(*Scene().renders(9, REFERENCE_SEEDS)))
        path.write_bytes(kept)
    elif fault == "cut":
        path.write_bytes(path.read_bytes()[:-100])
    elif fault == "damaged":
        _damage(path)
    elif fault == "no archive":
        path.write_text("no passes")
    else:
        _spoil(path, fault)
    outcome = judge_stored(stored)
    assert outcome.passed
    assert len(outcome.notes) == 1
    assert FAULTS[fault] in outcome.notes[0]
    assert "--update" in outcome.notes[0]
    scene = Scene()
    _exposure(scene)
    outcome = judge_stored(stored, scene.renders(2))
    assert (outcome.passed, outcome.causes) == (False, [])


def _damage(path):
    """The compressed numbers of the first array begin with what no compressor writes."""
    contents = bytearray(path.read_bytes())
    with zipfile.ZipFile(path) as archive:
        begin = archive.infolist()[1].header_offset
    lengths = struct.unpack_from("<HH", contents, begin + 26)  # of the name, and of what follows it
    contents[begin + 30 + sum(lengths)] = 0xFF
    path.write_bytes(contents)


def _spoil(path, fault):
    with np.load(path) as arrays:
        found = {name: arrays[name] for name in arrays.files}
    head = json.loads(found["head"].tobytes())
    if fault == "newer":
        head["version"] = 3
    elif fault == "size":
        found["albedo"] = found["albedo"][1:]
    else:
        found["shape"][0, 0, 0] = np.nan
    found["head"] = np.frombuffer(json.dumps(head).encode(), np.uint8)
    files.write_atomic(path, lambda temporary: np.savez(temporary, **found))
