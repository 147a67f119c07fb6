"""Open Job Description (specification 2023-09): a template as JSON, for AWS Deadline Cloud and others."""

from __future__ import annotations

import json
import re

from . import program, ranges
from .job import Job, replace_text

FILE = "openjd.json"
_LONGEST_NAME, _LONGEST_TEXT = 64, 1024  # characters
_NOTICE_SECONDS = 120  # time to finish and save the pass


def write(job: Job) -> None:
    """Prints a message and writes nothing if OpenJD could not read it: other managers may still work."""
    if len(_frames(job)) > _LONGEST_TEXT:
        (job.folder / FILE).unlink(missing_ok=True)
        print(f"{FILE} is not written: OpenJD takes no list of frames that long; make jobs of fewer frames.")
        return
    replace_text(job.folder / FILE, json.dumps(template(job), indent=2, ensure_ascii=False) + "\n")


def template(job: Job) -> dict:
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "name": _name(job),
        "parameterDefinitions": _parameters(job),
        "steps": [_step(job)],
    }


def _name(job: Job) -> str:
    """The job's name without double braces, which begin an expression, and control characters, which OpenJD
    refuses."""
    readable = re.sub(r"[\x00-\x1f\x7f-\x9f]|\{\{|\}\}", "_", job.name)
    return f"velour {readable}"[:_LONGEST_NAME]


def _frames(job: Job) -> str:
    return ranges.words(job.frames, steps=True)


def _parameters(job: Job) -> list[dict]:
    blend = {"name": "Blend", "type": "PATH", "objectType": "FILE", "dataFlow": "IN", "default": job.blend}
    output = {"name": "Output", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "INOUT"}
    return [
        {**blend, "description": "The .blend."},
        {
            **output,
            "default": str(job.output),
            "description": "Of the pictures, with the job's folder in it.",
        },
        {"name": "Blender", "type": "STRING", "default": job.blender, "description": "On the nodes."},
        {
            "name": "Frames",
            "type": "STRING",
            "default": _frames(job),
            "description": "Such as 1-10,15.",
        },
    ]


def _step(job: Job) -> dict:
    folder = f"{{{{Param.Output}}}}/{job.folder.name}"
    paths = ["--blend", "{{Param.Blend}}", "--blender", "{{Param.Blender}}"]
    frame = ["--frames", "{{Task.Param.Frame}}"]
    space = [{"name": "Frame", "type": "INT", "range": "{{Param.Frames}}"}]
    if job.parts > 1:
        frame += ["--part", "{{Task.Param.Part}}"]
        space.append({"name": "Part", "type": "INT", "range": f"1-{job.parts}"})
    run = {
        "command": "python3",
        "args": [f"{folder}/{program.NAME}", f"{folder}/job.json", *frame, *paths],
        "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": _NOTICE_SECONDS},
    }
    step = {
        "name": "Frames",
        "parameterSpace": {"taskParameterDefinitions": space},
        "script": {"actions": {"onRun": run}},
    }
    amounts = _amounts(job)
    return {**step, "hostRequirements": {"amounts": amounts}} if amounts else step


def _amounts(job: Job) -> list[dict]:
    asked = (("amount.worker.vcpu", job.threads), ("amount.worker.memory", job.memory_mib))
    return [{"name": name, "min": least} for name, least in asked if least]
