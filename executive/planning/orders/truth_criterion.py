"""The modal truth criterion: whether a literal holds before a step in every order of the other steps.

Source: Chapman, Planning for conjunctive goals, AIJ 32 (1987). Exact for ground steps without conditional effects: a
literal may be false if nothing surely makes it true before, or if some step that may come before undoes it and no step
restores it that surely lies between both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tailor.executive.planning.orders.ground_steps import GroundStep
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.plans.schedule import bits_of
from tailor.executive.planning.semantics.regression import conjunction
from tailor.executive.planning.semantics.state import Objects


@dataclass(slots=True)
class TruthCriterion:
    """The steps with the masks of those before each (`predecessors`), and of those that make each literal true."""

    steps: Sequence[GroundStep]
    before: Sequence[int]
    objects: Objects
    makers: dict[Literal, int] = field(default_factory=dict)

    def fault(self) -> str:
        """The first literal of a condition or the goal that is false in some order; "" if there is none.

        Raises:
          NotClassical: There is a disjunction, a quantifier or a conditional effect.
        """
        for n, step in enumerate(self.steps):
            for made in step.effects(self.objects):
                self.makers[made] = self.makers.get(made, 0) | 1 << n
        every = (1 << len(self.steps)) - 1
        for n, step in enumerate(self.steps):
            after = sum(1 << other for other, mask in enumerate(self.before) if mask >> n & 1)
            possible = every & ~after & ~(1 << n)
            for literal in step.conditions():
                if why := self._why_false(literal, self.before[n], possible):
                    return f"{step} may lack {literal}: {why}"
        for literal in conjunction(self.objects.problem.goal, {}):
            if why := self._why_false(literal, every, every):
                return f"the goal may lack {literal}: {why}"
        return ""

    def _why_false(self, literal: Literal | None, sure: int, possible: int) -> str:
        """Why a literal may be false after the steps `sure` and maybe some of those `possible`; "" if it never is."""
        if literal is None:
            return "it is false of its objects"
        achievers = self.makers.get(literal, 0) & sure
        initially = literal.holds_in(self.objects.initial)
        if not achievers and not initially:
            return "nothing makes it true before"
        for n in bits_of(self.makers.get(Literal(literal.fact, not literal.positive), 0) & possible):
            if not any(self.before[achiever] >> n & 1 for achiever in bits_of(achievers)):
                return f"{self.steps[n]} may undo it"
        return ""
