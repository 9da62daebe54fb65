"""Explanations as text, for `tailor why`."""

from __future__ import annotations

import math

from rich.table import Table

from tailor.models.rules.rule_text import UNITLESS
from tailor.schemas.messages import RefinementReport
from tailor.tools.cli.plain_text import plain
from tailor.tools.viewer.decisions.decision_reader import Decision
from tailor.tools.viewer.explanations.avoided_failure import AvoidedFailure
from tailor.tools.viewer.explanations.explanation import Explanation, FreeParameter
from tailor.tools.viewer.explanations.situation import Situation

SHOWN_S = 0.005  # smaller differences print as nothing
GOOD_RATIO = 1.02  # values within 2 % of the best are equally good at the accuracy of the models


def duration_table(explanation: Explanation) -> Table:
    """Predicted durations and objective of the chosen and the greedy values."""
    table = Table("predicted", "chosen", "greedy", "difference", box=None, pad_edge=True)
    for column in table.columns[1:]:
        column.justify = "right"
    for name, chosen, greedy in zip(explanation.actions, explanation.chosen_s, explanation.greedy_s, strict=True):
        table.add_row(plain(name), *_compared(chosen, greedy))
    table.add_row("sum", *_compared(sum(explanation.chosen_s), sum(explanation.greedy_s)), style="bold")
    if explanation.chosen_j:
        chosen_j, greedy_j = sum(explanation.chosen_j), sum(explanation.greedy_j)
        table.add_row("energy", f"{chosen_j:.2f} J", f"{greedy_j:.2f} J", f"{chosen_j - greedy_j:+.2f} J")
    table.add_row("objective", *_compared(explanation.chosen_cost, explanation.greedy_cost))
    return table


def explanation_lines(explanation: Explanation, best_cost: float, decision: Decision, not_certified: str) -> list[str]:
    """Lines below the table of durations; `best_cost`: of a long search; `not_certified`: why there is no bound."""
    lines = [] if explanation.avoided is None else [avoided_text(explanation.avoided)]
    lines += [parameter_text(parameter) for parameter in explanation.parameters]
    for situation in explanation.situations:
        lines += [features_text(situation), *([f"  {situation.rule}"] if situation.rule else [])]
    long_search = long_search_text(explanation.chosen_cost, best_cost)
    certified = certificate_text(certified_gap_pct(decision.search.report, explanation.chosen_cost), not_certified)
    return [*lines, long_search, certified, search_text(decision, explanation.chosen_cost)]


def avoided_text(avoided: AvoidedFailure) -> str:
    """Why a subgoal was asserted."""
    straight, by_subgoal = f"{100 * avoided.straight:.0f} %", f"{100 * avoided.by_subgoal:.0f} %"
    return (
        f"subgoal asserted: straight to its goal {plain(avoided.action)} is predicted to fail with {straight}, "
        f"by way of the subgoal with {by_subgoal}"
    )


def parameter_text(free: FreeParameter) -> str:
    """One free parameter: chosen value, greedy value, range, and share of equally good values."""
    variable, cost = free.variable, free.alternatives.total_s
    best = cost.min()
    text = f"{variable.quantity} at {variable.label}: {_value(free.chosen, variable.unit)}"
    text += f", greedy {_value(free.greedy, variable.unit)}"
    text += f", free in {_value(variable.lower, variable.unit)} to {_value(variable.upper, variable.unit)}"
    if not math.isfinite(best):
        return f"{text}; every other sampled value is predicted to fail"
    share = f"{100 * (cost <= best * GOOD_RATIO).mean():.0f} % of the range is within 2 % of the best"
    worst = cost[cost < math.inf].max()
    return f"{text}; {share}, the worst valid value costs {worst - best:+.2f} s"


def long_search_text(chosen_cost: float, best_cost: float) -> str:
    """Gap between the choice and the result of a long search."""
    if not math.isfinite(best_cost):
        return "a long search finds no valid choice either"
    gap_s = chosen_cost - best_cost
    if gap_s < SHOWN_S:
        return "a long search finds no better choice"
    return f"a long search finds a choice that is {gap_s:.2f} s ({100 * gap_s / best_cost:.1f} %) better"


def features_text(situation: Situation) -> str:
    """Features of an action model for the chosen and the greedy values."""
    columns = zip(situation.features, situation.chosen, situation.greedy, strict=True)
    values = [f"{q.name} {_value(a, q.unit)} ({_value(b, q.unit)})" for q, a, b in columns]
    return f"{situation.action} features (greedy): {', '.join(values)}"


def certified_gap_pct(report: RefinementReport | None, chosen_cost: float) -> float | None:
    """Certified gap between a choice and the optimum of the models, in percent; None without a certificate.

    The certificate is that of the best choice of the search, which is not executed if it came late and gains little.
    """
    if report is None or report.gap_pct < 0 or not 0 < report.best_s < math.inf or not math.isfinite(chosen_cost):
        return None
    gap_pct = 100 * (chosen_cost / report.best_s * (1 + report.gap_pct / 100) - 1)
    return max(0.0, gap_pct) if math.isfinite(gap_pct) else None  # a damaged message has anything


def certificate_text(gap_pct: float | None, not_certified: str) -> str:
    """Certified gap between the refined choice and the optimum of the models, or why there is none."""
    if gap_pct is None:
        return f"not certified: {not_certified}"
    return f"certified: within {gap_pct:.1f} % of the models' optimum"


def search_text(decision: Decision, chosen_cost: float) -> str:
    """Effort of the search, and outcome of the action."""
    parts = []
    search, report = decision.search, decision.search.report
    if report is not None:
        state = "finished" if report.finished else "interrupted"
        parts.append(
            f"searched by {report.solver}: {_counted(report.evaluations, 'evaluation')} in "
            f"{_counted(report.checks, 'check')}, {1000 * search.deliberation_s:.0f} ms of deliberation in "
            f"{_counted(search.ticks, 'tick')}, {state}; "
            f"objective {_reported(report.greedy_s)} (greedy) to {_reported(report.best_s)}"
        )
        if report.best_s >= 0 and math.isfinite(chosen_cost) and chosen_cost - report.best_s >= SHOWN_S:
            parts[-1] += ", found after the action had begun and not adopted"
    if decision.finished is not None:
        end = decision.finished
        parts.append(f"{end.action} {end.outcome} after {end.actual_s:.1f} s, predicted {end.predicted_s:.1f} s")
        if end.outcome == "done" and end.detail:
            parts.append(end.detail)
    return "; ".join(parts) or "no report of the search"


def _compared(chosen: float, greedy: float) -> tuple[str, str, str]:
    both = math.isfinite(chosen) and math.isfinite(greedy)
    return _seconds(chosen), _seconds(greedy), f"{chosen - greedy:+.2f} s" if both else ""


def _seconds(value: float) -> str:
    return f"{value:.2f} s" if math.isfinite(value) else "INVALID"


def _reported(cost: float) -> str:
    """A cost from a message, in which a negative number is INVALID."""
    return _seconds(cost if cost >= 0 else math.inf)


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _value(value: float, unit: str) -> str:
    if unit == "rad":
        return f"{math.degrees(value):z.0f}°"
    return f"{value:z.2f}" if unit in UNITLESS else f"{value:z.2f} {unit}"
