"""Plans of joins: in which order the atoms of a rule's body are matched, and by which of their arguments looked up."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from operator import itemgetter

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.bindings import terms_of
from tailor.executive.planning.ground.ground_formula import StaticWorld
from tailor.executive.planning.ground.rules import Rule
from tailor.executive.planning.pddl.language import Atom, Equal, Formula, Not, Typed

Slot = int | str  # number of a variable, or an object
Table = dict[tuple[str, ...], list[Fact]]
Test = Callable[[Sequence[str]], bool]
Key = Callable[[Sequence[str]], tuple[str, ...]]


class FactIndex:
    """Facts by predicate and by the arguments at some positions; only the tables that a plan uses are kept.

    `entered` counts the objects in the sets of types, and of those that static facts about one object narrow down.
    """

    def __init__(self, world: StaticWorld) -> None:
        self._tables: dict[str, dict[tuple[int, ...], Table]] = {name: {} for name in world.domain.predicates}
        self._objects: dict[tuple[str, ...], tuple[Table, frozenset[str]]] = {}
        self._narrowed: dict[tuple[tuple[str, ...], frozenset[str]], frozenset[str]] = {}
        self.entered = 0
        self._world = world

    def table(self, predicate: str, positions: tuple[int, ...]) -> Table:
        """The table of a predicate's facts by their items at `positions` (from 1); it grows as facts are inserted."""
        return self._tables[predicate].setdefault(positions, {})

    def objects(self, variable: Typed) -> tuple[Table, frozenset[str]]:
        """The objects of a variable's types, as a table of facts with one argument and as a set."""
        objects = self._objects.get(variable.types)
        if objects is None:
            names = self._world.choices(variable)
            objects = self._objects[variable.types] = ({(): [("", name) for name in names]}, frozenset(names))
            self.entered += len(names)
        return objects

    def narrowed(self, variable: Typed, predicates: frozenset[str]) -> frozenset[str]:
        """The objects of a variable's types of which static facts of all these predicates hold."""
        names = self.objects(variable)[1]
        if not predicates:
            return names
        key = (variable.types, predicates)
        if key not in self._narrowed:
            facts = self._world.facts
            self._narrowed[key] = frozenset(n for n in names if all((each, n) in facts for each in predicates))
            self.entered += len(names)
        return self._narrowed[key]

    def insert(self, fact: Fact) -> None:
        """Enters a fact in all tables of its predicate."""
        for positions, table in self._tables[fact[0]].items():
            table.setdefault(tuple([fact[n] for n in positions]), []).append(fact)

    def insert_all(self, facts: Iterable[Fact]) -> None:
        """Enters facts in lexical order."""
        for fact in sorted(facts):
            self.insert(fact)


@dataclass(frozen=True, slots=True)
class JoinStep:
    """Looks facts up by what is bound (`key`), and binds the variables of their other arguments."""

    table: Table
    key: Key
    fresh: tuple[tuple[int, int, frozenset[str]], ...]  # position in the fact, variable, objects of its types
    checks: tuple[tuple[int, Slot], ...]  # position, and what it must equal
    tests: tuple[Test, ...]  # of which the last variable is bound here

    def candidates(self, binding: Sequence[str]) -> Sequence[Fact]:
        """The facts that agree with what is bound."""
        return self.table.get(self.key(binding), ())

    def bind(self, fact: Fact, binding: list[str]) -> bool:
        """Writes the fact's arguments into the binding; False if a type, another variable or a test excludes them."""
        for position, variable, allowed in self.fresh:
            name = fact[position]
            if name not in allowed:
                return False
            binding[variable] = name
        for position, other in self.checks:
            if fact[position] != (binding[other] if isinstance(other, int) else other):
                return False
        return not self.tests or all(test(binding) for test in self.tests)


@dataclass(frozen=True, slots=True)
class JoinPlan:
    """The steps of one rule, after the fact that triggers it."""

    trigger: JoinStep
    steps: tuple[JoinStep, ...]
    heads: tuple[Key, ...]  # the facts that it adds, of a complete binding


class _Planner:
    """Builds one plan in a world; `bound` are the variables bound so far, `left` the atoms not yet matched."""

    def __init__(self, rule: Rule, index: FactIndex, world: StaticWorld) -> None:
        self._index = index
        self.world = world
        self._slots = {variable.name: n for n, variable in enumerate(rule.variables)}
        self._variables = rule.variables
        self._tests = list(rule.tests)
        self._atoms = {atom: self._measures(atom) for atom in rule.body}
        self.left = list(rule.body)
        self.bound: set[int] = set()

    def slots(self, terms: Sequence[str]) -> tuple[Slot, ...]:
        """Variables by number, objects by name."""
        return tuple(self._slots.get(term, term) for term in terms)

    def _measures(self, atom: Atom) -> tuple[frozenset[int], int, bool]:
        """An atom's variables, its number of variables and objects, and whether actions change it."""
        slots = frozenset(self.slots(atom.terms))
        return frozenset(slot for slot in slots if isinstance(slot, int)), len(slots), not self._is_static(atom)

    def rank(self, atom: Atom) -> tuple[bool, int, int, bool]:
        """The least atom is matched next: linked to what is bound, few variables not yet bound, static."""
        variables, slots, changing = self._atoms[atom]
        unbound = len(variables - self.bound)
        known = slots - unbound
        return (unbound > 0 and not known, unbound, -known, changing)

    def step(self, atom: Atom | None, lookup: bool = True) -> JoinStep:
        """The step that matches an atom (None: no atom); without `lookup` its fact is given."""
        key: dict[int, Slot] = {}
        fresh: dict[int, tuple[int, int]] = {}
        checks: list[tuple[int, Slot]] = []
        for position, slot in enumerate(self.slots(atom.terms) if atom else (), 1):
            if lookup and (isinstance(slot, str) or slot in self.bound):
                key[position] = slot
            elif isinstance(slot, str) or slot in fresh:
                checks.append((position, slot))
            else:
                fresh[slot] = (position, slot)
        self.bound.update(fresh)
        table = self._index.table(atom.predicate, tuple(key)) if atom and lookup else {}
        narrowed = tuple((position, slot, self._allowed(slot)) for position, slot in fresh.values())
        return JoinStep(table, _tuple_getter(tuple(key.values())), narrowed, tuple(checks), self._ready_tests())

    def choice(self, variable: int) -> JoinStep:
        """The step that tries every object of a variable that no atom binds."""
        self.bound.add(variable)
        table, _ = self._index.objects(self._variables[variable])
        return JoinStep(table, _tuple_getter(()), ((1, variable, self._allowed(variable)),), (), self._ready_tests())

    def _allowed(self, variable: int) -> frozenset[str]:
        """Those of a variable's objects of which all static facts about it alone hold: no test of each binding."""
        own = [atom for atom in self.left if self._is_static(atom) and self.slots(atom.terms) == (variable,)]
        if own:
            self.left = [atom for atom in self.left if atom not in own]
        return self._index.narrowed(self._variables[variable], frozenset(atom.predicate for atom in own))

    def _ready_tests(self) -> tuple[Test, ...]:
        """What can be tested now: of the atoms the static ones, without a lookup."""
        if not self._tests and not self.left:
            return ()
        ready = [test for test in self._tests if self._is_bound(test)]
        atoms = [atom for atom in self.left if self._is_static(atom) and self._is_bound(atom)]
        self._tests = [test for test in self._tests if test not in ready]
        self.left = [atom for atom in self.left if atom not in atoms]
        return tuple(_compiled(test, self) for test in (*ready, *atoms))

    def _is_static(self, atom: Atom) -> bool:
        return atom.predicate in self.world.static

    def _is_bound(self, formula: Formula) -> bool:
        return all(isinstance(slot, str) or slot in self.bound for slot in self.slots(terms_of(formula)))


def join_plan(rule: Rule, trigger: Atom | None, index: FactIndex, world: StaticWorld) -> JoinPlan:
    """The plan of a rule: next always an atom that few facts can match.

    Args:
      rule: The rule.
      trigger: The atom of its body whose fact is new; None if all are static.
      index: Gets the tables that the plan needs.
      world: Objects and static facts.
    """
    planner = _Planner(rule, index, world)
    planner.left = [atom for atom in rule.body if atom != trigger]
    first = planner.step(trigger, lookup=False)
    steps = []
    while planner.left:
        atom = min(planner.left, key=planner.rank)
        planner.left.remove(atom)
        steps.append(planner.step(atom))
    steps += [planner.choice(n) for n in range(len(rule.variables)) if n not in planner.bound]
    heads = tuple(_tuple_getter((atom.predicate, *planner.slots(atom.terms))) for atom in rule.head)
    return JoinPlan(first, tuple(steps), heads)


def _compiled(test: Formula, planner: _Planner) -> Test:
    """An equality or static atom, or the negation of one, as a function of the binding."""
    if isinstance(test, Not):
        inner = _compiled(test.part, planner)
        return lambda binding: not inner(binding)
    if isinstance(test, Equal):
        left, right = (_getter(slot) for slot in planner.slots((test.left, test.right)))
        return lambda binding: left(binding) == right(binding)
    assert isinstance(test, Atom)
    fact, facts = _tuple_getter((test.predicate, *planner.slots(test.terms))), planner.world.facts
    return lambda binding: fact(binding) in facts


def _tuple_getter(slots: tuple[Slot, ...]) -> Key:
    """The values of several slots as a function of the binding: one plan makes hundreds of thousands of such tuples."""
    match slots:
        case (int(only),):
            return lambda binding: (binding[only],)
        case (str(name), int(first)):
            return lambda binding: (name, binding[first])
        case (str(name), int(first), int(second)):
            return lambda binding: (name, binding[first], binding[second])
    return lambda binding: tuple([binding[slot] if isinstance(slot, int) else slot for slot in slots])


def _getter(slot: Slot) -> Callable[[Sequence[str]], str]:
    """The value of a slot as a function of the binding."""
    return itemgetter(slot) if isinstance(slot, int) else lambda binding: slot
