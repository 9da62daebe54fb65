"""Explanations in words: what `tailor why` prints."""

from __future__ import annotations

import math

from rich.table import Table

from tailor.schemas.messages import RefinementReport
from tailor.tools.viewer.decisions import Decision
from tailor.tools.viewer.explanations.explanation import Explanation, FreeParameter
from tailor.tools.viewer.explanations.situation import Situation

NEAR = 1.02  # values within 2 % of the best are as good, given what the models know


def durations(said: Explanation) -> Table:
    """Predicted durations, chosen against greedy, and the objective."""
    table = Table("predicted", "chosen", "greedy", "difference", box=None, pad_edge=True)
    for column in table.columns[1:]:
        column.justify = "right"
    for name, chosen, greedy in zip(said.actions, said.chosen_s, said.greedy_s, strict=True):
        table.add_row(name, *_compared(chosen, greedy))
    table.add_row("sum", *_compared(sum(said.chosen_s), sum(said.greedy_s)), style="bold")
    if said.chosen_j:
        chosen_j, greedy_j = sum(said.chosen_j), sum(said.greedy_j)
        table.add_row("energy", f"{chosen_j:.2f} J", f"{greedy_j:.2f} J", f"{chosen_j - greedy_j:+.2f} J")
    table.add_row("objective", *_compared(said.chosen_cost, said.greedy_cost))
    return table


def in_words(of: FreeParameter) -> str:
    """One free parameter: chosen, greedy's, its range, the best value, and what is about as good."""
    variable, cost = of.variable, of.alternatives.total_s
    best = cost.min()
    said = f"{variable.quantity} at {variable.label}: {_value(of.chosen, variable.unit)}"
    said += f", greedy {_value(of.greedy, variable.unit)}"
    said += f", free in {_value(variable.lower, variable.unit)} to {_value(variable.upper, variable.unit)}"
    if not math.isfinite(best):
        return f"{said}; every other value that was tried is predicted to fail"
    share = f"{100 * (cost <= best * NEAR).mean():.0f} % of the range is within 2 % of the best"
    worst = cost[cost < math.inf].max()
    return f"{said}; {share}, the worst valid value costs {worst - best:+.2f} s"


def nearness(chosen_cost: float, best_cost: float) -> str:
    """How near the choice is to the best that a long search knows of."""
    if not math.isfinite(best_cost):
        return "a long search finds nothing valid either"
    missed = chosen_cost - best_cost
    if missed < 0.005:
        return "a long search finds nothing better"
    return f"a long search finds {missed:.2f} s ({100 * missed / best_cost:.1f} %) better"


def seen(situation: Situation) -> str:
    """What the model of an action sees, chosen and greedy."""
    columns = zip(situation.features, situation.chosen, situation.greedy, strict=True)
    said = [f"{q.name} {_value(a, q.unit)} ({_value(b, q.unit)})" for q, a, b in columns]
    return f"{situation.action} sees (greedy): {', '.join(said)}"


def advice(report: RefinementReport) -> str:
    """Decision of the refinement gate (paper 6.3.2); empty if it made none."""
    if report.p_slowdown < 0:
        return ""
    said = "greedy kept" if report.kept_greedy else "refined"
    return f"{said}: the refinement gate predicts a slowdown with probability {100 * report.p_slowdown:.0f} %"


def proven(report: RefinementReport | None) -> str:
    """How near the refined choice is to the optimum of the models, where that was proven live."""
    if report is None or report.gap_pct < 0:
        return "not certified: nothing was proven of the models' optimum"
    return f"certified: within {report.gap_pct:.1f} % of the models' optimum"


def effort(decision: Decision) -> str:
    """What the search took, and what came of it."""
    said = []
    report = decision.report
    if report is not None:
        state = "finished" if report.finished else "cut short"
        said.append(
            f"searched by {report.solver}: {report.evaluations} evaluations in {report.checks} checks, "
            f"{1000 * decision.work_s:.0f} ms of thinking in {decision.ticks} ticks, {state}; "
            f"objective {report.greedy_s:.2f} s (greedy) to {report.best_s:.2f} s"
        )
    if decision.finished is not None:
        end = decision.finished
        said.append(f"{end.action} {end.outcome} after {end.actual_s:.1f} s, predicted {end.predicted_s:.1f} s")
    return "; ".join(said) or "nothing is known of the search"


def _compared(chosen: float, greedy: float) -> tuple[str, str, str]:
    both = math.isfinite(chosen) and math.isfinite(greedy)
    return _seconds(chosen), _seconds(greedy), f"{chosen - greedy:+.2f} s" if both else ""


def _seconds(value: float) -> str:
    return f"{value:.2f} s" if math.isfinite(value) else "INVALID"


def _value(value: float, unit: str) -> str:
    return f"{math.degrees(value):.0f}°" if unit == "rad" else f"{value:.2f} {unit}".strip()
