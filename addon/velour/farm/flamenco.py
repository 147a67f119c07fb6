"""Flamenco 3: a job type for the manager's folder of scripts, and the job to submit to it."""

from __future__ import annotations

import json

from . import program, ranges
from .job import Job, replace_text

SCRIPT, SUBMISSION = "velour_frames.js", "flamenco.json"
TYPE = "velour-frames"  # Flamenco derives this from the script's name

_JOB_TYPE = """\
// A job type of Flamenco 3: frames of a job that scripts/farm of Velour made. It belongs into the folder
// "scripts" beside flamenco-manager. Written by scripts/farm; the same for all jobs.

const JOB_TYPE = {
    label: "Velour Frames",
    description: "Frames by Velour; each picture is checked before it counts as done",
    settings: [
        { key: "job", type: "string", subtype: "file_path", required: true,
          description: "job.json, which scripts/farm wrote" },
        { key: "frames", type: "string", required: true,
          eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          description: "Frames to render. Examples: '47', '1-30', '3, 5-10, 47-327'" },
        { key: "chunk_size", type: "int32", default: 1, propargs: { min: 1 }, visible: "submission",
          description: "Frames of a task" },
        { key: "parts", type: "int32", default: 1, propargs: { min: 1 }, visible: "web",
          description: "That the samples of each frame are shared out to, as job.json has it" },
        { key: "blendfile", type: "string", required: true, visible: "web",
          description: "Path of the .blend" },
        { key: "python", type: "string", default: "python3", visible: "submission",
          description: "Python 3.9 or newer of the workers" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        for (let part = 1; part <= settings.parts; part++) {
            const named = settings.parts > 1 ? `frames ${chunk}, part ${part}` : `frames ${chunk}`;
            const task = author.Task(named, "blender");
            task.addCommand(author.Command("exec", {
                exe: settings.python,
                args: [
                    path.join(path.dirname(settings.job), "PROGRAM"), settings.job,
                    "--frames", chunk, "--part", String(part),
                    "--blend", settings.blendfile, "--blender", "{blender}",
                ],
            }));
            job.addTask(task);
        }
    }
}
"""


def write(job: Job) -> None:
    replace_text(job.folder / SCRIPT, _JOB_TYPE.replace("PROGRAM", program.NAME))
    replace_text(job.folder / SUBMISSION, json.dumps(submission(job), indent=2, ensure_ascii=False) + "\n")


def submission(job: Job) -> dict:
    """The body of POST /api/v3/jobs of the manager."""
    settings = {
        "job": str(job.folder / "job.json"),
        "frames": ranges.words(job.frames),
        "chunk_size": 1,
        "parts": job.parts,
        "blendfile": job.blend,
        "python": "python3",
    }
    return {
        "name": f"velour {job.name}",
        "type": TYPE,
        "priority": 50,
        "submitter_platform": "linux",
        "settings": settings,
    }
