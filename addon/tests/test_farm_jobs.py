"""What scripts/farm writes: held to the published forms, and to what the frame program understands."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from velour.farm import blender, flamenco, frame, openjd, program, ranges, slurm, sources, status
from velour.farm.job import Job, JobError, Unit, load

TOOLS = ROOT / "build/tools/bin/python"


@pytest.fixture
def job(tmp_path) -> Job:
    blend = tmp_path / "a shot.blend"
    blend.write_text("a scene")
    made = Job(
        blend=str(blend),
        blend_hash=sources.sha256(blend),
        libraries={},
        name="a shot",
        format="OPEN_EXR",
        velour="0.1.0",
        blender_version="3.4.1",
        models={"paint": ["12"]},
        frames=[1, 2, 3, 7],
        tasks=2,
        threads=3,
        memory_mib=700,
        folder=tmp_path / "100% done/farm",
    )
    made.save()
    return made


def test_ranges():
    assert ranges.parse("7, 1-3,20-24:2,2") == [1, 2, 3, 7, 20, 22, 24]
    assert ranges.words([1, 2, 3, 7, 20, 22, 24]) == "1-3,7,20,22,24"
    assert ranges.words([1, 2, 3, 7, 20, 22, 24], steps=True) == "1-3,7,20-24:2"
    assert ranges.words([1, 3, 4, 9], steps=True) == "1,3-4,9"
    for text in ("", "a", "3-1", "1-", "-1", "1:2", "1-5:0", "1048575"):
        with pytest.raises(ValueError, match="frame"):
            ranges.parse(text)


def test_a_job_is_read_as_it_was_saved(job):
    assert load(job.output) == load(job.folder) == load(job.folder / "job.json") == job
    assert [job.task(number) for number in range(2)] == [[(1, 0), (3, 0)], [(2, 0), (7, 0)]]
    with pytest.raises(JobError, match="no task 2"):
        job.task(2)
    (job.folder / "job.json").write_text('{"blend": 1}')
    with pytest.raises(JobError, match="cannot be read"):
        load(job.folder)


def test_the_command_of_a_frame(job):
    """-E makes a node without Velour fail; factory settings and scripts are what was asked for."""
    command = blender.render(job, Unit(7), job.partial(7) / "picture_")
    assert command[command.index("-E") + 1] == "VELOUR"
    assert command[command.index("--addons") + 1] == "velour"
    assert command[command.index("-t") + 1] == "3"
    before = command.index("--python-exit-code"), command.index("--factory-startup"), command.index("-Y")
    assert max(before) < command.index("--addons") < command.index(job.blend) < command.index("-E")
    own = command.index("--")
    assert command[own - 2 : own] == ["-f", "7"]
    films = ["--velour-parts", str(job.film(7)), "--velour-keep-parts"]
    assert command[own + 1 :] == [*films, "--velour-memory", "700M"]
    job.preferences, job.scripts = True, True
    command = blender.start(job)
    assert "--factory-startup" not in command
    assert "-Y" not in command
    assert "-y" in command


def test_a_blender_that_says_all_is_well(job, tmp_path):
    """It ends with 0, and writes nothing, or what is no picture: neither is a frame that is done."""
    program.write(job.folder)
    for says, words in (("", "there is none"), ("echo no picture > ${out}0007.exr", "no OpenEXR file")):
        fake = tmp_path / "blender"
        script = f'#!/bin/sh\nwhile [ $# -gt 0 ]; do [ "$1" = -o ] && out=${{2%%#*}}; shift; done\n{says}\n'
        fake.write_text(script.replace("${out}0007", '"$out"0007'))
        fake.chmod(0o755)
        command = [sys.executable, job.folder / program.NAME, job.folder / "job.json", "--frames", "7"]
        done = subprocess.run([*command, "--blender", fake], capture_output=True, text=True)
        assert done.returncode == 1, done.stderr
        assert "the picture is not counted as done" in done.stderr
        assert words in done.stderr
        assert status.look(job).failed.keys() == {7}
        assert not job.picture(7).exists()


def test_a_killed_blender_is_named(job, tmp_path):
    assert blender.ending(-9, tmp_path / "none") == "Blender was ended by SIGKILL"
    log = tmp_path / "log"
    log.write_text("Read blend\nError: Material 'a': gone\nBlender quit\n")
    assert blender.ending(1, log) == "Blender ended with status 1: Error: Material 'a': gone"
    log.write_text(
        "Approximated: relative error 0.4.\n00:06.355  reports  | ERROR Material 'a': gone.\nquit\n"
    )
    assert blender.ending(1, log) == "Blender ended with status 1: ERROR Material 'a': gone"
    assert blender.execute([str(tmp_path / "no-blender")], log) == 127
    assert "cannot be started (No such file or directory)" in blender.ending(127, log)


def test_tasks_that_are_left(job):
    now = status.Status(done=[1, 2, 3], failed={7: "why"}, left=[])
    assert status.tasks_left(job, now) == [1]
    assert (now.code, now.lines()) == (1, ["frame 7 failed: why", "3 of 4 frames done, 1 failed, 0 left"])
    assert status.Status(done=[1], failed={}, left=[2, 3]).code == status.UNFINISHED
    assert status.Status(done=[1], failed={}, left=[]).code == status.DONE


def test_parts_are_dealt_out(job):
    """In turn; a frame whose parts are all there still lacks its picture."""
    job.parts, job.frames = 3, [1, 2]
    first, second = job.task(0), job.task(1)
    assert (first, second) == ([(1, 1), (1, 3), (2, 2)], [(1, 2), (2, 1), (2, 3)])
    command = blender.render(job, first[1], job.partial(1) / "picture_")
    assert command[command.index("--velour-samples") + 1] == "3/3"
    assert len({job.log(unit) for unit in first + second}) == 6
    now = status.Status(done=[2], failed={}, left=[1])
    job.film(1).mkdir(parents=True)
    for unit in first:
        if unit.frame == 1:
            job.part_done(unit).touch()
    assert status.tasks_left(job, now) == [1]
    job.part_done(second[0]).touch()
    assert status.tasks_left(job, now) == [0]  # one makes the picture of all
    assert status.tasks_left(job, status.Status(done=[1, 2], failed={}, left=[])) == []


def test_slurm_script(job):
    slurm.write(job)
    path = job.folder / slurm.SCRIPT
    subprocess.run(["sh", "-n", path], check=True)
    lines = path.read_text().splitlines()
    assert "#SBATCH --mem=700M" in lines
    assert "#SBATCH --cpus-per-task=3" in lines
    assert "#SBATCH --signal=B:TERM@120" in lines
    assert "#SBATCH --job-name=velour-a_shot" in lines
    assert f'#SBATCH --output="{job.output.parent}/100%% done/farm/logs/slurm-%A_%a.txt"' in lines
    job.threads = job.memory_mib = 0
    assert "--mem" not in slurm.script(job)
    assert "--cpus" not in slurm.script(job)


# Flamenco's manager in its own words: the enumerations are those of its OpenAPI document.
_MANAGER = """
const fs = require("fs"), vm = require("vm");
const [script, submission] = process.argv.slice(1).map((name) => fs.readFileSync(name, "utf8"));
const settings = JSON.parse(submission).settings, tasks = [];
const sandbox = {
    author: {
        Task: (name, type) =>
            ({ name, type, commands: [], addCommand(command) { this.commands.push(command); } }),
        Command: (name, parameters) => ({ name, parameters }),
    },
    path: require("path").posix, print: () => {},
    frameChunker: (frames, size) => { if (size !== 1) throw "size"; return ["1", "2", "3", "7"]; },
    submitted: { settings, addTask: (task) => tasks.push(task) },
};
vm.runInNewContext(`"use strict";\\n${script}\\ncompileJob(submitted); submitted.type = JOB_TYPE;`, sandbox);
console.log(JSON.stringify({ type: sandbox.submitted.type, tasks }));
"""
_SETTING_KEYS = {
    *("key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval", "evalInfo"),
    *("visible", "required", "editable"),
}


@pytest.mark.skipif(not shutil.which("node"), reason="node is not installed")
def test_flamenco(job):
    flamenco.write(job)
    script, submission = job.folder / flamenco.SCRIPT, job.folder / flamenco.SUBMISSION
    assert script.stem.replace("_", "-") == flamenco.TYPE
    done = subprocess.run(["node", "-e", _MANAGER, script, submission], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    compiled = json.loads(done.stdout)
    _check_job_type(compiled["type"], json.loads(submission.read_text()))
    assert [task["name"] for task in compiled["tasks"]] == ["frames 1", "frames 2", "frames 3", "frames 7"]
    for task, number in zip(compiled["tasks"], job.frames, strict=True):
        (command,) = task["commands"]
        assert (task["type"], command["name"], set(command["parameters"])) == (
            "blender",
            "exec",
            {"exe", "args"},
        )
        assert command["parameters"]["exe"] == "python3"
        started, *arguments = command["parameters"]["args"]
        assert started == str(job.folder / program.NAME)
        _check_arguments(arguments, job, number, "{blender}")


def _check_job_type(job_type, submitted):
    assert set(job_type) == {"label", "description", "settings"}
    for setting in job_type["settings"]:
        assert set(setting) <= _SETTING_KEYS
        assert setting["type"] in ("string", "int32", "float", "bool")
        assert setting.get("subtype", "file_path") in (
            "file_path",
            "dir_path",
            "file_name",
            "hashed_file_path",
        )
        assert setting.get("visible", "visible") in ("visible", "hidden", "submission", "web")
    assert {"name", "type", "priority", "submitter_platform", "settings"} == set(submitted)
    keys = [setting["key"] for setting in job_type["settings"]]
    assert len(set(keys)) == len(keys)
    assert set(submitted["settings"]) == set(keys)


@pytest.mark.skipif(not shutil.which("node"), reason="node is not installed")
def test_flamenco_parts(job):
    job.parts = 2
    job.save()
    flamenco.write(job)
    files = job.folder / flamenco.SCRIPT, job.folder / flamenco.SUBMISSION
    done = subprocess.run(["node", "-e", _MANAGER, *files], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    tasks = json.loads(done.stdout)["tasks"]
    assert [task["name"] for task in tasks][:3] == [
        "frames 1, part 1",
        "frames 1, part 2",
        "frames 2, part 1",
    ]
    given = [frame._parse(task["commands"][0]["parameters"]["args"][1:]) for task in tasks]
    assert [unit for each in given for unit in frame._units(job, each)] == job.units(job.frames)


def _check_arguments(arguments, job, number, program_name):
    """They are what the frame program takes."""
    found = frame._parse(arguments)
    assert frame._units(job, found) == [Unit(number)]
    assert load(found.job) == job
    assert (found.frames, found.blend, found.blender) == ([number], job.blend, program_name)


# The reference implementation of OpenJD: decodes a template, makes a job of it, and shows what its tasks run.
_OPENJD = """
import json, sys
from pathlib import Path
from openjd.model import (
    DecodeValidationError, StepParameterSpaceIterator, create_job, decode_job_template,
    preprocess_job_parameters)
try:
    template = decode_job_template(template=json.load(open(sys.argv[1])))
except DecodeValidationError as error:
    sys.exit(f"refused: {error}")
here = Path(sys.argv[1]).parent
values = preprocess_job_parameters(
    job_template=template, job_parameter_values={}, job_template_dir=here, current_working_dir=here,
    allow_job_template_dir_walk_up=True)
job = create_job(job_template=template, job_parameter_values=values)
(step,) = job.steps
space = list(StepParameterSpaceIterator(space=step.parameterSpace))
run = step.script.actions.onRun
print(json.dumps({
    "frames": [int(task["Frame"].value) for task in space],
    "parts": [int(task["Part"].value) for task in space if "Part" in task],
    "parameters": {name: value.value for name, value in job.parameters.items()},
    "command": str(run.command), "args": [str(arg) for arg in run.args],
    "amounts": {a.name: float(a.min) for a in step.hostRequirements.amounts}}))
"""


def _openjd(path):
    return subprocess.run([TOOLS, "-c", _OPENJD, path], capture_output=True, text=True)


@pytest.fixture(scope="module")
def openjd_model():
    if (
        not TOOLS.exists()
        or subprocess.run([TOOLS, "-c", "import openjd.model"], capture_output=True).returncode
    ):
        pytest.skip("OpenJD's reference implementation is not installed (scripts/setup --tests)")


def test_openjd(job, openjd_model):
    openjd.write(job)
    done = _openjd(job.folder / openjd.FILE)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert made["frames"] == job.frames
    assert made["amounts"] == {"amount.worker.vcpu": 3, "amount.worker.memory": 700}
    assert made["command"] == "python3"
    values = {f"Param.{name}": value for name, value in made["parameters"].items()}
    started, *arguments = (_filled(text, {**values, "Task.Param.Frame": "7"}) for text in made["args"])
    assert started == str(job.folder / program.NAME)
    _check_arguments(arguments, job, 7, "blender")


def test_openjd_parts(job, openjd_model):
    job.parts = 3
    openjd.write(job)
    done = _openjd(job.folder / openjd.FILE)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert sorted(zip(made["frames"], made["parts"], strict=True)) == job.units(job.frames)
    assert made["args"][made["args"].index("--part") + 1] == "{{Task.Param.Part}}"


def test_openjd_of_long_shots(job, openjd_model, capsys):
    """Every second frame is a range with a step; what OpenJD's text cannot hold is not written, and said."""
    job.frames, job.name = list(range(1, 1001, 2)), "a {{shot}}\tof night"
    openjd.write(job)
    done = _openjd(job.folder / openjd.FILE)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["frames"] == job.frames
    job.frames = [number for number in range(1000) if number % 7 in (0, 1, 3)]
    openjd.write(job)
    assert not (job.folder / openjd.FILE).exists()
    assert "OpenJD takes no list of frames that long" in capsys.readouterr().out


def _filled(text, values):
    for name, value in values.items():
        text = text.replace("{{" + name + "}}", value)
    assert "{{" not in text
    return text


def test_openjd_refuses_what_is_wrong(job, openjd_model, tmp_path):
    """The control: the check sees a parameter that nobody defined, and a field that there is not."""
    for change in ({"parameterDefinitions": openjd.template(job)["parameterDefinitions"][:2]}, {"memory": 1}):
        path = tmp_path / "template.json"
        path.write_text(json.dumps({**openjd.template(job), **change}))
        done = _openjd(path)
        assert done.returncode == 1
        assert "refused" in done.stderr
