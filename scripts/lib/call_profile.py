"""Where the processor time of a command goes, by perf's samples of the running function."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

# The first pattern that matches counts the function. Functions without a match belong to loading, which is
# omitted.
_PARTS = [
    ("tracing rays (Embree)", r"libembree|EmbreeScene|RayLog"),
    ("products of lobes", r"SkyProposals|multiply_|keep_products|select_|expm1|log2f|lround|exp2f"),
    ("drawing from the sky", r"EquirectangularImage|draw_(rows|columns)|sky_directions|Lighting::sample"),
    ("looking the sky up", r"look_up|coordinates_simd"),
    ("evaluating mixtures", r"eval_mixture|eval_density|Material::eval"),
    ("drawing from mixtures", r"sample_mixture|Material::sample|choose_|directions_simd"),
    ("gathering the views' lobes", r"LobeMixture|ScatteredLobes|bracketing|nearest_|prepare|atan"),
    ("random numbers", r"Point|sobol|PathNumbers|points_simd"),
    ("surface points, camera rays", r"Mesh::(pos|sha|tan)|Scene::surf|Vertex|Camera|Tile|Film|Pixel"),
    ("combining, queueing rays", r"DirectLight|LightTerms|ShadowQueue"),
]


def available() -> bool:
    """Whether perf is installed and permitted."""
    if shutil.which("perf") is None:
        return False
    probe = ["perf", "record", "-e", "cpu-clock", "-o", "/dev/null", "true"]
    return subprocess.run(probe, capture_output=True).returncode == 0


def profile(command: list, data: Path) -> dict[str, float]:
    """Share of each part in the processor time of all parts of `command`."""
    record = ["perf", "record", "-q", "-e", "cpu-clock", "-F", "1999", "-o", data]
    subprocess.run([*map(str, [*record, "--", *command])], check=True, stdout=subprocess.DEVNULL)
    report = ["perf", "report", "-i", str(data), "-g", "none", "--percent-limit", "0"]
    fields = ["--field-separator", "\t", "--sort", "dso,symbol"]
    text = subprocess.run([*report, *fields], check=True, capture_output=True, text=True).stdout
    return _shares(text)


def _shares(report: str) -> dict[str, float]:
    totals = dict.fromkeys((name for name, _ in _PARTS), 0.0)
    for line in report.splitlines():
        fields = line.strip().split("\t")
        if line.startswith("#") or len(fields) < 3:
            continue
        part = _part(fields[1].strip(), fields[2].strip())
        if part is not None:
            totals[part] += float(fields[0].strip().rstrip("%"))
    whole = sum(totals.values())
    return {name: total / whole for name, total in totals.items()}


def _part(library: str, function: str) -> str | None:
    if not re.search(r"libvelour|libembree|libm\.|libc\.", library):
        return None
    return next((name for name, known in _PARTS if re.search(known, f"{library} {function}")), None)
