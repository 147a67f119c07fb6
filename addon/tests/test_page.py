"""Tables, templates and kept numbers of measured pages."""

from __future__ import annotations

import importlib

import pytest
from bench import __main__ as bench
from bench import page


def test_cells_are_templates():
    rows = [{"a": 0.125, "b": 2500, "c": {"d": "x"}}, {"a": None, "b": None, "c": {"d": 1}}]
    template = "| share | kilo | inner |\n*rows* | {a:p} | {b:k.1f} | {c[d]} |\n"
    table = "| share | kilo | inner |\n|---|---|---|\n| 12.50 % | 2.5 | x |\n| - | - | 1 |\n"
    assert page.filled(template, {"rows": rows}) == table
    assert page.filled("{b}/{b:M.4f}", rows[0]) == "2500/0.0025"
    assert page.filled("{a}/{a:.1f}", rows[1]) == "/-"


def test_sections_repeat_and_may_hold_others():
    inner = "*each parts*\n{part} of {name}\n*end parts*\n"
    template = f"{{title}}\n*each sections*\n## {{name}}\n{inner}*end sections*\nafter\n"
    sections = [{"name": "a", "parts": [{"part": 1}, {"part": 2}]}, {"name": "b", "parts": []}]
    found = page.filled(template, {"title": "All", "sections": sections})
    assert found == "All\n## a\n1 of a\n2 of a\n## b\nafter\n"


def test_numbers_come_back_as_they_were(tmp_path):
    rows = [{"name": "a", "one": 1, "two": 1 / 3, "three": None}, {"name": "b", "one": True, "three": "x, y"}]
    conditions = {"machine": "AMD, 2 threads", "commit": "12345678e123", "size": "3x4"}
    page.write_rows(tmp_path / "folder/rows.csv", rows, conditions)
    known, found = page.read_rows(tmp_path / "folder/rows.csv")
    assert known == conditions
    assert found == [rows[0], rows[1] | {"two": None}]


@pytest.mark.parametrize("name", bench.PAGES)
def test_every_page_can_be_measured_and_has_options_of_known_kinds(name):
    module = importlib.import_module(f"bench.pages.{name}")
    assert module.__doc__
    assert callable(module.measure)
    args = bench._arguments(module, name, ["--quick"])
    for setting, (full, quick) in module.SETTINGS.items():
        assert getattr(args, setting) == quick
        assert type(full) is type(quick), setting


def test_settings_are_options():
    chart = importlib.import_module("bench.pages.chart")
    words = ["--size=16x12", "--spp=4,8", "--worlds=sky", "--level-spp=4"]
    args = bench._arguments(chart, "chart", words)
    assert (args.size, args.spp, args.worlds, args.level_spp) == ((16, 12), (4, 8), ("sky",), 4)
    assert args.seeds == chart.SETTINGS["seeds"][0]
