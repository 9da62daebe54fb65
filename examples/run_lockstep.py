"""Runs a soccer scenario in simulated time, in one process without a bus: executive, physics, driver and guard."""

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.core.context import Settings
from tailor.simnodes.agilo.body import AgiloBody
from tailor.tools.lockstep.run import SENDER, run_lockstep

context = build_context(ExecutiveConfig("soccer", "approach-dribble", Settings(seed=1)), SENDER)
_, start = domains.seeded_scenario("soccer", "approach-dribble", seed=1)
run = run_lockstep(context, AgiloBody(), start, seed=1)
print(f"{run.result} in {run.duration_s:.1f} s")
for finished in run.finished:
    print(f"{finished.action}: {finished.outcome}")
