"""Plausible messages of whole runs, made without a simulator: for tests of whoever reads what is on the bus."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.synthetic_models import MODELS, approach_dribble

PLAN = """;approach-dribble
Initial  : (robot pos1) (ball pos2) (final pos3)

Step 2   : (approachball pos1 pos2)
          0   -> (ball pos2)
          0   -> (robot pos1)

Step 1   : (dribbleball pos2 pos3)
          2   -> (atball pos2)

Goal     :
          0   -> (final pos3)
          1   -> (atball pos3)
orderings = { 2<1 }
"""
SUFFIX = """;approach-dribble
Initial  : (atball pos2) (final pos3)

Step 1   : (dribbleball pos2 pos3)
          0   -> (atball pos2)

Goal     :
          0   -> (final pos3)
          1   -> (atball pos3)
orderings = { }
"""
PERIOD_NS = 100_000_000
SPREAD = (("x", 0.03), ("y", 0.03), ("phi", 0.1))
SETTINGS = RefinementSettings(  # gain_k_std: the optimum, however little it gains
    horizon=2, p_fail_max=0.5, gain_k_std=0.0, arrival_spread=SPREAD
)
SENDER = "ab" * 16


@dataclass(frozen=True, slots=True)
class Published:
    """One message of a run: when it came, under which key."""

    time_ns: int
    key: str
    message: m.Message


def soccer_run(seed: int = 3) -> Iterator[Published]:
    """Approach and dribble: refined by the real refinement on analytic models, driven along smooth curves."""
    rng = np.random.default_rng(seed)
    sequence = approach_dribble(robot=(-1.2, -0.6, 2.4))
    refinement = Refinement(sequence, MODELS, SETTINGS, rng)
    refinement.advance(CheckBudget(60))
    choice = refinement.choice
    assert choice is not None
    bound = sequence.bind(choice.values).variables
    poses = [tuple(bound[4 * place + i].value for i in range(4)) for place in range(3)]
    yield Published(0, "exec/provenance", m.Provenance(0, json.dumps(order("soccer", seed))))
    yield Published(0, "agilo/driver", m.DriverState(0, "disarmed", "just started", "", 7, "", 0))
    yield Published(PERIOD_NS, "agilo/driver", m.DriverState(0, "armed", "", "", 7, SENDER, 1))
    yield Published(2 * PERIOD_NS, "exec/plan", m.PlanReport(0, "solved", "searched", PLAN, 14, 9, ""))
    yield Published(2 * PERIOD_NS, "exec/refinement", _report(2, refinement))
    yield Published(2 * PERIOD_NS, "exec/subgoals", subgoals(2, sequence, choice, 0))
    now = 3 * PERIOD_NS
    for index, name in enumerate(("approachBall", "dribbleBall")):
        predicted, actual = choice.predicted_s[index], choice.predicted_s[index] * (1.06 - 0.1 * index)
        if index:
            yield Published(now, "exec/plan", m.PlanReport(now, "solved", "suffix", SUFFIX, 0, 0, ""))
            yield Published(now, "exec/subgoals", subgoals(now // PERIOD_NS, sequence, choice, 1))
        for k in range(int(actual * 10)):
            yield from _tick(
                now, index, name, k / 10, predicted, _between(poses[index], poses[index + 1], actual, k), rng
            )
            now += PERIOD_NS
        tick = now // PERIOD_NS
        ended = m.ActionFinished(now, tick, name, index, "done", "", predicted, int(actual * 10) / 10)
        yield Published(now, "exec/finished", ended)
    yield Published(now, "exec/status", status(now, "READY", "achieved", "", 2, 0.0, 0.0, ()))


def arm_run(seed: int = 1, outcomes: tuple[str, ...] = ("done",) * 4) -> Iterator[Published]:
    """A robot that is no point on a plane: two joints swing between waypoints, nothing is known of its domain.

    Its four actions end with `outcomes`.
    """
    rng = np.random.default_rng(seed)
    yield Published(0, "exec/provenance", m.Provenance(0, json.dumps(order("no-such-domain", seed))))
    for k in range(120):
        now = k * PERIOD_NS
        index, within = divmod(k, 30)
        belief = (float(np.sin(k / 12)), float(np.cos(k / 12)), 0.2, float(rng.normal(0, 0.01)))
        yield Published(now, "exec/status", status(now, "EXECUTING", "", "reach", index, within / 10, 2.9, belief))
        yield Published(now, "exec/tick", tick_report(now, rng))
        if within == 29:
            end = m.ActionFinished(now, k, "reach", index, outcomes[index], "", 2.9, 3.0)
            yield Published(now, "exec/finished", end)


def order(domain: str, seed: int) -> dict[str, object]:
    """A provenance as the executive writes it, as far as it matters here."""
    settings = {"seed": seed, "refinement": {"horizon": 2}}
    return {"config": {"domain": domain, "scenario": "approach-dribble", "settings": settings, "zoo": ""}}


def subgoals(tick: int, sequence, choice, done: int) -> m.Subgoals:
    """The message about a choice, from the action number `done` on."""
    actions = []
    for i, action in enumerate(sequence.actions):
        names = [parameter.name for parameter in action.action.parameters]
        parameters = tuple(
            _parameter(n, sequence.variables[v], choice) for n, v in zip(names, action.variables, strict=True)
        )
        predicted, std = choice.predicted_s[i], choice.std_s[i]
        if i == done:  # where the robot is, everything is known
            parameters = tuple(replace(p, bound=p.bound or not p.name.endswith("g")) for p in parameters)
        actions.append(
            m.InstantiatedAction(action.action.name, len(sequence.actions) - i, False, predicted, std, parameters)
        )
    return m.Subgoals(tick * PERIOD_NS, tick, 2, tuple(actions[done:]))


def status(
    now: int, mode: str, result: str, action: str, index: int, elapsed: float, predicted: float, belief
) -> m.ExecStatus:
    """An executive's status."""
    return m.ExecStatus(
        now,
        now // PERIOD_NS,
        mode,
        "",
        "approach-dribble",
        "(atball pos3)",
        result,
        action,
        index,
        elapsed,
        predicted,
        tuple(belief),
        SENDER,
    )


def tick_report(now: int, rng: np.random.Generator) -> m.TickReport:
    """A tick: quick in general, with a long one now and then."""
    work = int(rng.gamma(2.0, 4e6)) + (50_000_000 if rng.random() < 0.05 else 0)
    return m.TickReport(
        now, now // PERIOD_NS, now, int(rng.gamma(2, 6e4)), 400_000, work, 0, work // 200_000, "", False
    )


def _tick(now, index, name, elapsed, predicted, pose, rng) -> Iterator[Published]:
    x, y, phi, v = pose
    carried = (x + 0.3 * np.cos(phi), y + 0.3 * np.sin(phi)) if index else (1.0, 0.0)
    near = rng.normal(0, 0.02, 3)
    belief = (x + near[0], y + near[1], phi + near[2], v, 0.0, *carried)
    yield Published(now, "agilo/odom", m.Odometry(now, x, y, phi, v, 0.0))
    yield Published(now, "agilo/sim/truth", SoccerGroundTruth(now, x, y, phi, v, 0.0, *map(float, carried), 0.0, 0.0))
    yield Published(now, "agilo/cmd_vel", m.VelocityCommand(now, v, 0.1))
    yield Published(
        now, "exec/status", status(now, "EXECUTING", "", name, index, elapsed, predicted, map(float, belief))
    )
    yield Published(now, "exec/tick", tick_report(now, rng))


def _between(start, goal, seconds: float, k: int) -> tuple[float, float, float, float]:
    """A cubic Hermite curve from pose to pose, eased at the ends that are at rest."""
    t = np.array([k / (10 * seconds), (k + 0.5) / (10 * seconds)])
    s = t * t * (3 - 2 * t)
    reach = 1.6 * np.hypot(goal[0] - start[0], goal[1] - start[1])
    h = np.array([2 * s**3 - 3 * s**2 + 1, s**3 - 2 * s**2 + s, -2 * s**3 + 3 * s**2, s**3 - s**2])
    ways = np.array(
        [
            start[:2],
            (reach * np.cos(start[2]), reach * np.sin(start[2])),
            goal[:2],
            (reach * np.cos(goal[2]), reach * np.sin(goal[2])),
        ]
    )
    (x, y), after = h[:, 0] @ ways, h[:, 1] @ ways
    dx, dy = after[0] - x, after[1] - y
    return float(x), float(y), float(np.arctan2(dy, dx)), float(np.hypot(dx, dy) / 0.05)


def _parameter(name, variable, choice) -> m.Parameter:
    value = variable.value if variable.value is not None else choice.values[variable.id]
    bound = variable.value is not None
    label = f"pos{int(variable.label[3:]) + 1}"  # the plan's names begin with pos1
    return m.Parameter(name, variable.id, label, variable.unit, bound, variable.lower, variable.upper, value)


def _report(tick: int, refinement: Refinement) -> m.RefinementReport:
    report = refinement.report()
    return m.RefinementReport(
        tick * PERIOD_NS,
        tick,
        2,
        report.solver,
        refinement.finished,
        report.evaluations,
        report.checks,
        report.greedy_s,
        report.best_s,
        tuple(e for e, _ in report.trace),
        tuple(s for _, s in report.trace),
    )
