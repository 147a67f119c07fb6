"""scripts/farm beside an engine: what is refused changes nothing that a running job reads."""

from __future__ import annotations

import pytest
from conftest import ROOT  # noqa: F401 - puts scripts/lib on the path
from farm import command, job

# It is asked what a .blend holds, and is told that by nobody.
_BLENDER = """#!/usr/bin/python3
import json, sys
with open(sys.argv[-1], "w") as file:
    json.dump({"velour": "0.1.0", "models": {}, "frames": list(range(1, 101)), "notes": []}, file)
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
