"""Grounding: action schemas x objects -> ground actions.

Small problems are grounded exhaustively, pruned early by static facts and inequalities: the actions then serve every
initial state. Of large ones only the actions that relaxed reachability finds from the initial state are made.
Owns the order that every count depends on: actions by name, objects by name (constants first), parameters from left
to right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.bindings import least_bindings, schema_bindings, without_static
from tailor.executive.planning.ground.durations import TimeGrid, numeric_steps, time_grid
from tailor.executive.planning.ground.goal_grounding import Portions
from tailor.executive.planning.ground.ground_action import GroundAction
from tailor.executive.planning.ground.ground_formula import (
    INSTANCE_STEPS,
    Binding,
    FactTable,
    GroundingLimit,
    StaticWorld,
    TooMuchToGround,
)
from tailor.executive.planning.ground.instances import instance
from tailor.executive.planning.pddl.language import Action, Domain, Typed
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.structures.random_source import RandomSource

if TYPE_CHECKING:
    from tailor.executive.planning.ground.reachability import Reached

MAX_BINDINGS = 4096  # tried exhaustively: 10 ms; the executive's domains try some hundreds
MAX_EXHAUSTIVE_STEPS = 60_000  # a third of a second
MAX_BYTES = 250_000_000  # of the ground actions; half of what a planner may take
BYTES_PER_ACTION, BYTES_PER_PART = 600, 150  # roughly; a part is a condition or an effect
MAX_UNCHECKED = 4096  # steps of grounding, or a little more, between two units: tens of milliseconds
CHECK_EVERY = 64  # bindings tried per unit of budget: about a tenth of a millisecond


@dataclass(frozen=True, slots=True)
class GroundActions:
    """The ground actions of a static world and the facts they mention, by number; reusable with an equal world.

    Durations are in units of `grid`. `reached` are the fluent facts from which the actions were found; None: they
    serve every initial state.
    """

    world: StaticWorld
    tolerance_s: float
    grid: TimeGrid
    facts: tuple[tuple[str, ...], ...]
    actions: tuple[GroundAction, ...]
    reached: frozenset[Fact] | None = None

    def serves(self, problem: Problem, world: StaticWorld, tolerance_s: float) -> bool:
        """Whether these are ground actions of a problem, given its static world."""
        if self.tolerance_s != tolerance_s or self.world != world:
            return False
        if not self.grid.fits(timed.time_s for timed in problem.timed):
            return False
        return self.reached is None or self.reached.issuperset(_fluents(problem, world))


def static_world(problem: Problem) -> StaticWorld:
    """The part of a problem that no action changes."""
    domain = problem.domain
    static = frozenset(domain.predicates.keys() - problem.changing)
    ordered = sorted(domain.constants, key=lambda t: t.name) + sorted(problem.objects, key=lambda t: t.name)
    facts = frozenset(fact for fact in problem.initial if fact[0] in static)
    return StaticWorld(domain, _by_type(domain, ordered), static, facts, dict(problem.values), domain.durative)


def _by_type(domain: Domain, ordered: Sequence[Typed]) -> dict[str, tuple[str, ...]]:
    """The names of each type's objects, in their order; thousands of objects may be of hundreds of types."""
    alike: dict[tuple[str, ...], list[int]] = {}  # places of the objects that are declared alike
    for place, item in enumerate(ordered):
        alike.setdefault(item.types, []).append(place)
    declared: dict[str, list[tuple[str, ...]]] = {kind: [] for kind in domain.types}
    for types in alike:
        for kind in frozenset[str]().union(*(domain.ancestors[own] for own in types)):
            declared[kind].append(types)
    names: dict[tuple[tuple[str, ...], ...], tuple[str, ...]] = {}
    by_type = {}
    for kind, own in declared.items():
        key = tuple(own)
        if key not in names:
            places = sorted(place for types in own for place in alike[types])
            names[key] = tuple(ordered[place].name for place in places)
        by_type[kind] = names[key]
    return by_type


def ground_actions(
    problem: Problem, world: StaticWorld, tolerance_s: float, steps: int
) -> Iterator[GroundActions | None]:
    """Grounds all actions, or the reachable ones: yields None per unit of budget, and the ground actions at the end.

    Args:
      problem: Its initial state is used only if there are too many bindings to try all.
      world: Its static world.
      tolerance_s: Least time between dependent events in seconds.
      steps: Limit of the steps of grounding.

    Raises:
      TooMuchToGround: Too many steps, or too much memory.
    """
    small, most = GroundingLimit(min(steps, MAX_EXHAUSTIVE_STEPS)), min(steps, MAX_BINDINGS)
    try:
        if sum(least_bindings(schema, world) for schema in world.domain.actions) > most:
            raise _TooManyBindings
        yield from _exhaustive(problem, world, tolerance_s, small, most)
        return
    except _TooManyBindings:
        limit = GroundingLimit(steps)
    except TooMuchToGround:  # by formulas: no second chance for quantifiers that are a bomb
        limit = GroundingLimit(steps, small.quantified_left)
    from tailor.executive.planning.ground.reachability import Reachability  # small problems start without it

    for reached in Reachability(world, _fluents(problem, world), limit).run():
        if reached is None:
            yield None
        else:
            yield from _reachable(problem, world, tolerance_s, reached, limit)


def shuffled(grounded: GroundActions, rng: RandomSource) -> GroundActions:
    """The same ground actions with their conditions, hence the open conditions, in random order."""
    mixed = (
        tuple(action.conditions[n] for n in rng.generator.permutation(len(action.conditions)))
        for action in grounded.actions
    )
    actions = (replace(action, conditions=own) for action, own in zip(grounded.actions, mixed, strict=True))
    return replace(grounded, actions=tuple(actions))


def _fluents(problem: Problem, world: StaticWorld) -> Iterator[Fact]:
    """The fluent facts that hold initially or from a known time."""
    yield from (fact for fact in problem.initial if fact[0] not in world.static)
    yield from (timed.literal.fact for timed in problem.timed if timed.literal.positive)


# --- both ways -----------------------------------------------------------------------------------
class _TooManyBindings(Exception):
    """There are too many bindings to try all."""


def _exhaustive(
    problem: Problem, world: StaticWorld, tolerance_s: float, limit: GroundingLimit, most: int
) -> Iterator[GroundActions | None]:
    """Yields None every CHECK_EVERY bindings; raises _TooManyBindings if there are more than `most`."""
    maker = _Maker(world, limit)
    tried = before = 0
    for schema in sorted(world.domain.actions, key=lambda action: action.name):
        limit.subject = f"'{schema.name}'"
        for binding in schema_bindings(schema, world):
            tried += 1
            if tried > most:
                raise _TooManyBindings
            if tried % CHECK_EVERY == 0:
                before = limit.used
                yield None
            if binding is not None:
                limit.spend(INSTANCE_STEPS)
                yield from maker.add(schema, binding)
                if limit.used - before > MAX_UNCHECKED:
                    before = limit.used
                    yield None
    yield maker.result(problem, tolerance_s, None)


def _reachable(
    problem: Problem, world: StaticWorld, tolerance_s: float, reached: Reached, limit: GroundingLimit
) -> Iterator[GroundActions | None]:
    """Makes the actions of the reached bindings, which counted them; yields None every CHECK_EVERY of them."""
    maker = _Maker(world, limit)
    for schema in sorted(world.domain.actions, key=lambda action: action.name):
        names = [parameter.name for parameter in schema.parameters]
        tested = without_static(schema, world)
        own = reached.arguments[schema.name]
        limit.subject = f"'{schema.name}' with {len(own)} reachable bindings"
        before = limit.used
        for number, arguments in enumerate(own, 1):
            if number % CHECK_EVERY == 0 or limit.used - before > MAX_UNCHECKED:
                before = limit.used
                yield None
            yield from maker.add(tested, dict(zip(names, arguments, strict=True)))
    yield maker.result(problem, tolerance_s, reached.facts)


class _Maker:
    """Makes ground actions in order, within a limit of formulas and of memory."""

    def __init__(self, world: StaticWorld, limit: GroundingLimit) -> None:
        self._world = world
        self._facts = FactTable((), limit)
        self._limit = limit
        self._portions = Portions(world, self._facts)
        self._actions: list[GroundAction] = []
        self._bytes = 0

    def add(self, schema: Action, binding: Binding) -> Iterator[None]:
        """Makes one more action unless it is never applicable or achieves nothing; yields after each portion."""
        self._limit.spend(numeric_steps(schema))
        action = yield from instance(len(self._actions), schema, binding, self._portions)
        if action is None:
            return
        self._actions.append(action)
        self._bytes += BYTES_PER_ACTION + BYTES_PER_PART * (len(action.conditions) + len(action.effects))
        if self._bytes > MAX_BYTES:
            raise TooMuchToGround(
                f"{len(self._actions)} ground actions take too much memory, the last of '{schema.name}'"
            )

    def result(self, problem: Problem, tolerance_s: float, reached: frozenset[Fact] | None) -> GroundActions:
        """The actions made, with their durations in units of a time grid."""
        ranges = {(action.shortest, action.longest) for action in self._actions}
        grid = time_grid(tolerance_s, ranges, [timed.time_s for timed in problem.timed])
        durations = {bounds: grid.duration(bounds) or (0, 0) for bounds in ranges}
        actions = self._actions
        if self._world.temporal:
            actions = [_lasting(action, *durations[action.shortest, action.longest]) for action in actions]
        return GroundActions(self._world, tolerance_s, grid, tuple(self._facts), tuple(actions), reached)


def _lasting(action: GroundAction, shortest: int, longest: int | None) -> GroundAction:
    """The action with a duration in units; an instantaneous one keeps its 0."""
    return replace(action, shortest=shortest, longest=longest)
