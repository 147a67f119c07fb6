"""scripts/farm beside an engine: what is refused changes nothing that a running job reads."""

from __future__ import annotations

import os

import pytest
from velour.farm import command, job

# It is asked what a .blend holds, and is told that by nobody.
_BLENDER = """#!/usr/bin/python3
import json, sys
with open(sys.argv[-1], "w") as file:
    found = {"velour": "0.1.0", "blender": "3.4.1", "models": {}, "libraries": [], "notes": []}
    json.dump({**found, "frames": list(range(1, 101))}, file)
"""


def _program(path, text):
    path.write_text(text)
    path.chmod(0o755)
    return path


@pytest.fixture
def farm(tmp_path, monkeypatch, capsys):
    """Calls scripts/farm with a .blend of 100 frames: the status and what is said."""
    programs = tmp_path / "programs"
    programs.mkdir()
    monkeypatch.setenv("PATH", f"{programs}:/usr/bin:/bin")
    blender = _program(programs / "blender", _BLENDER)
    _program(programs / "sbatch", "#!/bin/sh\necho 17\n")
    (tmp_path / "shot.blend").touch()

    def call(*arguments, squeue=None):
        if squeue:
            _program(programs / "squeue", f"#!/bin/sh\n{squeue}\n")
        status = command.main([str(tmp_path / "shot.blend"), "--blender", str(blender), *arguments])
        said = capsys.readouterr()
        return status, said.out + said.err

    return call


def _files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize(
    "other", [("--frames", "5-6"), ("--tasks", "3"), ("--threads", "1"), ("--frames", "5-6", "--no-submit")]
)
def test_a_running_job_is_left_as_it_is(farm, tmp_path, other):
    """Its elements that wait find the frames that they were submitted for."""
    status, said = farm()
    assert (status, "Slurm's job 17" in said) == (0, True), said
    folder = tmp_path / "frames/farm"
    before = _files(folder)
    status, said = farm(*other, squeue="echo PD")
    assert status == 1
    assert "Slurm's job 17 still renders this" in said
    assert _files(folder) == before
    assert job.load(folder).task(50) == [(51, 0)]
    status, said = farm(*other, squeue="echo slurm_load_jobs error: Invalid job id specified >&2; exit 1")
    assert status == 0, said
    assert _files(folder) != before


def test_the_queue_is_that_of_the_cluster(farm, tmp_path):
    """Another cluster has no such job, or somebody else's of the same number."""
    _program(tmp_path / "programs/sbatch", "#!/bin/sh\necho '17;big'\n")
    status, said = farm("--sbatch=--clusters=big")
    assert (status, "Slurm's job 17;" in said) == (0, True), said
    other = "echo slurm_load_jobs error: Invalid job id specified >&2; exit 1"
    status, said = farm(squeue=f'[ "$1 $2" = "-M big" ] && echo PD || {{ {other}; }}')
    assert status == 1
    assert "end it with: scancel -M big 17" in said
    assert farm(squeue='echo CLUSTER: big; [ "$1 $2" = "-M big" ] || echo PD')[0] == 0


def test_a_slurm_that_does_not_answer(farm, tmp_path):
    """Nobody can say whether the job still runs: nothing is changed, and the remedy is named."""
    farm()
    folder = tmp_path / "frames/farm"
    before = _files(folder)
    status, said = farm("--tasks", "3", "--no-submit", squeue="echo Unable to contact controller >&2; exit 1")
    assert status == 1
    assert "Unable to contact controller" in said
    assert f"remove {folder / 'slurm.id'}" in said
    assert _files(folder) == before


@pytest.mark.parametrize("options", [("--scripts",), ("--preferences",), ("--parts", "2")])
def test_another_way_of_rendering_is_another_job(farm, tmp_path, options):
    farm("--no-submit")
    before = _files(tmp_path / "frames/farm")
    status, said = farm("--no-submit", *options)
    assert status == 1
    assert (
        f"is of another {'number of parts' if len(options) > 1 else f'setting of {options[0]}'}: name" in said
    )
    assert _files(tmp_path / "frames/farm") == before


def test_a_blend_is_known_by_what_is_in_it(farm, tmp_path):
    """Not by its date, which copies change."""
    blend = tmp_path / "shot.blend"
    farm("--no-submit")
    os.utime(blend, (1, 1))
    assert farm("--no-submit")[0] == 0
    blend.write_text("another scene")
    status, said = farm("--no-submit")
    assert (status, "is of another .blend" in said) == (1, True)


def test_links_are_not_followed(farm, tmp_path, monkeypatch):
    """A node's link may lead elsewhere, and Blender looks for the files of a link beside it."""
    versions = tmp_path / "versions"
    versions.mkdir()
    (tmp_path / "shot.blend").rename(versions / "shot_v12.blend")
    (tmp_path / "shot.blend").symlink_to(versions / "shot_v12.blend")
    assert farm("--no-submit")[0] == 0
    made = job.load(tmp_path / "frames")
    assert (made.blend, made.folder) == (str(tmp_path / "shot.blend"), tmp_path / "frames/farm")


@pytest.mark.parametrize("name", ['a "quote"', "{shot}", "back\\slash"])
def test_paths_that_engines_read_otherwise(farm, tmp_path, name):
    status, said = farm("--no-submit", "--output", str(tmp_path / name))
    assert (status, "cannot be an --output" in said) == (1, True)
    assert not (tmp_path / name).exists()


def test_a_frame_that_fails_again_at_once_is_told(farm, tmp_path):
    """Its first task may have failed before sbatch is back."""
    farm("--no-submit")
    notes = tmp_path / "frames/farm/failed"
    (notes / "0001.txt").write_text("An attempt before.")
    (notes / "0002.txt").write_text("An attempt before.")
    _program(tmp_path / "programs/sbatch", f"#!/bin/sh\necho No lamp. > '{notes}/0002.txt'\necho 17\n")
    assert farm()[0] == 0
    assert [path.name for path in notes.iterdir()] == ["0002.txt"]
    assert (notes / "0002.txt").read_text() == "No lamp.\n"


def test_a_path_of_blender_is_no_output(farm, tmp_path):
    """//frames is beside the .blend for Blender, and /frames for everybody else."""
    status, said = farm("--no-submit", "--output", f"/{tmp_path}/frames")
    assert (status, "// means beside the .blend" in said) == (1, True), said
    assert not (tmp_path / "frames").exists()
