"""The watch of a soak misses children that are absent, counts them, and sees a task that does not go on."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tailor.tools.soak.judging.violations import Invariant
from tailor.tools.soak.systems.system import CHILDREN
from tailor.tools.soak.watch import Watch

S = 1_000_000_000


class Watched:
    """A watch over a system of plain values; `run` polls it each half second."""

    def __init__(self):
        self.found = {"up": [1], **{name: [number] for number, name in enumerate(CHILDREN, 2)}}
        self.mode, self.result = "armed", ""
        self.judge = SimpleNamespace(moved_ns=0)
        self.reported = []
        self.watch = Watch(self, lambda now_ns, invariant, detail: self.reported.append((invariant, detail)))
        self.watch.started(0)
        self.now_ns = 0

    @property
    def link(self):
        driver, status = SimpleNamespace(mode=self.mode, reason=""), SimpleNamespace(result=self.result, mode="READY")
        status.reason = status.detail = ""
        return SimpleNamespace(view=SimpleNamespace(driver=driver, status=status))

    def pids(self):
        return self.found

    def run(self, seconds, moving=True):
        ends_ns = self.now_ns + seconds * S
        while self.now_ns < ends_ns:
            self.now_ns += S // 2
            if moving:
                self.judge.moved_ns = self.now_ns
            self.watch.poll(self.now_ns)


@pytest.fixture
def watched():
    watched = Watched()
    watched.run(60)
    return watched


def test_a_complete_system_in_motion_is_fine(watched):
    assert watched.reported == []
    assert not watched.watch.launcher_gone


@pytest.mark.parametrize("name", CHILDREN)
def test_a_child_that_stays_away_is_missed_once(watched, name):
    del watched.found[name]
    watched.run(7)
    assert watched.reported == []
    watched.run(60)
    assert watched.reported == [(Invariant.CHILDREN, f"{name} is absent for 8 s")]


def test_two_of_one_child_are_one_too_many(watched):
    watched.found["sim"] = [3, 9]
    watched.run(2)
    assert watched.reported == [(Invariant.CHILDREN, "2 processes of sim")]


def test_nothing_that_moves_for_long_is_a_task_that_does_not_go_on(watched):
    watched.run(29, moving=False)
    assert watched.reported == []
    watched.run(3, moving=False)
    assert [invariant for invariant, _ in watched.reported] == [Invariant.TASK_GOES_ON]


def test_nothing_needs_to_move_after_the_task(watched):
    watched.result = "achieved"
    watched.run(120, moving=False)
    assert watched.reported == []


def test_a_robot_that_nobody_arms_is_missed_even_after_its_task(watched):
    watched.result, watched.mode = "achieved", "stopped"
    watched.run(40, moving=False)
    assert [invariant for invariant, _ in watched.reported] == [Invariant.TASK_GOES_ON]


def test_an_ended_launcher_is_seen(watched):
    watched.found = {}
    watched.run(2)
    assert watched.watch.launcher_gone
