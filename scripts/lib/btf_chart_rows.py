"""Reads and writes docs/results/chart_btf.csv: the conditions of the measurement, then a row per entry."""

from __future__ import annotations

import csv
import dataclasses
from pathlib import Path

from btf_chart_numbers import Entry, Results
from table_csv import csv_text
from velour.core import files

FILE = "chart_btf.csv"
_FIELDS = [field.name for field in dataclasses.fields(Entry)]
_WORDS, _COUNTS = ("tile", "method"), ("ratio", "bytes")


def write(path: Path, results: Results, conditions: dict) -> None:
    rows = [[name, value, *[""] * (len(_FIELDS) - 2)] for name, value in conditions.items()]
    files.write_text(path, csv_text(_FIELDS, rows + [list(dataclasses.astuple(e)) for e in results.all()]))


def read(path: Path) -> tuple[dict, list[Entry]]:
    """The conditions, as strings, and the entries."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    conditions = {row["tile"]: row["method"] for row in rows if not row["ratio"]}
    return conditions, [_entry(row) for row in rows if row["ratio"]]


def _entry(row: dict) -> Entry:
    values = {}
    for name in _FIELDS:
        text = row[name]
        if name in _WORDS:
            values[name] = text
        else:
            values[name] = None if text == "" else int(text) if name in _COUNTS else float(text)
    return Entry(**values)
