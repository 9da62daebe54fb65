"""Speed of gathering episodes: simulated seconds for each wall second and core."""

from __future__ import annotations

import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tailor.executive import domains
from tailor.schemas.installed import domain_names
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.run_data_sets import modelled_actions


def run(console: Console, quick: bool) -> None:
    """Print one row for each action.

    Raises:
      NoMeasurement: An action has gathered no episode.
    """
    table = Table("action", "episodes", "mean duration", "speed (× real time)", title="gathering, one process")
    for name in domain_names():
        robot = domains.load(name).robot
        for action in modelled_actions(name):
            with tempfile.TemporaryDirectory() as folder:
                spec = DataSetSpec(name, action, 40 if quick else 200, 1, Path(folder) / "episodes")
                random_episodes.prepare(spec, resume=False)
                parts = list(random_episodes.gather(spec, random_episodes.missing_parts(spec), jobs=1))
            count, simulated, wall = (sum(column) for column in zip(*parts, strict=True))
            if not count:
                raise NoMeasurement(f"{robot}/{action} gathered no episode")
            table.add_row(f"{robot}/{action}", str(count), f"{simulated / count:.1f} s", f"{simulated / wall:.0f}")
    console.print(table)
