"""Many goals that wait at once: each is as old as its arrival, however many are served before it."""

from types import SimpleNamespace

import pytest
import zenoh

from tailor.executive.shell import Shell
from tailor.runtime.bus.service import MAX_WAITING, QueryableSource, ServiceServer, text_request
from tests.support.toy_domain import line_context
from tests.unit.executive.test_shell import Clock, Session
from tests.unit.runtime.bus.test_waiting_requests import Query


class Goal(Query):
    def __init__(self, text):
        super().__init__(0)
        self.payload = zenoh.ZBytes(text)


class Crowd(Session):
    """A bus with one of zenoh's queryables, which many clients may call at once."""

    def __init__(self, clock):
        super().__init__()
        self.clock, self.queries = clock, []

    def service_server(self, key, *others):
        queryable = SimpleNamespace(key_expr=key, try_recv=lambda: self.queries.pop(0) if self.queries else None)
        return ServiceServer(QueryableSource(queryable, text_request, self.clock.now_ns), *others)


@pytest.mark.promise("P41")
def test_none_of_many_goals_that_waited_while_the_executive_stood_still_counts():
    """It serves one in a tick: the eleventh was served more than a second after the pause, and pursued."""
    clock, sent = Clock(), [Goal("(visited a)") for _ in range(MAX_WAITING)]
    session = Crowd(clock)

    def until(state):
        if state.tick == 10:
            session.queries = sent.copy()
            clock.ns += 12 * 10**9
        return state.tick == 40

    state = Shell(line_context(), session, clock, {}).run("", until)
    assert [query.accepted for query in sent] == [False] * MAX_WAITING
    assert all(query.refusals[0].startswith("the executive stood still for 1") for query in sent)
    assert state.task.goal == ""


def test_of_many_goals_that_come_at_once_while_it_runs_the_last_one_counts():
    clock, sent = Clock(), [Goal("(visited a)"), *(Goal("(visited b)") for _ in range(MAX_WAITING - 1))]
    session = Crowd(clock)

    def until(state):
        if state.tick == 10:
            session.queries = sent.copy()
        return state.tick == 40

    state = Shell(line_context(), session, clock, {}).run("", until)
    assert all(query.accepted for query in sent)
    assert state.task.goal == "(visited b)"
