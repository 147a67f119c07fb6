"""scripts/check_language finds what it looks for."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import re

import pytest
from conftest import ROOT


def _module():
    loader = importlib.machinery.SourceFileLoader("check_language", str(ROOT / "scripts/check_language"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_language", loader))
    loader.exec_module(module)
    return module


check = _module()


@pytest.mark.parametrize("rule", check.RULES, ids=lambda rule: rule.pattern)
def test_a_rule_knows_good_from_bad(rule):
    assert not re.search(rule.pattern, rule.good)
    assert re.search(rule.pattern, rule.bad)


@pytest.fixture
def tree(tmp_path):
    (tmp_path / ".gitignore").write_text("/build/\n")

    def violations(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return list(check.violations(tmp_path))

    return violations


def test_a_violation_is_named_with_its_place_and_remedy(tree):
    assert tree("native/src/a.h", "int color;\nint colour;\n") == [
        "native/src/a.h:2: 'colour'; write color",
    ]


def test_what_is_built_has_no_rules(tree):
    assert tree("build/a.h", "int colour;\n") == []


def test_rules_apply_to_the_files_that_they_name(tree):
    assert tree("docs/a.md", "kMostLobes was renamed.\n") == []


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("word " * 24 + "\n", False),
        ("longer " * 24 + "\n", True),
        ("| " + "longer " * 24 + "|\n", False),
        ("```\n" + "longer " * 24 + "\n```\n", False),
        ("word word\n" * 700, False),
        ("word word\n" * 800, True),
    ],
)
def test_pages_keep_their_measure(tree, text, reported):
    assert bool(tree("docs/guide/page.md", text)) == reported


@pytest.mark.parametrize(
    "line",
    [
        "x = StringProperty(description='Of the fit')",
        "x = StringProperty(\n    description=(\n        'That of the fit'\n    )\n)",
        "class A:\n    bl_description = 'Of the fit'",
        "class A:\n    bl_label = 'As in Cycles: '",
        "items = [('A', 'First', 'Of the fit')]",
    ],
)
def test_strings_of_the_interface_begin_with_a_noun_or_a_verb(tree, line):
    (found,) = tree("a.py", line + "\n")
    assert "begin with a noun or a verb" in found
    assert not tree("a.py", re.sub("Of the|That of the|As in", "Seconds of the", line) + "\n")
