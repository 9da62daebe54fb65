"""One action as an environment: from a random start to a random goal, as its action models are learned.

Each step is a period of 10 Hz. Start, goal and first belief come from the task sampler of the robot's package. Whether
the goal is reached, decides the action's own controller, which watches and does not command.
"""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.spaces import Dict

from tailor.executive import domains
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.outlet import at_rest, completed
from tailor.executive.interfaces.values import Array
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.tools.gym.spaces import (
    Command,
    believed,
    checked_arguments,
    checked_limit,
    clipped,
    command_space,
    numbers,
    only_option,
    width,
)
from tailor.tools.lockstep.action_run import PERIOD_NS, TIME_LIMIT_S
from tailor.tools.lockstep.bodies import made_body
from tailor.tools.lockstep.readings import judged, newest
from tailor.tools.lockstep.task_sampler import sampler_of

PERIOD_S = PERIOD_NS * 1e-9
MAX_DRAWS = 100


class ActionEnv(gymnasium.Env[Any, Any]):  # type: ignore[misc]
    """Execute an action from its start to its goal, in as little time as possible.

    Action: a command for all axes, shape (axes,), see `spaces.command_space`; clipped.
    Observation: `belief`, the state variables of `domain.belief_names`; `arguments`, those of the action's controller
    and models, with the believed state in place of the start.
    Reward: minus the simulated seconds of the step; after a failure, minus the rest of the time limit as well.
    Termination: the controller reports that it is done; or it, or the package's sampler, reports a failure. Truncation:
    the time limit.
    Info: `command` of the action's own controller, `time_s`, `failure` (empty: none), `done`.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}

    def __init__(self, domain: str, action: str = "", limit_s: float = TIME_LIMIT_S) -> None:
        """Load domain, sampler and body; no action models are needed.

        Args:
          domain: Name of an installed domain.
          action: One of its executable actions; empty: the first.
          limit_s: Time limit of an episode, simulated seconds, above 0.

        Raises:
          UsageError: Unknown domain or action, the package has no body or no sampler, or no such time limit.
        """
        self._limit_s = checked_limit(limit_s)
        self._domain = domains.load(domain)
        name = action or next(iter(self._domain.actions))
        if name not in self._domain.actions:
            raise UsageError(f"no action {name!r} in {domain}, expected one of: {', '.join(self._domain.actions)}")
        self._action, self._sampler = self._domain.actions[name], sampler_of(self._domain)
        self._body = made_body(self._domain)
        self.action_space = command_space(self._domain, shipped_driver_spec(self._domain.robot))
        self.observation_space = Dict(
            belief=numbers(len(self._domain.belief_names)), arguments=numbers(width(self._action))
        )
        self._arguments: Array
        self._start: dict[str, float]
        self._belief: Any = None
        self._control: Control
        self._command: Command = ()  # the last one
        self._wanted: Command = ()  # by the controller
        self._failure = ""
        self._tick = 0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Array], dict[str, Any]]:
        """Draw arguments and start; those that are done at once are drawn again.

        Args:
          seed: Seed of this and all later episodes; None: the next episode.
          options: `arguments` of the controller, shape (k,), instead of those that are drawn.

        Raises:
          UsageError: There is another option, or the given arguments are not finite numbers of that shape, or the
            action ends at once, in each of MAX_DRAWS draws.
        """
        super().reset(seed=seed)
        given = only_option(options, "arguments")
        arguments = None if given is None else checked_arguments(self._action, given)
        for _ in range(MAX_DRAWS):
            rng = np.random.default_rng(self.np_random.integers(2**63, size=2))
            self._begin(self._sampler.sample(self._action, rng) if arguments is None else arguments.copy(), rng)
            if not self._over():
                return self._observation(), self._info()
        raise UsageError(f"{self._action.name}: ends at once, in {MAX_DRAWS} draws of its arguments")

    def step(self, action: Any) -> tuple[dict[str, Array], float, bool, bool, dict[str, Any]]:
        """Send a command for one period."""
        self._command = clipped(self.action_space, action)
        self._body.command(self._command)
        readings = self._body.advance(PERIOD_NS)
        self._tick += 1
        now_ns = self._tick * PERIOD_NS
        self._belief = self._domain.update(self._belief, now_ns, newest(readings), self._command)
        self._failure = self._failure or judged(self._sampler, self._action, self._start, readings)
        self._watch()
        over, left_s = self._over(), self._limit_s - self._tick * PERIOD_S
        reward = -PERIOD_S - (max(0.0, left_s) if self._failure else 0.0)
        return self._observation(), reward, over, not over and left_s <= 0.5 * PERIOD_S, self._info()

    def _begin(self, arguments: Array, rng: np.random.Generator) -> None:
        """Put the body at the start of the action; the noise of the run is drawn from `rng`, too."""
        self._arguments = arguments
        self._start = self._sampler.start(self._action, arguments, rng)
        self._belief = self._sampler.belief(self._start, rng)
        self._body.reset(rng, self._start)
        self._control, self._command = Control(None, ()), at_rest(self._domain.axes)
        self._failure, self._tick = "", 0
        self._watch()

    def _watch(self) -> None:
        """One step of the action's controller, and what the ground truth shows."""
        state, now_ns = self._control.state, self._tick * PERIOD_NS
        self._control = self._action.controller(state, now_ns, self._belief, self._arguments)
        self._wanted = completed(self._domain, self._action, self._control.command, self._command)
        seen = self._sampler.failure(self._action, self._start, self._body.ground_truth())
        failed = self._control.detail or "failed" if self._control.outcome == "failed" else ""
        self._failure = self._failure or seen or failed

    def _over(self) -> bool:
        return bool(self._failure) or self._control.outcome != "running"

    def _observation(self) -> dict[str, Array]:
        arguments = self._sampler.arguments_now(self._action, self._belief, self._arguments)
        return {"belief": believed(self._domain, self._belief), "arguments": np.array(arguments, dtype=np.float64)}

    def _info(self) -> dict[str, Any]:
        done = self._control.outcome == "done"
        time_s = self._tick * PERIOD_NS / 1e9
        return {"command": np.array(self._wanted), "time_s": time_s, "failure": self._failure, "done": done}
