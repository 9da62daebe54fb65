"""Fingerprint of this platform's floating-point arithmetic, and the versions behind it.

libm rounds differently on a CPU without fused multiply-add, and so does another libm. Only a platform of the same kind
replays a recording bit for bit. Matrix products, whose kernels a CPU selects, occur in proofs of optimality gaps only;
they have a fingerprint of their own.
"""

from __future__ import annotations

import hashlib
import math
import platform
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

KIND = ("arithmetic", "python", "numpy", "onnxruntime")  # these decide; the other entries are informative
POINTS = 1024  # per function; about one in 500 results differs without fused multiply-add
FEATURES = ("fma", "avx2", "avx512f")  # CPU features that select the kernels of libraries
FLAGS = Path("/proc/cpuinfo")


def platform_fingerprint() -> dict[str, str]:
    """Description of this platform for the provenance of a recording; takes a few ms."""
    return {
        "arithmetic": arithmetic(),
        "products": products(),
        "cpu": " ".join((platform.machine(), *_features())),
        "libc": " ".join(platform.libc_ver()).strip(),
        "python": ".".join(map(str, sys.version_info[:2])),
        "numpy": np.__version__,
        "onnxruntime": _version("onnxruntime"),
    }


def same_kind(one: Mapping[str, str], other: Mapping[str, str]) -> bool:
    """Whether two platforms compute identically; an unknown platform (empty) counts as the same kind."""
    return not one or not other or all(one.get(name) == other.get(name) for name in KIND)


def same_products(one: Mapping[str, str], other: Mapping[str, str]) -> bool:
    """Whether two platforms also multiply matrices identically; an unknown platform (empty) counts as one that does."""
    return not one or not other or (same_kind(one, other) and one.get("products") == other.get("products"))


def contrast(one: Mapping[str, str], other: Mapping[str, str]) -> str:
    """Entries that differ, those of `one` before those of `other`; empty if none does."""
    names = [name for name in other if one.get(name, "unknown") != other[name]] if one else []
    sides = (", ".join(f"{name} {side.get(name, 'unknown')}" for name in names) for side in (one, other))
    return " against ".join(sides) if names else ""


def arithmetic() -> str:
    """Hash of the results of all functions that the core calls: twelve hex digits.

    The core does not call the functions that numpy computes differently with AVX-512 (arctan2, exp, power). They are
    not hashed either, so that AVX2 and AVX-512 are one kind.
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


def products() -> str:
    """Hash of matrix products of the shapes that bounds of networks have: twelve hex digits."""
    x = np.linspace(-7.0, 7.0, 3 * 32 * 24)
    digest = hashlib.sha256()
    for precision in (np.dtype(np.float32), np.dtype(np.float64)):
        weights: NDArray[Any] = np.sin(x).astype(precision).reshape(3, 32, 24)
        rows: NDArray[Any] = np.cos(x).astype(precision).reshape(24, -1)
        digest.update((weights @ rows).tobytes())
        digest.update((weights.transpose(0, 2, 1) @ (weights @ rows)).tobytes())
        digest.update((rows[0] @ rows.T).tobytes())
    return digest.hexdigest()[:12]


def _version(name: str) -> str:
    """Version of a package; reading metadata is slow, so a loaded package is queried directly."""
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
    return [name for name in FEATURES if name in flags]
