"""Runs a soccer scenario in simulated time, in one process without a bus: executive, physics, driver and guard."""

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tailor.tools.lockstep.worlds import make_world

context = build_context(ExecutiveConfig("soccer", "approach-dribble", Settings(seed=1)), SENDER)
run = run_lockstep(context, make_world("agilo", "approach-dribble", seed=1))
print(f"{run.result} in {run.duration_s:.1f} s")
for finished in run.finished:
    print(f"{finished.action}: {finished.outcome}")
