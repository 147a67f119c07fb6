"""The tables of models and materials, as Markdown."""

from __future__ import annotations

from markdown_table import error, table
from model_runs import Result
from models_targets import ANGLES, meets

COSTS = ("f", "sample_pdf", "f_16", "sample_pdf_16")  # keys of evaluation_cost
COST_NAMES = ("f, ns", "sample, pdf", "f, 16", "sample, pdf, 16")
_DEGREES = [f"{angle}°" for angle in ANGLES]


def errors(results: list[Result]) -> str:
    rows = []
    for result in results:
        noise = [error(result.noise[angle]) for angle in ANGLES]
        rows.append([result.name, "noise", "", *noise])
        for model, row in result.rows.items():
            cells = [_judged(angle, row.report["by_view_angle"][angle], result) for angle in ANGLES]
            rows.append([result.name, model, error(row.report["relative_l2"]), *cells])
    return table(["material", "model", "relative_l2", *_DEGREES], rows)


def costs(results: list[Result]) -> str:
    rows = []
    for result in results:
        rows.append([result.name, "measurement", "", result.bytes, "", "", *nanoseconds(result.cost)])
        for model, row in result.rows.items():
            sizes = [row.report.get(key, "") for key in ("lobes", "bytes", "parameter_bytes")]
            seconds = f"{row.report['seconds']:.2f}"
            rows.append([result.name, model, *sizes, seconds, *nanoseconds(row.cost)])
    header = ["material", "model", "lobes", "bytes", "parameter bytes", "seconds", *COST_NAMES]
    return table(header, rows)


def scattered(results: list[Result]) -> str:
    """Per-view models with slices aligned to the mirror direction, beside models with unaligned slices."""
    rows = []
    for result in results:
        row = result.rows["scattered"]
        views = f"{row.info['views']}, {row.report['lobes']}"
        rows.append([result.name, views, row.bytes, _all_errors(row.report), _all_errors(result.unturned)])
    degrees = " / ".join(ANGLES)
    return table(["material", "views, lobes", "bytes", f"turned: all, {degrees}", "mixed as they are"], rows)


def ggx(results: list[Result]) -> str:
    rows = []
    for result in results:
        row = result.rows["ggx"]
        rows.append([result.name, _numbers(row.report["ggx"]["alpha"][:1]), *_view_errors(row.report)])
    return table(["material", "alpha", "relative_l2", *_DEGREES], rows)


def principled(results: list[Result]) -> str:
    """The errors, and the fitted parameters."""
    names = list(results[0].rows["principled"].report["principled"])
    rows, values = [], []
    for result in results:
        report = result.rows["principled"].report
        rows.append([result.name, *_view_errors(report)])
        found = report["principled"].values()
        values.append([result.name, *(_numbers(v if isinstance(v, list) else [v]) for v in found)])
    errors_found = table(["material", "relative_l2", *_DEGREES], rows)
    return f"{errors_found}\n{table(['material', *names], values)}"


def _judged(angle: str, value: float | None, result: Result) -> str:
    if value is None or not meets(angle, value, result.noise):
        return error(value)
    return f"**{error(value)}**"


def nanoseconds(cost: dict) -> list[str]:
    return [f"{cost[key]:.0f}" if key in cost else "-" for key in COSTS]


def _view_errors(report: dict) -> list[str]:
    return [error(report["relative_l2"]), *(error(report["by_view_angle"][angle]) for angle in ANGLES)]


def _all_errors(report: dict) -> str:
    whole, *by_view = _view_errors(report)
    return f"{whole}, {' / '.join(by_view)}"


def _numbers(values: list[float]) -> str:
    return ", ".join(f"{value:.3f}" for value in values)
