"""Predicates over each label of a plan, from its causal links (paper 6.1, `parseCausalLinks` of Algorithm 2)."""

from __future__ import annotations

from dataclasses import dataclass, field

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning import Plan

INITIAL = 0  # producer id of the facts of the initial state


@dataclass(frozen=True, slots=True)
class LabelFacts:
    """Predicates over one label: linked from the initial state, and linked from earlier actions."""

    holds: list[Fact] = field(default_factory=list)
    achieved: list[Fact] = field(default_factory=list)


def facts_by_label(plan: Plan) -> dict[str, LabelFacts]:
    """Predicates by label, e.g. pos2 -> [0ball, 2atball]; negative links restrict no value and are ignored."""
    by_label: dict[str, LabelFacts] = {}
    listed: set[tuple[str, bool, Fact]] = set()
    for link in plan.links:
        if not link.literal.positive:
            continue
        fact = link.literal.fact
        for label in dict.fromkeys(fact[1:]):
            entry = by_label.setdefault(label, LabelFacts())
            initial = link.producer == INITIAL
            if (label, initial, fact) not in listed:
                listed.add((label, initial, fact))
                (entry.holds if initial else entry.achieved).append(fact)
    return by_label
