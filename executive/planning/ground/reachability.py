"""Relaxed reachability over typed objects and static facts, without enumerating all bindings of an action.

Semi-naive: each fact that is reached joins with those reached before it, so every binding is met when the last of its
facts arrives. Delete effects are ignored. Source: Helmert, Artificial Intelligence 173 (2009), section 6.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import INSTANCE_STEPS, GroundingLimit, StaticWorld
from tailor.executive.planning.ground.join_plans import FactIndex, JoinPlan, JoinStep, join_plan
from tailor.executive.planning.ground.rules import Rule, rules_of
from tailor.executive.planning.pddl.language import Atom

Arguments = tuple[str, ...]
JOINS_PER_STEP = 3  # candidates of a join per step of the limit: a formula takes about three times as long
STEPS_PER_PLAN = 12  # a plan of a join takes as long as so many formulas,
STEPS_PER_JOIN = 2  # and each of its joins as long as so many more
HEADS_PER_STEP = 2  # facts that an action adds, likewise
CHECK_EVERY = 256  # candidates of a join per unit of budget: about a tenth of a millisecond


@dataclass(frozen=True, slots=True)
class Reached:
    """The arguments of the reachable actions by name, in grounding order, and all reached fluent facts."""

    arguments: dict[str, list[Arguments]]
    facts: frozenset[Fact]


class Reachability:
    """The fixpoint of one world and initial state."""

    def __init__(self, world: StaticWorld, initial: Iterable[Fact], limit: GroundingLimit) -> None:
        """Does no work yet; `initial` are the fluent facts that hold at first or at a known time."""
        self._world = world
        self._limit = limit
        self._joins = 0
        self._index = FactIndex(world)
        self._arguments: dict[str, dict[Arguments, None]] = {action.name: {} for action in world.domain.actions}
        self._known = dict.fromkeys(initial)
        self._pending = deque(self._known)
        self._static_rules: list[tuple[Rule, JoinPlan]] = []
        self._triggers: dict[str, list[tuple[Rule, JoinPlan]]] = {}

    def _add(self, rule: Rule) -> None:
        fluent = [atom for atom in rule.body if atom.predicate not in self._world.static]
        if not fluent:
            self._static_rules.append((rule, self._plan(rule, None)))
        for atom in fluent:
            self._triggers.setdefault(atom.predicate, []).append((rule, self._plan(rule, atom)))

    def _plan(self, rule: Rule, trigger: Atom | None) -> JoinPlan:
        self._limit.subject, before = f"'{rule.action}'", self._index.entered
        plan = join_plan(rule, trigger, self._index, self._world)
        entered = self._index.entered - before
        self._limit.spend(STEPS_PER_PLAN + STEPS_PER_JOIN * len(plan.steps) + entered // JOINS_PER_STEP)
        return plan

    def run(self) -> Iterator[Reached | None]:
        """Yields None after every rule and fact, and every CHECK_EVERY candidates, and the result at the end.

        Raises:
          TooMuchToGround: The limit is reached.
        """
        for rule in (rule for action in self._world.domain.actions for rule in rules_of(action, self._world)):
            self._add(rule)
            yield None
        self._index.insert_all(self._world.facts)
        for rule, plan in self._static_rules:
            yield from self._fire(rule, plan, ())
        while self._pending:
            fact = self._pending.popleft()
            self._index.insert(fact)
            for rule, plan in self._triggers.get(fact[0], ()):
                yield from self._fire(rule, plan, fact)
            yield None
        self._limit.depth = 0
        yield self._result()

    def _fire(self, rule: Rule, plan: JoinPlan, fact: Fact) -> Iterator[None]:
        """Enters all bindings of a rule that use a fact."""
        self._limit.subject = f"'{rule.action}'"
        binding: list[str] = [""] * len(rule.variables)
        if not plan.trigger.bind(fact, binding):
            return
        arguments = self._arguments[rule.action]
        self._limit.depth = int(rule.is_quantified)
        for found in self._joined(plan.steps, binding):
            if found is None:
                yield None
                continue
            if rule.is_action:
                if found in arguments:
                    continue
                arguments[found] = None  # counted here: what is too much to make is not even reached
                self._limit.spend(INSTANCE_STEPS + len(plan.heads) // HEADS_PER_STEP)
            for head in plan.heads:
                reached = head(found)
                if reached not in self._known:
                    self._known[reached] = None
                    self._pending.append(reached)

    def _joined(self, steps: Sequence[JoinStep], binding: list[str]) -> Iterator[Arguments | None]:
        """All extensions of a binding by the facts of the steps; None every CHECK_EVERY candidates."""
        if not steps:
            yield tuple(binding)
            return
        levels = [iter(steps[0].candidates(binding))]  # a stack, not a recursion: each binding passes one generator
        while levels:
            step = steps[len(levels) - 1]
            for fact in levels[-1]:
                self._joins += 1
                if self._joins % JOINS_PER_STEP == 0:
                    self._limit.spend()
                if self._joins % CHECK_EVERY == 0:
                    yield None
                if not step.bind(fact, binding):
                    continue
                if len(levels) < len(steps):
                    levels.append(iter(steps[len(levels)].candidates(binding)))
                    break
                yield tuple(binding)
            else:
                levels.pop()

    def _result(self) -> Reached:
        rank = {name: n for n, name in enumerate(self._world.objects["object"])}
        ordered = {
            action: sorted(own, key=lambda arguments: [rank[name] for name in arguments])
            for action, own in self._arguments.items()
        }
        return Reached(ordered, frozenset(self._known))
