"""Task, variant and outcome of the runs that an evaluation compares."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tailor.executive.interfaces.domain import Domain
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.messages import Subgoals
from tailor.tools.evaluations.costs import NO_COSTS, Costs, costs_of
from tailor.tools.lockstep.run import Run
from tailor.tools.lockstep.task_sampler import sampler_of

FIRST_SEED = 1_000_000  # of evaluations; settings are chosen on smaller seeds
OTHER_NOISE = 500_000  # between the `noise` of two runs from the same start


@dataclass(frozen=True, slots=True)
class Variant:
    """Settings of a run.

    Attributes:
      name: Unique within an evaluation.
      refinement: Settings of refinement.
      pins: Choices that the run is forced to make: label, quantity, value.
      noise: Added to the seed of the body's noise.
      hand_made: Whether controllers drive around objects by geometry (detours), for a baseline.
    """

    name: str
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    pins: tuple[tuple[str, str, float], ...] = ()
    noise: int = 0
    hand_made: bool = False


@dataclass(frozen=True, slots=True)
class Task:
    """Scenario that an evaluation runs.

    Attributes:
      domain: Name of the domain.
      scenario: Name of the scenario.
      profile: Of the body: "", or "degraded".
      zoo: Folder of action models; empty: the shipped ones.
      goal: PDDL goal that replaces the scenario's; empty: the scenario's own.
      drawn: Quantities that are pinned to a random value for each seed: label, quantity, lower, upper.
      tick_ms: CPU time for the deliberation of each tick; 0: a number of checks, with which a run repeats exactly.
    """

    domain: str
    scenario: str
    profile: str = ""
    zoo: str = ""
    goal: str = ""
    drawn: tuple[tuple[str, str, float, float], ...] = ()
    tick_ms: float = 0.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """Summary of one run; durations in seconds, actions in order of execution.

    Attributes:
      seed: Of the run.
      variant: Name of its settings.
      achieved: Whether the goal was reached.
      duration_s: From the start of the first action to the end of the last one.
      result: "achieved", or the reason of the failure.
      actions: Names of the finished actions.
      outcomes: Of each finished action.
      predicted_s: Of each finished action when it started.
      actual_s: Of each finished action.
      asserted: Whether any subgoal was asserted.
      disturbance_m: Displacement of an object that should have stayed in place; see `TaskSampler.disturbance_m`.
      free: Free variables of the first choice: label, quantity, lower, upper, value.
      bound: Bound variables of the first choice: label, quantity, value.
      predicted_actions: Of the first choice: action, whether it was asserted, predicted seconds.
      costs: Costs besides time.
    """

    seed: int
    variant: str
    achieved: bool
    duration_s: float
    result: str
    actions: tuple[str, ...]
    outcomes: tuple[str, ...]
    predicted_s: tuple[float, ...]
    actual_s: tuple[float, ...]
    asserted: bool
    disturbance_m: float
    free: tuple[tuple[str, str, float, float, float], ...]
    bound: tuple[tuple[str, str, float], ...]
    predicted_actions: tuple[tuple[str, bool, float], ...] = ()
    costs: Costs = NO_COSTS

    @property
    def is_timed(self) -> bool:
        """Whether the goal was reached by acting: where it held at the start, no action has a duration."""
        return self.achieved and math.isfinite(self.duration_s)


def outcome_of(run: Run, domain: Domain, variant: str, seed: int) -> Outcome:
    """Summary of a run."""
    finished = run.finished
    free, bound = _variables(run.subgoals[0], domain) if run.subgoals else ((), ())
    return Outcome(
        seed,
        variant,
        run.achieved,
        run.duration_s,
        run.result,
        tuple(action.action for action in finished),
        tuple(action.outcome for action in finished),
        tuple(round(action.predicted_s, 4) for action in finished),
        tuple(round(action.actual_s, 4) for action in finished),
        any(action.asserted for subgoals in run.subgoals for action in subgoals.actions),
        sampler_of(domain).disturbance_m(finished, run.truth),
        free,
        bound,
        _predicted_actions(run),
        costs_of(run, domain),
    )


def _predicted_actions(run: Run) -> tuple[tuple[str, bool, float], ...]:
    actions = run.subgoals[0].actions if run.subgoals else ()
    return tuple((action.action, action.asserted, round(action.predicted_s, 4)) for action in actions)


def _variables(
    subgoals: Subgoals, domain: Domain
) -> tuple[tuple[tuple[str, str, float, float, float], ...], tuple[tuple[str, str, float], ...]]:
    """Free and bound variables of the first choice, each once."""
    free, bound = {}, {}
    for instance in subgoals.actions:
        quantities = {declared.name: declared.quantity for declared in domain.actions[instance.action].parameters}
        for parameter in instance.parameters:
            quantity = quantities[parameter.name]
            if parameter.bound:
                bound[parameter.id] = (parameter.label, quantity, parameter.value)
            else:
                free[parameter.id] = (parameter.label, quantity, parameter.lower, parameter.upper, parameter.value)
    return tuple(free.values()), tuple(bound.values())
