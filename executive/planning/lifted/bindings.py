"""Binding constraints: variables of a plan's steps that are equal, different, or bound to an object."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

Variable = tuple[str, int]  # parameter, step
Term = str | Variable  # an object, or a variable
Pairs = Iterable[tuple[Term, Term]]


@dataclass(frozen=True, slots=True)
class Group:
    """Codesignating variables, the object they are bound to (if any), and the variables they must differ from."""

    members: tuple[Variable, ...]
    choices: frozenset[str]  # objects still possible
    value: str | None = None
    apart: tuple[Variable, ...] = ()


class Bindings:
    """Immutable binding constraints; a change returns new bindings, or None if they are inconsistent."""

    __slots__ = ("_groups",)

    def __init__(self, groups: Mapping[Variable, Group] | None = None) -> None:
        self._groups: dict[Variable, Group] = dict(groups or {})

    def with_variables(self, choices: Mapping[Variable, Iterable[str]]) -> Bindings:
        """The bindings with new variables, each with its possible objects."""
        new = {variable: Group((variable,), frozenset(objects)) for variable, objects in choices.items()}
        return Bindings({**self._groups, **new})

    # --- queries ---------------------------------------------------------------------------------
    def value(self, term: Term) -> str | None:
        """The object that a term is bound to; None while unbound."""
        return term if isinstance(term, str) else self._groups[term].value

    def same(self, a: Term, b: Term) -> bool:
        """Whether the terms are equal in every completion."""
        if a == b:
            return True
        value = self.value(a)
        if value is not None or isinstance(a, str) or isinstance(b, str):
            return value is not None and value == self.value(b)
        return self._groups[a] is self._groups[b]

    def may_equal(self, a: Term, b: Term) -> bool:
        """Whether the constraints allow the terms to be equal."""
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
        """Whether each pair, considered alone, may be equal."""
        return all(self.may_equal(a, b) for a, b in pairs)

    def differing(self, pairs: Pairs) -> tuple[tuple[Term, Term], ...]:
        """The pairs that are not yet equal."""
        return tuple((a, b) for a, b in pairs if not self.same(a, b))

    # --- changes ---------------------------------------------------------------------------------
    def unified(self, pairs: Pairs) -> Bindings | None:
        """The bindings with the terms of each pair equal; None if inconsistent."""
        result: Bindings | None = self
        for a, b in pairs:
            if result is None or result.same(a, b):
                continue
            result = result._joined(a, b) if result.may_equal(a, b) else None
        return result

    def separated(self, a: Term, b: Term) -> Bindings | None:
        """The bindings with two terms different; None if they are equal."""
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
        """The bindings with two terms equal (`same`) or different; None if inconsistent."""
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
        """The bindings with one group replaced and moved to the end; its object is excluded from the groups apart."""
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

    def _narrowed(self, variable: Variable, excluded: str) -> Bindings | None:
        group = self._groups[variable]
        narrowed = replace(group, choices=group.choices - {excluded})
        if not narrowed.choices:
            return None
        return Bindings({**self._groups, **dict.fromkeys(group.members, narrowed)})

    # --- completion ------------------------------------------------------------------------------
    def completions(self) -> Iterator[Bindings]:
        """The bindings with an object for every variable, those consistent, in the order of the names."""
        current: Bindings | None = self
        tried: list[tuple[Bindings, Variable, Iterator[str]]] = []  # no recursion: there may be thousands of variables
        while current is not None:
            variable = next((v for v, group in current._groups.items() if group.value is None), None)
            if variable is None:
                yield current
            else:
                tried.append((current, variable, iter(sorted(current._groups[variable].choices))))
            current = _next_bound(tried)

    def lines(self) -> tuple[str, ...]:
        """The bindings as VHPOP prints them: one line per group, last changed first."""
        groups = dict.fromkeys(reversed(self._groups.values()))
        return tuple(_line(group) for group in groups)


def _next_bound(tried: list[tuple[Bindings, Variable, Iterator[str]]]) -> Bindings | None:
    """The next choice for the last variable, backtracking to earlier ones."""
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
