"""scripts/presets: the table, and one small preset from the goniometer to its picture."""

from __future__ import annotations

import json
import subprocess
import sys
import uuid
from collections import Counter
from pathlib import Path

import numpy as np
import presets
import pytest
from command_line import environment
from conftest import ADDONS, ROOT
from presets import CATALOGS, GROUP_CATALOGS, PRESETS, Weave
from velour.core import presets as library
from velour.native import Model, Tile, images

SMALL = presets.Sizes(rays=60_000, yarn_rays=60_000, texels=4, directions=20, samples=1, outline_texels=32)


def test_has_what_it_is_to_have():
    assert Counter(preset.catalog for preset in PRESETS) == {
        "Metals": 10,
        "Paints": 6,
        "Plastics and Papers": 5,
        "Matt Whites and Clays": 4,
        "Cloths": 8,
        "Leathers": 2,
    }
    for preset in PRESETS:
        assert isinstance(preset.made_of, Weave) or preset.catalog not in ("Cloths", "Leathers"), preset.name
        assert preset.description, preset.name
        assert preset.tags, preset.name


def test_names_and_catalogs_are_told_apart():
    assert len({preset.name.lower() for preset in PRESETS}) == len(PRESETS)
    numbers = [*CATALOGS.values(), *GROUP_CATALOGS.values()]
    assert len({str(uuid.UUID(number)) for number in numbers}) == len(numbers) == 2 * len(CATALOGS)
    assert CATALOGS.keys() == GROUP_CATALOGS.keys()
    assert not [preset.name for preset in PRESETS if "," in preset.name]  # of --only


def test_numbers_are_those_of_surfaces():
    """An albedo of 1 or a negative index is no material; tiles have a material a yarn."""
    for preset in PRESETS:
        made_of = preset.made_of
        for surface in made_of.yarns if isinstance(made_of, Weave) else (made_of,):
            assert all(0 <= albedo < 0.95 for albedo in surface.base_albedo), preset.name
            assert surface.ior == 0 or 1.3 < surface.ior < 1.7, preset.name
        if isinstance(made_of, Weave):
            with Tile.create(made_of.kind, **made_of.shape) as tile:
                assert len(tile.info()["materials"]) == len(made_of.yarns), preset.name


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    return presets.Workshop(tmp_path_factory.mktemp("presets"), SMALL, threads=2)


def _preset(name):
    return next(preset for preset in PRESETS if preset.name == name)


@pytest.mark.long
def test_a_cloth_has_a_look_and_an_outline_and_is_made_once(workshop):
    tulle = _preset("Tulle")
    assert not workshop.is_built(tulle)
    path = workshop.build(tulle)
    with Model.load(path) as model:
        info = model.info()
    assert info["tile_metres"] == pytest.approx([0.008, 0.008])
    assert 0.3 < json.loads(path.with_suffix(".json").read_text())["coverage"] < 0.9
    assert not [*workshop.work.glob("capture-*")]
    before = path.stat().st_mtime_ns
    assert workshop.is_built(tulle)
    assert workshop.build(tulle) == path
    assert path.stat().st_mtime_ns == before
    # Other numbers are another model; --fresh makes the same one anew, and once.
    assert presets.Workshop(workshop.work, SMALL._replace(texels=5), 2).model_path(tulle) != path
    fresh = presets.Workshop(workshop.work, SMALL, 2, fresh=True)
    assert fresh.model_path(tulle) == path
    assert not fresh.is_built(tulle)


def test_a_picture_shows_the_material_on_a_backdrop(workshop):
    gold = _preset("Polished Gold")
    pixels = presets.picture(gold, workshop.build(gold), spp=8)
    assert (pixels.shape, pixels.dtype) == ((256, 256, 4), np.float32)
    assert 0 <= pixels.min() < pixels.max() <= 1
    assert (pixels[..., 3] == 1).all()
    corner, ball = pixels[:20, :20, :3].mean(axis=(0, 1)), pixels[80:176, 80:176, :3].mean(axis=(0, 1))
    assert np.ptp(corner) < 0.01  # gray
    assert ball[0] > ball[1] > ball[2] + 0.1  # gold


def test_the_script_refuses_what_is_not_there():
    done = subprocess.run(
        [sys.executable, "-P", ROOT / "scripts/lib/presets.py", "--only", "Mithril"],
        capture_output=True,
        text=True,
        env=environment(PYTHONPATH=f"{ADDONS}:{ROOT / 'scripts/lib'}"),
    )
    assert done.returncode == 1
    assert "'mithril'" in done.stderr
    assert "Polished Gold" in done.stderr


def test_committed_presets_are_those_of_the_table():
    """Whoever changes the table runs scripts/presets."""
    listed = library.listed(ROOT / "addon/presets")
    assert [entry.name for entry in listed] == [preset.name for preset in PRESETS]
    size = sum(path.stat().st_size for path in (ROOT / "addon/presets").iterdir())
    assert size < library.MOST_BYTES / 2  # the asset library holds the models once more
    for entry, preset in zip(listed, PRESETS, strict=True):
        assert (entry.catalog, entry.tags, entry.repeats) == (preset.catalog, preset.tags, preset.repeats)
        assert images.read_picture(entry.picture).shape == (256, 256, 3)
        with Model.load(entry.model) as model:
            assert ("texels" in model.info()) == isinstance(preset.made_of, Weave), preset.name


def test_a_library_is_made_once_also_beside_its_models(tmp_path, monkeypatch):
    made = []

    def blender(_script, task, log):
        for path in (task["path"], log):
            Path(path).write_text(f"{len(made)}")
        made.append(task)

    monkeypatch.setattr(presets.blender, "run", blender)
    for name in (library.INDEX_FILE, "gold.velour", "gold.png"):
        (tmp_path / name).write_text("1")
    for _ in range(2):
        presets.write_library(tmp_path, tmp_path)
    assert len(made) == 1
    for name in (library.INDEX_FILE, "gold.velour", "gold.png"):
        (tmp_path / name).write_text("2")
        presets.write_library(tmp_path, tmp_path)
    assert len(made) == 4


def test_a_damaged_index_is_refused_by_name(tmp_path):
    assert library.listed(tmp_path) == []
    for text in ("{", "[]", '{"presets": [{"name": "Paint"}]}'):
        (tmp_path / library.INDEX_FILE).write_text(text)
        with pytest.raises(ValueError, match=r"presets\.json is damaged"):
            library.listed(tmp_path)
