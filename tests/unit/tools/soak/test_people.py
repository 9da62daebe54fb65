"""People of a soak go on after each task, whether it has a result or its fault waits for them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tailor.tools.soak.systems.people import AGAIN_NS, RESULT_NS, People

S = 1_000_000_000
DUE_S = 3


class Attended:
    """People before a system of plain values, armed, whose task has begun at 1 s."""

    def __init__(self):
        self.goals, self.armings, self.leaves = [], [], []
        self.call_s, self.now_ns = 0.0, 0
        self.status = SimpleNamespace(mode="EXECUTING", result="", reason="", detail="")
        self.driver = SimpleNamespace(mode="armed")
        view = SimpleNamespace(sender="e" * 32, driver=self.driver, status=self.status, status_ns=0)
        self.judge = SimpleNamespace(permitted=True, at_rest_since=lambda *_: True, people_arm=self.leaves.append)
        self.link = SimpleNamespace(view=view, arming=SimpleNamespace(publish=self.armings.append))
        self.people = People(self, self, lambda: self.now_ns)
        self.attend(1)

    def heard(self, now_ns):
        return True

    def call(self, service, text):
        self.goals.append((service, text))
        return True, ""

    def begin(self, now_ns):
        return 0

    def prepare(self, now_ns):
        self.now_ns += round(self.call_s * S)
        self.judge.permitted, self.driver.mode = False, "disarmed"  # as a reset of the world does
        return now_ns + DUE_S * S

    def goal(self):
        return "(next)"

    def attend(self, at_s):
        self.now_ns = self.link.view.status_ns = round(at_s * S)
        self.people.attend()


@pytest.mark.parametrize(
    ("ended", "faults"),
    [
        ({"mode": "READY", "result": "achieved"}, []),
        ({"mode": "FAULT", "reason": "repeated failure", "detail": "lost"}, ["repeated failure: lost"]),
    ],
)
def test_a_task_that_ended_is_followed_by_another_once_the_robot_is_armed_again(ended, faults):
    attended = Attended()
    vars(attended.status).update(ended)
    at_s = 1 + AGAIN_NS / S
    attended.attend(at_s)
    assert (attended.goals, len(attended.armings)) == ([], 1)
    attended.judge.permitted, attended.driver.mode = True, "armed"
    attended.attend(at_s + DUE_S - 0.1)
    assert attended.goals == []
    attended.attend(at_s + DUE_S + 0.1)
    assert attended.goals == [("exec/goal", "(next)")]
    assert (attended.people.count, attended.people.faults) == (1, faults)
    assert RESULT_NS < DUE_S * S


def test_the_leave_to_move_counts_from_the_request_however_long_the_new_world_took():
    attended = Attended()
    attended.status.result, attended.call_s = "achieved", 1.0
    at_s = 1 + AGAIN_NS / S
    attended.attend(at_s)
    assert len(attended.armings) == 1
    assert attended.leaves == [round((at_s + 1.0) * S)]


def test_a_task_that_goes_on_is_left_alone():
    attended = Attended()
    for at_s in range(2, 60):
        attended.attend(at_s)
    assert (attended.goals, attended.armings, attended.people.faults) == ([], [], [])
