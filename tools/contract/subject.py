"""The package under test, with the parts that its clauses look at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain, Scenario
from tailor.executive.interfaces.outlet import at_rest
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.installed import part, spec_of
from tailor.schemas.packages.scene import SceneView
from tailor.schemas.packages.spec import DomainSpec
from tailor.simnodes.body import Body, Reading
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.action_log import ActionRun
from tailor.tools.lockstep.action_run import PERIOD_NS
from tailor.tools.lockstep.readings import newest

LOOKING_TICKS = 30  # three seconds in which a robot at rest looks around
MAX_SCENARIOS = 6  # of those that a domain has


@dataclass
class Subject:
    """A domain by its name, as installed. Tests of the suite itself replace parts of it.

    Attributes:
      name: Name of the domain.
      runs: Number of runs of each action.
    """

    name: str
    runs: int = 3
    _done: dict[tuple[str, int], ActionRun] = field(default_factory=dict)

    @cached_property
    def spec(self) -> DomainSpec:
        """What its package declares."""
        return spec_of(self.name)

    @cached_property
    def domain(self) -> Domain:
        """The domain."""
        return domains.load(self.name)

    @cached_property
    def scenarios(self) -> list[str]:
        """Names of its first scenarios."""
        return domains.scenarios(self.name)[:MAX_SCENARIOS]

    @cached_property
    def scene(self) -> SceneView:
        """What it looks like."""
        view: SceneView = part(self.spec, "scene")
        return view

    @cached_property
    def body(self) -> Body:
        """Its simulated body; made once, since that is slow, and reset by each use."""
        return action_run.new_body(self.domain)

    def scenario(self, name: str, seed: int) -> tuple[Scenario, dict[str, float]]:
        """A scenario and its start state, drawn with a seed."""
        return domains.load_scenario(self.name, name, np.random.default_rng(seed))

    def sample(self, action: str, seed: int) -> Array:
        """Random arguments of an action, shape (k,)."""
        return action_run.sample_arguments(self.domain, action, np.random.default_rng([4, seed]))

    def run(self, action: str, seed: int) -> ActionRun:
        """A run of an action with random arguments; kept, for other clauses look at it, too."""
        if (action, seed) not in self._done:
            self._done[action, seed] = self.run_with(action, self.sample(action, seed), seed)
        return self._done[action, seed]

    def run_with(self, action: str, arguments: Array, seed: int) -> ActionRun:
        """A run of an action with these arguments, shape (k,)."""
        rng = np.random.default_rng([5, seed])
        return action_run.run_action(self.body, self.domain, action, arguments, rng, traced=True)

    def look(self, start: Mapping[str, float], seed: int = 0) -> tuple[Belief, list[Reading]]:
        """The belief of a robot that stood and looked around, and all that its body sensed."""
        zero = at_rest(self.domain.axes)
        belief, readings = self.domain.initial_belief(), []
        self.body.reset(np.random.default_rng([seed, 1]), start)
        for tick in range(1, LOOKING_TICKS + 1):
            self.body.command(zero)
            new = self.body.advance(PERIOD_NS)
            readings += new
            belief = self.domain.update(belief, tick * PERIOD_NS, newest(new), zero)
        return belief, readings
