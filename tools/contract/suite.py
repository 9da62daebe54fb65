"""The contract as pytest's tests: one for each clause, domain and case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache

import pytest

from tailor.schemas.installed import domain_names
from tailor.tools.contract import action_clauses, body_clauses, package_clauses, scenario_clauses, scene_clauses
from tailor.tools.contract.clause import CLAUSES, Clause
from tailor.tools.contract.subject import Subject

__all__ = ["CLAUSES", "cases", "ordered_clauses", "pytest_generate_tests", "test_contract"]
SOURCES = (package_clauses, action_clauses, scenario_clauses, body_clauses, scene_clauses)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each clause and case of the domains named by --tailor-domain, or of all that are installed."""
    names = metafunc.config.getoption("tailor_domain", default=None) or domain_names()
    rows = [(clause, subject, case) for subject in map(subject_of, names) for clause, case in cases(subject)]
    ids = ["-".join(filter(None, (subject.name, clause.name, case))) for clause, subject, case in rows]
    metafunc.parametrize(("clause", "subject", "case"), rows, ids=ids)


def test_contract(clause: Clause, subject: Subject, case: str) -> None:
    """A domain keeps to a clause."""
    if found := list(clause.check(subject, case)):
        pytest.fail(f"{clause.text}\n" + "\n".join(f"  {fault}" for fault in found), pytrace=False)


@cache
def subject_of(name: str) -> Subject:
    """The domain under test."""
    return Subject(name)


def cases(subject: Subject) -> Iterator[tuple[Clause, str]]:
    """Clauses with the actions or scenarios for which they are checked; without those whose part the package lacks."""
    by_scope: dict[str, Iterable[str]] = {"package": ("",), "scenario": subject.scenarios}
    by_scope["action"] = subject.domain.actions
    for clause in ordered_clauses():
        if not clause.needs or has(subject, clause.needs):
            yield from ((clause, case) for case in by_scope[clause.scope])


def ordered_clauses() -> list[Clause]:
    """All clauses, equally in each process, as pytest-xdist requires: the modules may be imported in another order."""
    order = [source.__name__ for source in SOURCES]
    return sorted(CLAUSES.values(), key=lambda clause: order.index(clause.check.__module__))


def has(subject: Subject, part: str) -> bool:
    """Whether the package has a part; actions are run with body and sampler."""
    return bool(getattr(subject.spec, part)) and (part != "body" or bool(subject.spec.sampler))
