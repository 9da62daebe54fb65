"""How this machine computes: a fingerprint of its elementary functions, and the versions behind them.

libm rounds a sine otherwise on a CPU without fused multiply-add, and another libm does so anyway: machines of one kind
are promised to replay a recording bit for bit, others are not.
"""

from __future__ import annotations

import hashlib
import math
import platform
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np

KIND = ("arithmetic", "python", "numpy", "onnxruntime")  # what decides; the rest of a description is for people
POINTS = 1024  # of each function: one in some 500 differs without fused multiply-add
TELLING = ("fma", "avx2", "avx512f")  # CPU features by which libraries choose their kernels
FLAGS = Path("/proc/cpuinfo")


def platform_fingerprint() -> dict[str, str]:
    """A description of this machine, to go into a recording's provenance; takes a few ms."""
    return {
        "arithmetic": arithmetic(),
        "cpu": " ".join((platform.machine(), *_features())),
        "libc": " ".join(platform.libc_ver()).strip(),
        "python": ".".join(map(str, sys.version_info[:2])),
        "numpy": np.__version__,
        "onnxruntime": _version("onnxruntime"),
    }


def same_kind(one: Mapping[str, str], other: Mapping[str, str]) -> bool:
    """Whether two machines must compute alike; one of which nothing is known counts as the same."""
    return not one or not other or all(one.get(name) == other.get(name) for name in KIND)


def contrast(one: Mapping[str, str], other: Mapping[str, str]) -> str:
    """Where two descriptions differ, the first one's side before the other's; empty if nowhere."""
    names = [name for name in other if one.get(name, "unknown") != other[name]] if one else []
    sides = (", ".join(f"{name} {side.get(name, 'unknown')}" for name in names) for side in (one, other))
    return " against ".join(sides) if names else ""


def arithmetic() -> str:
    """Twelve hex digits of the results of the functions that the core calls.

    Those that numpy computes otherwise with AVX-512 (arctan2, exp, power) are left out as long as the core leaves them
    out: so AVX2 and AVX-512 are one kind.
    """
    x = np.linspace(-7.0, 7.0, POINTS)
    y = x[::-1] * 3.1 + 0.5
    plain, other = x.tolist(), y.tolist()
    digest = hashlib.sha256()
    for of_one in (np.sin, np.cos):
        digest.update(of_one(x).tobytes())
    digest.update(np.mod(x, y).tobytes())
    for function in (math.sin, math.cos, math.tan, math.exp):
        digest.update(np.array(list(map(function, plain))).tobytes())
    for of_two in (math.atan2, math.hypot):
        digest.update(np.array(list(map(of_two, plain, other))).tobytes())
    digest.update(np.array([math.acos(value / 8) for value in plain]).tobytes())
    return digest.hexdigest()[:12]


def _version(name: str) -> str:
    """A package's version; of one that is loaded, without the costly look into its metadata."""
    loaded = sys.modules.get(name)
    if loaded is not None:
        return str(loaded.__version__)
    from importlib.metadata import version

    return version(name)


def _features() -> list[str]:
    try:
        lines = FLAGS.read_text(errors="replace").splitlines()
    except OSError:
        return []
    flags = next((line.split() for line in lines if line.startswith("flags")), [])
    return [name for name in TELLING if name in flags]
