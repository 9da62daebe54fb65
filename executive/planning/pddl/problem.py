"""A planning problem: objects, initial state, timed literals, goal, metric."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal as OneOf

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_reader import Scope, read_formula
from tailor.executive.planning.pddl.language import Domain, Formula, Literal, Typed
from tailor.executive.planning.pddl.syntax.s_expressions import read_form, text_of


@dataclass(frozen=True, slots=True)
class TimedLiteral:
    """A fact that becomes true or false at a known time, in seconds after the start."""

    time_s: float
    literal: Literal


@dataclass(frozen=True, slots=True)
class Problem:
    """A planning problem of one domain.

    `objects` excludes the domain's constants; `initial` keeps the order of the text.
    """

    name: str
    domain: Domain
    objects: tuple[Typed, ...]
    initial: tuple[Fact, ...]
    goal: Formula
    goal_text: str
    values: Mapping[Fact, float] = field(default_factory=dict)  # of static functions
    timed: tuple[TimedLiteral, ...] = ()
    metric: OneOf["", "makespan", "cost"] = ""
    changes_apart: bool = False  # no two events may change a fact at the same time, not even alike, as PDDL allows
    # goals with their texts in one line, by the text as given
    _read: dict[str, tuple[Formula, str]] = field(default_factory=dict, compare=False, repr=False)

    @property
    def changing(self) -> frozenset[str]:
        """Predicates that actions or timed literals change; the others are static."""
        by_actions = (effect.atom.predicate for action in self.domain.actions for effect in action.effects)
        return frozenset({*by_actions, *(timed.literal.fact[0] for timed in self.timed)})

    def with_initial(self, facts: Iterable[Fact]) -> Problem:
        """The same problem from another initial state.

        Args:
          facts: All facts that hold, static ones included, in the order that the search uses; duplicates are dropped.

        Returns:
          The problem; goal, values and timed literals are unchanged.
        """
        return replace(self, initial=tuple(dict.fromkeys(facts)))

    def with_goal(self, goal: str) -> Problem:
        """The same problem with another goal. The last text that was read is not read again: 8 kB take 10 ms.

        Args:
          goal: PDDL text, e.g. "(and (final pos3) (atball pos3))".

        Raises:
          PddlError: The text is not a goal over this domain and these objects.
        """
        if goal not in self._read:
            form = read_form(goal, "goal")
            formula = read_formula(form, Scope.of(self.domain, self.objects))
            self._read.clear()
            self._read[goal] = formula, text_of(form)
        formula, text = self._read[goal]
        return replace(self, goal=formula, goal_text=text)
