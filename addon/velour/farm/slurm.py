"""Slurm: an array job with one element per task of the job."""

from __future__ import annotations

import re
import shlex
import subprocess

from . import program, ranges
from .job import Job, JobError, replace_text

SCRIPT, SUBMITTED = "slurm.sh", "slurm.id"
_NOTICE_SECONDS = 120  # time to finish and save the pass


def write(job: Job) -> None:
    replace_text(job.folder / SCRIPT, script(job))


def script(job: Job) -> str:
    said = str(job.folder).replace("%", "%%")
    lines = [
        "#!/bin/sh",
        f"# All of it: sbatch --array=0-{job.tasks - 1} slurm.sh; scripts/farm submits what is left.",
        f"#SBATCH --job-name=velour-{re.sub(r'[^A-Za-z0-9._-]', '_', job.name)}",
        f'#SBATCH --output="{said}/logs/slurm-%A_%a.txt"',
        "#SBATCH --nodes=1 --ntasks=1",
        f"#SBATCH --signal=B:TERM@{_NOTICE_SECONDS}",  # to the program, which forwards it
    ]
    if job.threads:
        lines.append(f"#SBATCH --cpus-per-task={job.threads}")
    if job.memory_mib:
        lines.append(
            f"#SBATCH --mem={job.memory_mib}M"
        )  # per node: --mem-per-cpu would grow with the threads
    command = ["exec", "python3", str(job.folder / program.NAME), str(job.folder / "job.json"), "--task"]
    return "\n".join([*lines, f'{shlex.join(command)} "$SLURM_ARRAY_TASK_ID"', ""])


def submit(job: Job, tasks: list[int], options: list[str]) -> str:
    """Returns the number of the Slurm job. Raises JobError."""
    array = f"--array={ranges.words(tasks)}"
    command = ["sbatch", "--parsable", array, *options, str(job.folder / SCRIPT)]
    said = _slurm(*command, otherwise="; --no-submit only writes the job.")
    submitted = said.strip()  # NUMBER, or NUMBER;CLUSTER if there are several
    replace_text(job.folder / SUBMITTED, submitted + "\n")
    return submitted.split(";")[0]


def refuse_while_running(job: Job) -> None:
    """Raises JobError while any of the last submission is queued or running, or if nobody can tell."""
    file = job.folder / SUBMITTED
    if not file.is_file():
        return
    number, *cluster = file.read_text(encoding="utf-8").strip().split(";")
    where = ["-M", *cluster] if cluster else []
    try:
        said = _slurm("squeue", *where, "-h", "-o", "%t", "-j", number).splitlines()
    except JobError as error:
        if "Invalid job id" in str(error):  # Slurm has forgotten it
            return
        raise JobError(f"{error}; if Slurm's job {number} is no more, remove {file}.") from error
    if any(line and not line.startswith("CLUSTER:") for line in said):
        raise JobError(
            f"Slurm's job {number} still renders this; wait for it, or end it with:"
            f" {shlex.join(['scancel', *where, number])}"
        )


def _slurm(*command: str, otherwise: str = "") -> str:
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    except OSError as error:
        raise JobError(f"{command[0]} cannot be started ({error.strerror}){otherwise}") from error
    if done.returncode:
        raise JobError(f"{command[0]} says: {' '.join((done.stderr or done.stdout).split())}")
    return done.stdout
