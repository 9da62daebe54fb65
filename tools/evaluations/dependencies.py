"""Hashes of what a run depends on besides task, variant and seed: a stored one counts while all are the same."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tailor.executive import domains
from tailor.schemas.installed.source import ROOT, runs_sha256
from tailor.schemas.installed.source_text import content_sha256
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.learning.gathering.choosing_models import cached_models

# Files that make or summarise runs, as patterns below ROOT, besides those of `runs_sha256`; the latter ones only some.
EVERY = tuple(f"tools/evaluations/{name}.py" for name in ("costs", "outcome", "pinned", "task_runs", "tick_budget"))
HAND_MADE = ("tools/evaluations/detours/*.py",)
SEARCH = ("tools/evaluations/oracles/search.py",)
FIGURES = (*EVERY, "tools/evaluations/paired_comparison.py", "tools/evaluations/models/*.py")  # of a set of models
OVER_BUS = (
    "executive/*.py",
    "runtime/**/*.py",
    "schemas/**/*.py",
    "simnodes/*.py",
    "tools/launch/*.py",
    "tools/evaluations/live/bus_run.py",
)


def dependencies(task: Task, variant: Variant, others: Sequence[str] = ()) -> list[str]:
    """Hashes of models and source code, on which a run depends besides task, variant and seed.

    Args:
      task: Scenario of the run.
      variant: Its settings.
      others: Patterns of further files, as SEARCH.
    """
    models: Any = cached_models(domains.load(task.domain).robot, task.zoo)
    cards = [model.card["sha256"] for model in (*models.durations.values(), *models.successes.values())]
    patterns = (*EVERY, *(HAND_MADE if variant.hand_made else ()), *others)
    return [*sorted(cards), runs_sha256(task.domain), *hashes_of(patterns)]


def hashes_of(patterns: Sequence[str]) -> list[str]:
    """Hashes of the files that patterns below ROOT match, in the order of their paths."""
    return [content_sha256(path) for path in sorted(path for pattern in patterns for path in ROOT.glob(pattern))]
