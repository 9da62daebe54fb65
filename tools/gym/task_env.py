"""A scenario as an environment: the executive plans and watches, the agent commands the robot.

Each step is a period of 10 Hz. The executive estimates the belief, plans, refines, starts actions and decides when one
is done, as in a run of its own; only the commands of its controllers are replaced by those of the agent.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.spaces import Dict

from tailor.executive import domains
from tailor.executive.core.execution import controller_arguments
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Inputs, Output, State, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PERIOD_NS, Context, Settings, make_context
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.outlet import messages_of
from tailor.executive.interfaces.reasons import Result
from tailor.executive.interfaces.values import Array
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.world import World
from tailor.tools.gym.spaces import (
    Command,
    believed,
    checked_limit,
    clipped,
    command_space,
    numbers,
    only_option,
    padded,
    width,
)
from tailor.tools.lockstep.driver_link import DriverLink
from tailor.tools.lockstep.run import CHECKS_PER_TICK, SENDER
from tailor.tools.lockstep.worlds import events_of, make_world

PERIOD_S = PERIOD_NS * 1e-9
MAX_DRAWS = 10
MAX_WAIT_S = 90.0  # simulated, for the first action of a draw; before the episode, and no part of its limit


class TaskEnv(gymnasium.Env[Any, Any]):  # type: ignore[misc]
    """Pursue the goal of a scenario, in as little time as possible.

    Action: a command for all axes, shape (axes,), see `spaces.command_space`; clipped.
    Observation: `belief`, the state variables of `domain.belief_names`; `action`, one-hot over `domain.actions`, all
    zero between actions; `arguments`, those of the running action's controller, in its units, followed by zeros.
    Reward: minus the simulated seconds of the step; when the task fails, minus the rest of the time limit as well. So
    the return is minus the time to the goal, and no failure is better than any success.
    Termination: the goal is achieved or has failed. Truncation: the time limit.
    Info: `command` of the executive's own controller, `mode`, `action` by name, `time_s`, at the end `result`; after a
    reset also `seed`, with which `tailor up --seed` draws the same scenario.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}

    def __init__(
        self, domain: str, scenario: str = "", zoo: str = "", limit_s: float = 90.0, checks: int = CHECKS_PER_TICK
    ) -> None:
        """Load domain, models and body.

        Args:
          domain: Name of an installed domain.
          scenario: One of its scenarios; empty: the first.
          zoo: Folder of action models; empty: those of the robot's package.
          limit_s: Time limit of an episode, simulated seconds from its first action on, above 0.
          checks: Budget of the deliberation in each step, at least 1; fewer are faster to simulate, more refine better.

        Raises:
          UsageError: Unknown domain or scenario, no body, no action models, or no such limit or number of checks.
        """
        if not isinstance(checks, int | np.integer) or checks < 1:
            raise UsageError(f"checks is {checks!r}, expected a whole number, at least 1")
        self._limit_s, self._checks = checked_limit(limit_s), int(checks)
        self._domain = domains.load(domain)
        self._scenario = scenario or domains.scenarios(domain)[0]
        self._models = load_models(self._domain.robot, zoo)
        self._body = make_world(self._domain.robot, self._scenario, 0).body  # refuses an unknown scenario
        self._names = tuple(self._domain.actions)
        self._width = max(width(action) for action in self._domain.actions.values())
        self.action_space = command_space(self._domain, shipped_driver_spec(self._domain.robot))
        self.observation_space = Dict(
            belief=numbers(len(self._domain.belief_names)),
            action=gymnasium.spaces.Box(0.0, 1.0, (len(self._names),), dtype=np.float64),
            arguments=numbers(self._width),
        )
        self._context: Context
        self._link: DriverLink
        self._state: State
        self._outputs: tuple[Output, ...] = ()
        self._tick = self._begun = 0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Array], dict[str, Any]]:
        """Draw the scenario anew, and wait until the executive starts its first action.

        Args:
          seed: Seed of this and all later episodes; None: the next episode.
          options: `seed` of the scenario, instead of one that is drawn.

        Raises:
          UsageError: There is another option, or the given seed is no whole number from 0 up; or no action starts, in
            none of MAX_DRAWS draws.
        """
        super().reset(seed=seed)
        given = only_option(options, "seed")
        if given is not None and (not isinstance(given, int | np.integer) or given < 0):
            raise UsageError(f"seed of the scenario is {given!r}, expected a whole number, at least 0")
        for _ in range(MAX_DRAWS):
            drawn = int(self.np_random.integers(2**31))
            drawn = drawn if given is None else int(given)
            self._begin(drawn)
            while not self._over() and self._state.task.running is None and self._tick * PERIOD_S < MAX_WAIT_S:
                self._next_tick(self._state.command)
            if self._state.task.running is not None:
                self._begun = self._tick
                return self._observation(), {**self._info(), "seed": drawn}
        raise UsageError(f"{self._scenario}: no action starts, in {MAX_DRAWS} draws of the scenario")

    def step(self, action: Any) -> tuple[dict[str, Array], float, bool, bool, dict[str, Any]]:
        """Send a command for one period."""
        self._next_tick(clipped(self.action_space, action))
        over, left_s = self._over(), self._limit_s - (self._tick - self._begun) * PERIOD_S
        failed = over and self._state.task.result is not Result.ACHIEVED
        reward = -PERIOD_S - (max(0.0, left_s) if failed else 0.0)
        info = self._info() | ({"result": self._state.task.result_text or str(self._state.fault)} if over else {})
        return self._observation(), reward, over, not over and left_s <= 0.5 * PERIOD_S, info

    def _begin(self, seed: int) -> None:
        """Put body and executive at the start of a scenario, and run the first tick."""
        scenario, start = domains.seeded_scenario(self._domain.name, self._scenario, seed)
        doubts = domains.doubts(self._domain.name)
        self._context = make_context(self._domain, scenario, self._models, Settings(seed=seed), SENDER, doubts=doubts)
        world = World(self._body, start, seed, events_of(scenario))
        self._link, self._tick, self._outputs = DriverLink(self._domain, world, SENDER), 0, ()
        self._state = initial_state(self._context)
        self._next_tick(self._state.command, self._context.problem.goal_text)

    def _next_tick(self, command: Command, goal: str = "") -> None:
        """Send a command in place of the executive's, and run its next tick with what the sensors measure."""
        now_ns = self._tick * PERIOD_NS
        messages = dict(messages_of(self._domain, command, self._context.stamp(now_ns)))
        sent = [replace(each, message=messages.get(each.topic, each.message)) for each in self._outputs]
        self._link.send(sent, now_ns, self._tick)
        samples, _ = self._link.advance(now_ns)
        self._tick += 1
        state, inputs = replace(self._state, command=command), Inputs(samples, goal)
        budget = CheckBudget(self._checks)
        self._state, self._outputs = step(self._context, state, self._tick * PERIOD_NS, inputs, budget)

    def _over(self) -> bool:
        return not self._state.task.active or self._state.mode is Mode.FAULT

    def _observation(self) -> dict[str, Array]:
        running = self._state.task.running
        chosen = [running is not None and name == running.action.name for name in self._names]
        arguments = () if running is None else controller_arguments(running)
        return {
            "belief": believed(self._domain, self._state.belief),
            "action": np.array(chosen, dtype=np.float64),
            "arguments": padded(arguments, self._width),
        }

    def _info(self) -> dict[str, Any]:
        running = self._state.task.running
        return {
            "command": np.array(self._state.command),
            "mode": self._state.mode.value,
            "action": "" if running is None else running.action.name,
            "time_s": (self._tick - self._begun) * PERIOD_NS / 1e9,
        }
