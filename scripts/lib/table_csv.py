"""Formats rows as CSV."""

from __future__ import annotations

import csv
import io


def csv_text(header: list, rows: list[list]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([header, *rows])
    return text.getvalue()
