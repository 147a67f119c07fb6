"""Pictures made in parts: tiles and ranges of samples, merged, beside the single run; what is refused."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace

import inputs
import numpy as np
import pytest
from command_line import refused, velour
from velour.core import picture_parts
from velour.native import images, library

SPP, SPLIT = 37, 5  # the last camera ray of a pixel has two directions, the others five
TILES = ("0:13,0:11", "13:32,0:5", "13:32,5:11", "0:32,11:24")
RANGES = ("0:5", "5:25", "25:37")


@pytest.fixture(scope="module")
def render(mesh_file, world_file, model_file, tmp_path_factory):
    """Renders 32 x 24 pixels; the same part only once."""
    folder = tmp_path_factory.mktemp("parts")
    done = {}

    def run(*more):
        if more in done:
            return done[more]
        path = done[more] = folder / f"part{len(done)}.exr"
        result = velour(
            "render", "--mesh", mesh_file, "--material", model_file, "--world", world_file, "--size", "32x24",
            "--spp", SPP, "--split", SPLIT, "--bounces", 1, "--threads", 2, "-o", path, "--quiet", *more,
        )  # fmt: skip
        assert result.status == 0, result.err
        return path

    return run


def tiles(render) -> list:
    return [render("--crop", tile) for tile in TILES]


def ranges(render) -> list:
    return [render("--samples", span) for span in RANGES]


def largest_difference(path, whole) -> float:
    return float(np.abs(images.read(path) - images.read(whole)).max() / images.read(whole).max())


def test_tiles_are_the_single_run_bit_for_bit(render, tmp_path):
    whole, merged = render(), tmp_path / "merged.exr"
    parts = tiles(render)
    report = velour("merge", *parts, "-o", merged, "--json").json
    assert list(report) == ["parts", "size", "samples", "seconds"]
    assert (report["parts"], report["size"], report["samples"]) == (4, [32, 24], [[0, SPP]])
    assert merged.read_bytes() == whole.read_bytes()  # pixels and header
    assert images.header(parts[1])["frame"] == images.Frame(32, 24, 13, 19)  # from the lower left corner

    parts[1] = render("--crop", TILES[1], "--seed", 1)
    difference = images.read(parts[1]) - images.read(whole)[19:, 13:]
    assert np.abs(difference).max() > 1e-3  # another seed: the borders would show


def test_ranges_are_the_single_run_within_rounding(render, tmp_path):
    whole, merged = render(), tmp_path / "merged.exr"
    parts = ranges(render)
    assert velour("merge", *parts, "-o", merged, "--quiet").status == 0
    assert largest_difference(merged, whole) < 1e-6
    assert images.header(merged) == images.header(whole)

    by_directions = sum(n * images.read(path) for n, path in zip((5, 20, 12), parts, strict=True)) / SPP
    images.write(tmp_path / "control.exr", by_directions)  # 1, 4 and 3 camera rays are what counts
    assert largest_difference(tmp_path / "control.exr", whole) > 1e-4
    other_seed = render("--samples", RANGES[1], "--seed", 1)
    opened = [replace(picture_parts.open_part(path), made={"spp": SPP, "split": SPLIT}) for path in parts]
    opened[1] = replace(opened[1], read=lambda: images.read(other_seed))
    images.write(tmp_path / "control.exr", picture_parts.merge(opened).read())
    assert largest_difference(tmp_path / "control.exr", whole) > 1e-3


def test_ranges_of_tiles_in_any_order(render, tmp_path):
    whole, merged = render(), tmp_path / "merged.exr"
    left = [render("--crop", "0:16,0:24", "--samples", span) for span in RANGES]
    right = render("--crop", "16:32,0:24")
    assert velour("merge", left[2], right, left[0], left[1], "-o", merged, "--quiet").status == 0
    assert largest_difference(merged, whole) < 1e-6
    np.testing.assert_array_equal(images.read(merged)[:, 16:], images.read(whole)[:, 16:])


def test_what_is_missing_and_what_is_there_twice_is_named(render, tmp_path):
    merged = tmp_path / "merged.exr"
    merged.write_text("old")
    parts = tiles(render)
    assert "samples 0:37 of the pixels 13:32,0:5;" in refused("merge", *parts[:1], *parts[2:], "-o", merged)
    assert "of some of the pixels 0:32,0:11;" in refused("merge", parts[1], parts[3], "-o", merged)
    more = render("--crop", "12:14,4:6")
    sentence = refused("merge", *parts, more, "-o", merged)
    assert parts[0].name in sentence
    assert more.name in sentence
    assert "both have samples 0:37 of the pixels 12:13,4:6." in sentence

    parts = ranges(render)
    assert "samples 5:25 of the pixels 0:32,0:24;" in refused("merge", parts[0], parts[2], "-o", merged)
    sentence = refused("merge", *parts, render("--samples", "20:30"), "-o", merged)
    assert "both have samples 20:25" in sentence
    assert "both have samples 0:5 " in refused("merge", parts[0], parts[0], "-o", merged)
    assert merged.read_text() == "old"


@pytest.mark.parametrize(
    ("key", "more"),
    [
        ("seed", ("--seed", 1)),
        ("spp", ("--spp", 40)),
        ("split", ("--split", 4, "--samples", "0:20")),
        ("strategy", ("--strategy", "light")),
        ("bounces", ("--bounces", 0)),
        ("sequence", ("--sequence", "random")),
        ("share", ("--share", 0.4)),
        ("camera", ("--camera", "0,-9,0,0,0,0,12")),
        ("world rotation", ("--world-rotation", 1)),
        ("size", ("--size", "32x25", "--crop", "0:4,0:4")),
    ],
)
def test_parts_of_other_pictures_are_refused(key, more, render, tmp_path):
    one = render("--samples", RANGES[0])
    other = render(*(() if "--samples" in more else ("--samples", RANGES[1])), *more)
    sentence = refused("merge", one, other, "-o", tmp_path / "merged.exr", "--partial")
    assert "parts of different images" in sentence
    assert f"the {key} differs" in sentence


def test_files_are_told_apart_by_what_is_in_them(render, tmp_path, mesh_file, world_file):
    one = render("--samples", RANGES[0])
    copy = tmp_path / "copy.exr"
    copy.write_bytes(world_file.read_bytes())
    same = render("--samples", RANGES[1], "--world", copy)
    merged = tmp_path / "merged.exr"
    assert velour("merge", one, same, "-o", merged, "--partial", "--quiet").status == 0
    brighter = tmp_path / "brighter.exr"
    images.write(brighter, images.read(world_file) * 1.01)
    other = render("--samples", RANGES[1], "--world", brighter)
    assert "the world differs" in refused("merge", one, other, "-o", merged, "--partial")
    mesh = inputs.write_octahedron(tmp_path / "mesh.obj")
    mesh.write_text(mesh.read_text().replace("v 1 0 0", "v 1.1 0 0"))
    other = render("--samples", RANGES[1], "--mesh", mesh)
    assert "the mesh differs" in refused("merge", one, other, "-o", merged, "--partial")
    measurement = inputs.write_merl(tmp_path / "paint.binary")
    other = render("--samples", RANGES[1], "--material", measurement)
    assert "the material differs" in refused("merge", one, other, "-o", merged, "--partial")


def test_a_partial_merge_says_what_it_has_and_goes_on(render, tmp_path):
    whole, some, merged = render(), tmp_path / "some.exr", tmp_path / "merged.exr"
    parts = ranges(render)
    assert velour("merge", parts[2], parts[0], "-o", some, "--partial", "--json").json["samples"] == [
        [0, 5],
        [25, 37],
    ]
    assert images.header(some)["texts"][picture_parts.SAMPLES] == "0:5,25:37"
    assert largest_difference(some, whole) > 1e-3
    assert velour("merge", some, parts[1], "-o", merged, "--quiet").status == 0
    assert largest_difference(merged, whole) < 1e-6
    left = render("--crop", "0:16,0:24", "--samples", RANGES[1])
    assert "No part has samples 5:25" in refused("merge", some, left, "-o", merged, "--partial")


def test_parts_made_with_different_instruction_sets_are_told_of(render, tmp_path):
    targets = library.system()["simd_targets"]
    if len(targets) < 2:
        pytest.skip("this processor or build has one instruction set")
    parts = [render("--samples", span, "--simd", name)
             for name, span in zip(targets, ("0:20", "20:37"), strict=False)]  # fmt: skip
    result = velour("merge", *parts, "-o", tmp_path / "merged.exr")
    assert result.status == 0
    assert "different instruction sets" in result.err
    assert images.header(tmp_path / "merged.exr")["texts"][picture_parts.SIMD] == ",".join(
        sorted(targets[:2])
    )


def test_pictures_that_are_no_parts_are_refused(render, tmp_path, world_file):
    merged = tmp_path / "merged.exr"
    assert "cannot be merged" in refused("merge", world_file, "-o", merged)
    noisy = render("--noise", 0.2)
    assert "velour.samples" in refused("merge", noisy, "-o", merged)
    images.write(tmp_path / "picture.png", images.read(world_file))
    assert "picture.png" in refused("merge", tmp_path / "picture.png", "-o", merged)
    assert "nowhere.exr" in refused("merge", tmp_path / "nowhere.exr", "-o", merged)
    assert not merged.exists()


def test_files_of_several_layers_are_refused_whole(render, tmp_path):
    """None is lost without a word: neither channels nor parts that another program has added."""
    part, merged = render("--samples", RANGES[0]), tmp_path / "merged.exr"
    header, pixels = images.header(part), images.read(part)
    assert not header["multi_part"]
    deep = tmp_path / "deep.exr"
    images.write_part(
        deep, np.concatenate([pixels, pixels[..., :2]], axis=2), header["frame"], header["texts"]
    )
    sentence = refused("merge", deep, *ranges(render)[1:], "-o", merged)
    assert "deep.exr has the channels R, G, B, A, channel004, channel005" in sentence
    assert not merged.exists()


@pytest.mark.skipif(not shutil.which("oiiotool"), reason="oiiotool is not installed")
def test_files_of_several_parts_are_refused_whole(render, tmp_path):
    parts, merged = ranges(render), tmp_path / "merged.exr"
    several = tmp_path / "several.exr"
    subprocess.run(["oiiotool", str(parts[0]), str(parts[0]), "--siappend", "-o", str(several)], check=True)
    assert images.header(several)["multi_part"]
    assert picture_parts.MADE in images.header(several)["texts"]
    assert "several.exr has several OpenEXR parts" in refused("merge", several, *parts[1:], "-o", merged)
    assert not merged.exists()


@pytest.mark.parametrize(
    ("made", "samples"),
    [
        ("{", "0:8"),
        ("[]", "0:8"),
        ('{"spp": 8}', "0:8"),
        ('{"spp": "8", "split": 8}', "0:8"),
        ('{"spp": 8, "split": 0}', "0:8"),
        ('{"spp": 8, "split": 8}', "0:9"),
        ('{"spp": 8, "split": 8}', "4:4"),
        ('{"spp": 8, "split": 8}', "4:2"),
        ('{"spp": 8, "split": 8}', "0:2,1:3"),
        ('{"spp": 8, "split": 8}', "-1:8"),
        ('{"spp": 8, "split": 8}', "all"),
        ('{"spp": 8, "split": 8}', ""),
    ],
)
def test_headers_that_make_no_sense_are_refused(made, samples, tmp_path):
    path = tmp_path / "part.exr"
    texts = {picture_parts.MADE: made, picture_parts.SAMPLES: samples}
    images.write_part(path, np.zeros((2, 2, 4), np.float32), images.Frame(2, 2), texts)
    assert "its header is invalid" in refused("merge", path, "-o", tmp_path / "merged.exr")


def test_a_truncated_part_is_refused(render, tmp_path):
    part = tmp_path / "part.exr"
    part.write_bytes(render().read_bytes()[:-200])
    assert "part.exr" in refused("merge", part, "-o", tmp_path / "merged.exr")
    assert not (tmp_path / "merged.exr").exists()


def test_parts_that_cannot_be_are_refused_before_the_work(tmp_path):
    scene = ["--mesh", "no.obj", "--material", "no.velour", "--world", "no.hdr", "-o", tmp_path / "o.exr"]
    render = ["render", *scene, "--size", "32x24"]
    assert "exceeds --spp 64" in refused(*render, "--samples", "0:256")
    assert "multiples of --split 8" in refused(*render, "--samples", "0:12")
    assert "exceeds the image of 32x24" in refused(*render, "--crop", "0:32,0:25")
    assert "--noise needs the whole image" in refused(*render, "--crop", "0:4,0:4", "--noise", 0.1)
    render[render.index("-o") + 1] = tmp_path / "o.png"
    assert "change the extension to .exr" in refused(*render, "--samples", "0:8")
