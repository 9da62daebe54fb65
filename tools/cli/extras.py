"""Extras of the distribution: which command needs which, and what to install when one is missing.

The base package is what a robot runs; `pip install 'tailor[sim,learn]'` adds more.
"""

from __future__ import annotations

import importlib.util

from tailor.schemas.errors import UsageError

# extra -> the modules that it brings and that the code imports
EXTRAS: dict[str, tuple[str, ...]] = {
    "sim": ("mujoco",),
    "bullet": ("pybullet",),
    "learn": ("joblib", "onnx", "pyarrow", "sklearn", "skl2onnx", "scipy", "threadpoolctl"),
    "plots": ("matplotlib",),
    "cluster": ("distributed",),
    "kairos": ("kairos",),
    "gym": ("gymnasium",),
    "hub": ("huggingface_hub",),
    "up": ("unified_planning",),
}
# command -> extras without which it can do nothing; others are missed only where an option needs them
NEEDS: dict[str, tuple[str, ...]] = {
    "demo": ("sim", "plots"),
    "letters": ("sim", "plots"),
    "picture": ("plots",),
    "gather": ("sim", "learn"),
    "train": ("learn",),
    "make-models": ("sim", "learn"),
    "evaluate": ("sim", "learn", "plots"),
}
BENCHMARKS_NEED: dict[str, tuple[str, ...]] = {
    "ticks": ("sim",),
    "refine": ("learn",),
    "models": ("learn",),
    "gather": ("sim",),
    "memory": ("sim",),
    "recording": ("sim",),
    "soak": ("sim", "learn"),
    "growth": ("sim", "learn", "plots"),
    "cluster": ("sim", "learn", "cluster"),
}


def require(*extras: str) -> None:
    """Check that what an operation imports is installed; nothing is imported.

    Raises:
      UsageError: Something is missing; the message names the extras to install.
    """
    missing = [extra for extra in extras if any(importlib.util.find_spec(name) is None for name in EXTRAS[extra])]
    if missing:
        raise UsageError(advice(missing))


def advice(extras: list[str]) -> str:
    """What to install, in one line."""
    plural = "s" if len(extras) > 1 else ""
    return f"needs the extra{plural} {', '.join(extras)}: pip install 'tailor[{','.join(extras)}]'"


def extra_of(error: BaseException | None) -> str:
    """The extra that brings the module whose import failed; empty if the error is another one."""
    if not isinstance(error, ModuleNotFoundError) or error.name is None:
        return ""
    name = error.name.split(".")[0]
    return next((extra for extra, modules in EXTRAS.items() if name in modules), "")
