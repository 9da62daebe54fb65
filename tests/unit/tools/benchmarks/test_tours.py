"""Plans by steps and by models, compared over the same starts."""

import pytest
from rich.console import Console

from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.planners.tours import compared
from tailor.tools.lockstep.run import Run


def driven(seed, costs):
    """Runs of 10 s and more; by models start 4 fails, and the others save 0, 1, 2 and 3 s."""
    seed -= 100
    ended_s = 11.0 + seed - (seed if costs == "models" else 0)
    return Run("failed" if costs == "models" and seed == 4 else "achieved", 1.0, ended_s)


def test_only_starts_that_both_achieve_are_compared():
    console = Console(width=200, record=True)
    console.print(compared("runs", driven, 5, 100))
    *_, steps, models = console.export_text().splitlines()
    assert steps.split() == ["steps", "5", "1.00", "s", "11.50", "s", "0.00", "s", "(0.00", "to", "0.00)", "0", "0"]
    assert models.split() == ["models", "4", "1.00", "s", "10.00", "s", "1.50", "s", "(-0.55", "to", "3.55)", "3", "0"]


def test_where_no_pair_achieves_nothing_is_measured():
    """The table had "nan s" for all times, and exit code 0."""
    with pytest.raises(NoMeasurement, match="runs: no start from which both"):
        compared("runs", driven, 1, 104)
