"""Binding constraints: which variables of a plan's steps are the same, apart, or a certain object."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

Variable = tuple[str, int]  # parameter, step
Term = str | Variable  # an object, or a variable
Pairs = Iterable[tuple[Term, Term]]


@dataclass(frozen=True, slots=True)
class Group:
    """Variables that are the same; the object they stand for, if decided; those they must differ from."""

    members: tuple[Variable, ...]
    choices: frozenset[str]  # objects that are still possible
    value: str | None = None
    apart: tuple[Variable, ...] = ()


class Bindings:
    """Immutable: each change gives new bindings, or None when it contradicts."""

    __slots__ = ("_groups",)

    def __init__(self, groups: Mapping[Variable, Group] | None = None) -> None:
        self._groups: dict[Variable, Group] = dict(groups or {})

    def with_variables(self, choices: Mapping[Variable, Iterable[str]]) -> Bindings:
        """New variables, each with the objects that it may stand for."""
        new = {variable: Group((variable,), frozenset(objects)) for variable, objects in choices.items()}
        return Bindings({**self._groups, **new})

    # --- questions -------------------------------------------------------------------------------
    def value(self, term: Term) -> str | None:
        """The object that a term stands for, or None while that is open."""
        return term if isinstance(term, str) else self._groups[term].value

    def same(self, a: Term, b: Term) -> bool:
        """Whether the terms are the same in every completion."""
        if a == b:
            return True
        value = self.value(a)
        if value is not None or isinstance(a, str) or isinstance(b, str):
            return value is not None and value == self.value(b)
        return self._groups[a] is self._groups[b]

    def may_equal(self, a: Term, b: Term) -> bool:
        """Whether some completion makes the terms the same."""
        if self.same(a, b):
            return True
        if isinstance(a, str):
            a, b = b, a
        if isinstance(a, str):
            return False
        group = self._groups[a]
        if isinstance(b, str):
            return b in group.choices
        other = self._groups[b]
        if any(variable in other.members for variable in group.apart):
            return False
        return not group.choices.isdisjoint(other.choices)

    def may_unify(self, pairs: Pairs) -> bool:
        """Whether each pair for itself may become the same."""
        return all(self.may_equal(a, b) for a, b in pairs)

    def differing(self, pairs: Pairs) -> tuple[tuple[Term, Term], ...]:
        """The pairs that are not yet the same."""
        return tuple((a, b) for a, b in pairs if not self.same(a, b))

    # --- changes ---------------------------------------------------------------------------------
    def unified(self, pairs: Pairs) -> Bindings | None:
        """The bindings with both terms of each pair the same; None when that cannot be."""
        result: Bindings | None = self
        for a, b in pairs:
            if result is None or result.same(a, b):
                continue
            result = result._joined(a, b) if result.may_equal(a, b) else None
        return result

    def separated(self, a: Term, b: Term) -> Bindings | None:
        """The bindings with two terms that must differ; None when they are the same."""
        if self.same(a, b):
            return None
        if not self.may_equal(a, b):
            return self
        if isinstance(a, str):
            a, b = b, a
        assert not isinstance(a, str)  # two different objects can never be equal
        group = self._groups[a]
        if isinstance(b, str):
            return self._changed(replace(group, choices=group.choices - {b}))
        both = self._changed(replace(group, apart=(*group.apart, b)))
        if both is None:
            return None
        other = both._groups[b]
        return both._changed(replace(other, apart=(*other.apart, a)))

    def equated(self, a: Term, b: Term, same: bool) -> Bindings | None:
        """The bindings with two terms the same, or not; None when that cannot be."""
        return self.unified([(a, b)]) if same else self.separated(a, b)

    def _joined(self, a: Term, b: Term) -> Bindings | None:
        if isinstance(a, str):
            a, b = b, a
        assert not isinstance(a, str)
        group = self._groups[a]
        if isinstance(b, str):
            return self._changed(replace(group, value=b, choices=frozenset([b])))
        other = self._groups[b]
        joined = Group(
            group.members + other.members,
            group.choices & other.choices,
            group.value or other.value,
            group.apart + tuple(variable for variable in other.apart if variable not in group.apart),
        )
        return self._changed(joined)

    def _changed(self, group: Group) -> Bindings | None:
        """With one group renewed, moved behind all others; a decided object is struck off the groups apart."""
        if not group.choices:
            return None
        groups = {variable: old for variable, old in self._groups.items() if variable not in group.members}
        groups.update(dict.fromkeys(group.members, group))
        result: Bindings | None = Bindings(groups)
        if group.value is not None:
            for variable in group.apart:
                other = groups[variable]
                if result is not None and group.value in other.choices:
                    result = result._narrowed(variable, group.value)
        return result

    def _narrowed(self, variable: Variable, gone: str) -> Bindings | None:
        group = self._groups[variable]
        narrowed = replace(group, choices=group.choices - {gone})
        if not narrowed.choices:
            return None
        return Bindings({**self._groups, **dict.fromkeys(group.members, narrowed)})

    # --- completion ------------------------------------------------------------------------------
    def completed(self) -> Bindings | None:
        """The bindings with an object for every variable, the first by name that fits; None when there is none."""
        current: Bindings | None = self
        tried: list[tuple[Bindings, Variable, Iterator[str]]] = []  # no recursion: there may be thousands of variables
        while current is not None:
            variable = next((v for v, group in current._groups.items() if group.value is None), None)
            if variable is None:
                return current
            tried.append((current, variable, iter(sorted(current._groups[variable].choices))))
            current = _next_bound(tried)
        return None

    def lines(self) -> tuple[str, ...]:
        """The bindings as VHPOP prints them: a line per group, the one changed last first."""
        groups = dict.fromkeys(reversed(self._groups.values()))
        return tuple(_line(group) for group in groups)


def _next_bound(tried: list[tuple[Bindings, Variable, Iterator[str]]]) -> Bindings | None:
    """The next choice for the last variable tried; where it has none left, for the one before."""
    while tried:
        bindings, variable, names = tried[-1]
        for name in names:
            bound = bindings.unified([(variable, name)])
            if bound is not None:
                return bound
        tried.pop()
    return None


def _line(group: Group) -> str:
    def names(variables: tuple[Variable, ...]) -> str:
        return "{ " + " ".join(f"{name}({step})" for name, step in variables) + " }"

    value = f" == {group.value}" if group.value is not None else ""
    apart = f" != {names(group.apart)}" if group.apart else ""
    return f"{names(group.members)}{value}{apart}"
