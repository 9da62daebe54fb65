"""What an evaluation runs and what comes of it: task, variant, outcome."""

from __future__ import annotations

from dataclasses import dataclass, field

from tailor.executive.interfaces.domain import Domain
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.messages import RefinementReport, Subgoals
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.lockstep.run import Run

FIRST_SEED = 1_000_000  # evaluation seeds; models are trained and settings chosen on smaller ones


@dataclass(frozen=True, slots=True)
class Variant:
    """One way to run an episode. `pins` forces choices: (label, quantity, value); `noise` draws other noise."""

    name: str
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    pins: tuple[tuple[str, str, float], ...] = ()
    noise: int = 0


@dataclass(frozen=True, slots=True)
class Task:
    """Which world: domain and scenario, with the profile of its body ("", or "degraded").

    `goal` is a PDDL goal in place of the scenario's; `drawn` are quantities that every seed pins to a value of its
    own: label, quantity, lower, upper.
    """

    domain: str
    scenario: str
    profile: str = ""
    zoo: str = ""
    goal: str = ""
    drawn: tuple[tuple[str, str, float, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of an episode; durations in seconds, actions in order of execution."""

    seed: int
    variant: str
    achieved: bool
    duration_s: float
    result: str
    actions: tuple[str, ...]
    outcomes: tuple[str, ...]
    predicted_s: tuple[float, ...]
    actual_s: tuple[float, ...]
    asserted: bool  # whether any subgoal was asserted
    disturbance_m: float  # how far the ball had moved when the approach ended; 0 without an approach
    free: tuple[tuple[str, str, float, float, float], ...]  # first choice: label, quantity, lower, upper, value
    bound: tuple[tuple[str, str, float], ...]  # the situation then: label, quantity, value
    greedy_cost_s: float = float("nan")  # the objective of the first choice: greedy, and as refined
    refined_cost_s: float = float("nan")
    predicted_actions: tuple[
        tuple[str, bool, float], ...
    ] = ()  # first choice: action, whether asserted, predicted seconds
    situation: tuple[float, ...] = ()  # what a benefit tree sees of the first choice (tailor.executive.refinement.gate)


def outcome_of(episode: Run, domain: Domain, variant: str, seed: int) -> Outcome:
    """Sum an episode up."""
    finished = episode.finished
    free, bound = _situation(episode.subgoals[0], domain) if episode.subgoals else ((), ())
    return Outcome(
        seed,
        variant,
        episode.achieved,
        episode.duration_s,
        episode.result,
        tuple(action.action for action in finished),
        tuple(action.outcome for action in finished),
        tuple(round(action.predicted_s, 4) for action in finished),
        tuple(round(action.actual_s, 4) for action in finished),
        any(action.asserted for subgoals in episode.subgoals for action in subgoals.actions),
        _ball_moved_m(episode),
        free,
        bound,
        *_costs_s(episode),
        _foreseen(episode),
        _compared(episode),
    )


def _foreseen(episode: Run) -> tuple[tuple[str, bool, float], ...]:
    actions = episode.subgoals[0].actions if episode.subgoals else ()
    return tuple((action.action, action.asserted, round(action.predicted_s, 4)) for action in actions)


def _compared(episode: Run) -> tuple[float, ...]:
    """The first finished refinement's comparison of its choice with the greedy one; empty where they are the same."""
    reports = (message for message in episode.messages if isinstance(message, RefinementReport) and message.finished)
    first = next(reports, None)
    return tuple(round(value, 6) for value in first.situation) if first is not None else ()


def _costs_s(episode: Run) -> tuple[float, float]:
    """What the first finished refinement said of the greedy choice and of its own."""
    for message in episode.messages:
        if isinstance(message, RefinementReport) and message.finished:
            return message.greedy_s, message.best_s
    return float("nan"), float("nan")


def _situation(
    subgoals: Subgoals, domain: Domain
) -> tuple[tuple[tuple[str, str, float, float, float], ...], tuple[tuple[str, str, float], ...]]:
    """Free and bound variables of the first choice, each once."""
    free, bound = {}, {}
    for instance in subgoals.actions:
        quantities = {parameter.name: parameter.quantity for parameter in domain.actions[instance.action].parameters}
        for said in instance.parameters:
            quantity = quantities[said.name]
            if said.bound:
                bound[said.id] = (said.label, quantity, said.value)
            else:
                free[said.id] = (said.label, quantity, said.lower, said.upper, said.value)
    return tuple(free.values()), tuple(bound.values())


def _ball_moved_m(episode: Run) -> float:
    """How far the ball was from its start when the first approach ended; it should have been left alone till then."""
    ended_ns = [action.stamp_ns for action in episode.finished if action.action == "approachBall"]
    if not ended_ns or not episode.truth:
        return 0.0
    first, *later = episode.truth
    return max((_apart_m(first, truth) for truth in later if truth.stamp_ns <= ended_ns[0]), default=0.0)


def _apart_m(first: SoccerGroundTruth, second: SoccerGroundTruth) -> float:
    return float(((first.ball_x - second.ball_x) ** 2 + (first.ball_y - second.ball_y) ** 2) ** 0.5)
