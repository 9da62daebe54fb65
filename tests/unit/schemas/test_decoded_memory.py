"""Decoding needs no more memory the longer it goes on: a launcher decodes for days."""

import sys

from tailor.schemas.codec import decode, encode
from tailor.schemas.messages import Subgoals
from tailor.schemas.own import example

LENGTHS = range(1, 21)  # of tuples that Python keeps for reuse, up to 2000 of each length


def decode_each(payloads, times):
    for _ in range(times):
        for payload in payloads:
            decode(Subgoals, payload)


def test_plans_that_get_shorter_step_by_step_leave_nothing_behind():
    step = example(Subgoals).actions[0]
    payloads = [encode(Subgoals(0, 0, 0, (step,) * count)) for count in LENGTHS]
    decode_each(payloads, 3)
    before = sys.getallocatedblocks()
    decode_each(payloads, 20)
    assert sys.getallocatedblocks() - before < 50  # hundreds if each leaves a tuple
