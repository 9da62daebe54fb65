"""Requests that come faster than a loop serves them: some wait, the others are told so, and none looks younger."""

from types import SimpleNamespace

import zenoh

from tailor.runtime.bus.service import BUSY, MAX_NEW, MAX_WAITING, QueryableSource, text_request


class Query:
    key_expr, attachment = "exec/goal", None

    def __init__(self, number):
        self.payload, self.refusals, self.accepted = zenoh.ZBytes(f"({number})"), [], False

    def reply(self, key, text):
        self.accepted = True

    def reply_err(self, text):
        self.refusals.append(text.decode())

    def drop(self):
        pass


class Bus:
    """One of zenoh's queryables, and a clock."""

    def __init__(self):
        self.queries, self.now, self.looks = [], 0, 0
        queryable = SimpleNamespace(key_expr="exec/goal", try_recv=self.try_recv)
        self.source = QueryableSource(queryable, text_request, lambda: self.now)

    def try_recv(self):
        self.looks += 1
        return self.queries.pop(0) if self.queries else None


def test_requests_beyond_those_that_wait_are_told_so_and_the_others_are_served_in_their_order():
    """They were told that there is no such service, and so were those before them."""
    bus, sent = Bus(), [Query(number) for number in range(MAX_WAITING + 4)]
    bus.queries = sent.copy()
    served = []
    while (request := bus.source.receive()) is not None:
        served.append(request.text)
        request.accept()
    assert served == [f"({number})" for number in range(MAX_WAITING)]
    assert [query.accepted for query in sent] == [True] * MAX_WAITING + [False] * 4
    assert [query.refusals for query in sent] == [[]] * MAX_WAITING + [[BUSY]] * 4


def test_a_request_is_as_old_as_its_arrival_however_late_it_is_served():
    bus = Bus()
    bus.queries = [Query(1), Query(2)]
    assert bus.source.receive().taken_ns == 0
    bus.queries, bus.now = [Query(3)], 100
    assert [bus.source.receive().taken_ns for _ in range(2)] == [0, 100]


def test_a_flood_of_requests_takes_a_bounded_part_of_a_period():
    bus = Bus()
    bus.queries = [Query(number) for number in range(1000)]
    assert bus.source.receive() is not None
    assert bus.looks == MAX_NEW
