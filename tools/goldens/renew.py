"""Renew the golden recordings of the tests, one lock-step run per scenario, and print the changes.

`make goldens` prints the changes and then overwrites. `python -m tailor.tools.goldens.renew --check` only prints them;
its exit code is 1 if there are any.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context, provenance
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.runtime.platform_fingerprint import platform_fingerprint
from tailor.schemas.errors import UsageError
from tailor.tools.goldens.changes import changes, outcome
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tailor.tools.lockstep.run_recording import LockstepRecording
from tailor.tools.lockstep.run_writer import RunWriter
from tailor.tools.lockstep.worlds import make_world
from tailor.tools.recordings.comparison import compared_run

FOLDER = Path(__file__).resolve().parents[2] / "tests" / "data" / "golden"
LETTERS = ("word-I",)  # the arm has a scenario for every word
WITH_OPPONENTS = ("opponents-approach", "opponents-dribble")  # one with opponents, "opponents", is enough
CHECKS = 40  # per tick: so few that a deliberation takes several ticks and is resumed, as on a slow machine


@dataclass(frozen=True, slots=True)
class Golden:
    """One golden recording: scenario and seed of its run."""

    domain: str
    scenario: str
    seed: int = 0

    @property
    def name(self) -> str:
        """Name of the file, without its suffix."""
        return f"{self.domain}-{self.scenario}"


def goldens() -> list[Golden]:
    """All golden recordings: every scenario of soccer but those that are others with opponents, and one letter."""
    soccer = [Golden("soccer", scenario) for scenario in domains.scenarios("soccer") if scenario not in WITH_OPPONENTS]
    return [*soccer, *(Golden("arm", letter) for letter in LETTERS)]


def record(golden: Golden, path: Path) -> None:
    """Run the scenario in lock-step and write the recording; equal bytes on every platform of the same kind."""
    config = ExecutiveConfig(golden.domain, golden.scenario, Settings(seed=golden.seed))
    context = build_context(config, SENDER)
    world = make_world(context.domain.robot, golden.scenario, golden.seed)
    writer = RunWriter(path, context, {**provenance(config, context), "machine": platform_fingerprint()}, compact=True)
    recording = LockstepRecording(writer)
    budgets = partial(CheckBudget, CHECKS)
    run_lockstep(context, world, new_budget=budgets, on_tick=recording.on_tick, transport=recording.transport)
    writer.close()


def main(argv: Sequence[str] | None = None) -> int:
    """Compare and overwrite; 0, or 1 with --check if there are changes."""
    parser = argparse.ArgumentParser(prog="python -m tailor.tools.goldens.renew", description=__doc__)
    parser.add_argument("names", nargs="*", help="golden recordings, e.g. soccer-waypoints (default: all)")
    parser.add_argument("--check", action="store_true", help="only print the changes")
    arguments = parser.parse_args(argv)
    by_name = {golden.name: golden for golden in goldens()}
    unknown = [name for name in arguments.names if name not in by_name]
    if unknown:
        print(f"no golden recording {unknown[0]!r}, expected one of: {', '.join(by_name)}", file=sys.stderr)
        return 2
    changed = [name for name in arguments.names or by_name if _renewed(by_name[name], write=not arguments.check)]
    for path in [] if arguments.names else _obsolete(set(by_name)):
        print(f"{path.stem}: the scenario no longer exists{'' if arguments.check else ', removed'}")
        changed.append(path.stem)
        if not arguments.check:
            path.unlink()
    return int(bool(changed) and arguments.check)


def _renewed(golden: Golden, write: bool) -> bool:
    """Run the scenario again, print the changes, and replace the recording if `write` is set."""
    kept = FOLDER / f"{golden.name}.mcap"
    with tempfile.TemporaryDirectory() as folder:
        new = Path(folder) / kept.name
        record(golden, new)
        lines = _changes(kept, new)
        print(f"{golden.name}: {('changed' if kept.exists() else 'new') if lines else 'unchanged'}")
        for line in lines:
            print(f"  {line}")
        if lines and write:
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_bytes(new.read_bytes())
    return bool(lines)


def _changes(kept: Path, new: Path) -> list[str]:
    if not kept.exists():
        return [f"now       {outcome(compared_run(new))}"]
    try:
        return changes(kept, new)
    except UsageError as error:
        return [f"the old one cannot be read: {error}", f"now       {outcome(compared_run(new))}"]


def _obsolete(names: set[str]) -> list[Path]:
    return sorted(path for path in FOLDER.glob("*.mcap") if path.stem not in names)


if __name__ == "__main__":
    sys.exit(main())
