"""Choices that the optimiser makes with the current models, without running them: plan and refine, then stop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tailor.executive import domains
from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.replay import RecordedTick
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import RefinementReport, Subgoals
from tailor.schemas.parsed_files import read_json
from tailor.simnodes.body import Body
from tailor.simnodes.world import World
from tailor.tools.learning.gathering.choosing_models import UNPROVEN, cached_models
from tailor.tools.lockstep.episode_extraction import arguments_of, data_set_of

DECISION_S = 5.0  # by then the first refinement is finished, or the situation is left out
MIN_PREDICTED_S = 0.3  # a shorter action has no ticks to learn from


@dataclass(frozen=True, slots=True)
class Choice:
    """One action of a refined sequence, and how much the models disagree on it."""

    data_set: str
    action: str
    arguments: tuple[float, ...]
    std_s: float


def read_choices(path: Path, widths: Mapping[tuple[str, str], int]) -> list[Choice]:
    """Choices that `active_episodes` has stored.

    Args:
      path: The file.
      widths: Numbers of arguments, by data set and action.

    Raises:
      UsageError: The file is damaged, or holds a choice of something else.
    """
    expected = "choices of situations (remove it, and --resume refines them again)"
    rows = read_json(path, expected)
    try:
        found = [Choice(str(name), str(action), tuple(map(float, row)), float(std)) for name, action, row, std in rows]
    except (TypeError, ValueError):
        raise UsageError(f"{path}: has another shape, expected {expected}") from None
    for each in found:
        if widths.get((each.data_set, each.action)) != len(each.arguments) or not np.isfinite(each.arguments).all():
            raise UsageError(f"{path}: a choice of {each.action} is not one of its arguments, expected {expected}")
    return found


class _DecidedError(Exception):
    """Ends a run at the end of its first refinement."""


class _FirstDecision:
    """Receives the outputs of each tick until the first refinement is finished."""

    def __init__(self) -> None:
        self.subgoals: Subgoals | None = None

    def __call__(self, tick: RecordedTick, outputs: tuple[Output, ...]) -> None:
        messages = [output.message for output in outputs]
        self.subgoals = next((m for m in messages if isinstance(m, Subgoals)), self.subgoals)
        if self.subgoals is not None and any(isinstance(m, RefinementReport) and m.finished for m in messages):
            raise _DecidedError


def refined_choices(domain_name: str, scenario: str, seed: int, zoo: str, body: Body) -> list[Choice]:
    """The refined choices in one situation; empty if it is not decided in time.

    Args:
      domain_name: Name of the domain.
      scenario: Scenario from which the situation is drawn.
      seed: Of the situation and of all noise.
      zoo: Folder of the models that choose; empty: those that ship.
      body: Simulated body of the domain's robot; reset here.
    """
    from tailor.tools.lockstep.run import SENDER, run_lockstep

    domain = domains.load(domain_name)
    drawn, start = domains.seeded_scenario(domain_name, scenario, seed)
    settings = Settings(seed=seed, refinement=UNPROVEN)
    models, doubts = cached_models(domain.robot, zoo), domains.doubts(domain_name)
    context = make_context(domain, drawn, models, settings, SENDER, doubts=doubts)
    decision = _FirstDecision()
    try:
        run_lockstep(context, World(body, start, seed), limit_s=DECISION_S, on_tick=decision)
    except _DecidedError:
        assert decision.subgoals is not None
        return [
            Choice(
                data_set_of(domain.actions[each.action]),
                each.action,
                tuple(arguments_of(domain.actions[each.action], each).tolist()),
                each.spread_s,
            )
            for each in decision.subgoals.actions
            if each.predicted_s >= MIN_PREDICTED_S
        ]
    return []
