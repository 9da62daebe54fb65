"""Fingerprint of the functions that the core calls: whether two machines compute alike."""

import ast
import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tailor.runtime.platform_fingerprint import KIND, contrast, platform_fingerprint, same_kind, same_products

ROOT = Path(__file__).resolve().parents[3]
CORE = [*(ROOT / "executive").rglob("*.py"), ROOT / "models" / "features" / "intervals.py"]
# numpy rounds these differently if the CPU has AVX-512, and the fingerprint excludes them
VARYING = {"arctan2", "arctan", "arcsin", "arccos", "tan", "exp", "expm1", "log", "log1p", "tanh", "power", "cbrt"}
KNOWN = {
    "executive/actions/cubic.py",  # powers of Python's floats: libm's, which do not vary
    "executive/planning/plans/vhpop_reader.py",  # likewise
    "models/features/intervals.py",  # proofs of the gap only: margins far wider than a last bit
}


def varying(path):
    """Whether a file calls one of those functions, or raises something to a computed power."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.value.id == "np" and node.attr in VARYING:
                return True
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and not isinstance(node.right, ast.Constant):
            return True
    return False


def test_core_calls_what_varies_with_avx_512_in_known_places_only():
    assert {path.relative_to(ROOT).as_posix() for path in CORE if varying(path)} == KNOWN


def test_a_machine_is_of_its_own_kind_and_describes_itself():
    here = platform_fingerprint()
    assert here == platform_fingerprint()
    assert len(here["arithmetic"]) == 12
    assert here["cpu"]
    assert same_kind(here, here)
    assert contrast(here, here) == ""


@pytest.mark.parametrize("name", KIND)
def test_another_arithmetic_or_version_is_another_kind(name):
    here, there = platform_fingerprint(), {**platform_fingerprint(), name: "another"}
    assert not same_kind(there, here)
    assert contrast(there, here) == f"{name} another against {name} {here[name]}"


def test_other_matrix_products_are_the_same_kind_but_not_the_same_products():
    here, there = platform_fingerprint(), {**platform_fingerprint(), "products": "another"}
    assert same_kind(there, here)
    assert not same_products(there, here)
    assert same_products(here, here)
    assert not same_products({**here, KIND[0]: "another"}, here)
    older = {name: value for name, value in here.items() if name != "products"}
    assert not same_products(older, here), "unknown products are not the same"


@pytest.mark.skipif(platform.machine() != "x86_64", reason="names kernels of x86")
def test_another_kernel_of_matrix_products_has_another_fingerprint():
    command = [sys.executable, "-c", "from tailor.runtime.platform_fingerprint import products; print(products())"]
    seen = {
        subprocess.run(
            command, env={**os.environ, "OPENBLAS_CORETYPE": kernel}, capture_output=True, text=True, check=True
        ).stdout
        for kernel in ("Nehalem", "Sandybridge")
    }
    if "openblas" not in str(np.show_config("dicts")).lower():
        pytest.skip("numpy multiplies with another library")
    assert len(seen) == 2


def test_another_cpu_that_computes_alike_is_the_same_kind_but_is_reported():
    here, there = platform_fingerprint(), {**platform_fingerprint(), "cpu": "x86_64 fma"}
    assert same_kind(there, here)
    assert contrast(there, here) == f"cpu x86_64 fma against cpu {here['cpu']}"


def test_a_recording_without_a_platform_is_compared_exactly():
    assert same_kind({}, platform_fingerprint())
    assert contrast({}, platform_fingerprint()) == ""
