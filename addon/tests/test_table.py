"""The ctypes table says what the C header says."""

from __future__ import annotations

import ctypes
import json
import re
import subprocess

import header
import pytest
from velour.native import errors, structs, table, version


def test_every_function_is_in_the_table_with_its_arguments():
    in_table = {name: len(arguments) for name, arguments in table.STATUS_CALLS.items()}
    in_table |= {name: len(arguments) for name, (_, arguments) in table.PLAIN_CALLS.items()}
    assert in_table == {name: count for name, (_, count) in header.functions().items()}


def test_exactly_the_calls_that_return_a_status_are_checked():
    returning = {name for name, (result, _) in header.functions().items() if result == "vlr_status"}
    assert returning == set(table.STATUS_CALLS)


def test_struct_fields_have_the_names_and_order_of_the_header():
    assert {n: [f for f, _ in s._fields_] for n, s in structs.STRUCTS.items()} == header.structs()


def test_sizes_and_offsets_agree_with_the_compiler(compiler, tmp_path):
    lines = []
    for name, fields in header.structs().items():
        offsets = [f'printf("\\"{f}\\": %zu, ", offsetof({name}, {f}));' for f in fields]
        lines += [f'printf("\\"{name}\\": {{");', *offsets, f'printf("\\"\\": %zu}},", sizeof({name}));']
    body = "\n".join(lines)
    source = tmp_path / "layout.c"
    source.write_text(
        '#include <stddef.h>\n#include <stdio.h>\n#include "velour/velour.h"\n'
        f'int main(void) {{ printf("{{"); {body} printf("\\"\\": 0}}"); return 0; }}\n'
    )
    include = header.HEADER.parents[1]
    subprocess.run([compiler, "-std=c99", f"-I{include}", source, "-o", tmp_path / "layout"], check=True)
    measured = json.loads(subprocess.check_output([tmp_path / "layout"]))
    for name, struct in structs.STRUCTS.items():
        ours = {field: getattr(struct, field).offset for field, _ in struct._fields_}
        assert {**ours, "": ctypes.sizeof(struct)} == measured[name], name


@pytest.mark.parametrize(
    ("prefix", "names"),
    [
        ("VLR_KERNEL_", table.KERNELS),
        ("VLR_MODEL_", table.MODELS),
        ("VLR_PEER_", table.PEERS),
        ("VLR_MASKING_", table.MASKINGS),
        ("VLR_PLOT_", tuple(name.replace("-", "_") for name in table.PLOTS)),
        ("VLR_LIGHT_", table.LIGHTS),
        ("VLR_CAMERA_", table.CAMERAS),
        ("VLR_WRAP_", table.WRAPS),
        ("VLR_FILTER_", table.FILTERS),
        ("VLR_LAYER_", table.LAYERS),
        ("VLR_GLASS_", table.GLASS_FRESNELS),
        ("VLR_FACTOR_", table.FACTORS),
        ("VLR_RELIEF_", table.RELIEF_CORRECTIONS),
        ("VLR_OPERATION_", table.OPERATIONS),
        ("VLR_SOURCE_", table.SOURCES),
        ("VLR_SHIFT_", table.SHIFTS),
        ("VLR_MATH_", table.MATH),
        ("VLR_VECTOR_", table.VECTOR_MATH),
        ("VLR_BLEND_", table.BLENDS),
        ("VLR_COLOR_MODEL_", table.COLOR_MODELS),
        ("VLR_RANGE_", table.RANGES),
        ("VLR_MAPPING_", table.MAPPINGS),
        ("VLR_NOISE_", table.NOISES),
        ("VLR_VORONOI_", table.VORONOI_FEATURES),
        ("VLR_METRIC_", table.METRICS),
        ("VLR_WAVE_AXIS_", table.WAVE_AXES),
        ("VLR_WAVE_PROFILE_", table.WAVE_PROFILES),
        ("VLR_GRADIENT_", table.GRADIENTS),
        ("VLR_VALUE_", table.VALUES),
        ("VLR_STRATEGY_", table.STRATEGIES),
        ("VLR_JOB_", table.JOB_STATES),
    ],
)
def test_names_of_choices_stand_at_their_numbers(prefix, names):
    expected = {prefix + name.upper().replace("-", "_"): number for number, name in enumerate(names)}
    assert header.constants(prefix) == expected


def test_hidden_bits():
    bits = {f"VLR_HIDDEN_FROM_{name.upper()}": bit for name, bit in table.HIDDEN.items() if name != "holdout"}
    assert header.constants("VLR_HIDDEN_FROM_") == bits
    assert header.constants("VLR_HOLD") == {"VLR_HOLDOUT": table.HIDDEN["holdout"]}


def test_pass_bits():
    assert header.constants("VLR_PASS_") == {f"VLR_PASS_{n.upper()}": bit for n, bit in table.PASSES.items()}


def test_status_codes():
    for status in errors.Status:
        assert re.search(rf"\bVLR_{status.name} = {status.value}\b", header.text())


def test_interface_number():
    assert re.search(rf"#define VLR_ABI_VERSION {version.ABI_VERSION}\b", header.text())
