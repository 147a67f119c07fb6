"""Formats numbers and tables as Markdown."""

from __future__ import annotations


def table(header: list, rows: list[list]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)


def error(value: float | None) -> str:
    return "-" if value is None else f"{value:.4f}"


def small(value: float | None) -> str:
    return "-" if value is None else f"{value:.2e}"
