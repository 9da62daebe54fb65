"""A launched system beside programs that take all CPU time: its ticks and its motion go on."""

import time

import pytest

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import decode
from tailor.schemas.messages import DriverState, Provenance, TickReport
from tests.faults.supervision.launched import launched
from tests.support.driven import burners
from tests.support.patience import wait_until

WARM_UP_S = 1.0
MAX_P99_S = 0.05  # also under the default scheduler
KINDS = {"exec/tick": TickReport, "exec/provenance": Provenance, "agilo/driver": DriverState}
SECONDS = [10, pytest.param(60, marks=pytest.mark.slow)]


@pytest.mark.promise("P25")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("seconds", SECONDS)
def test_four_cpu_burners_neither_skip_a_tick_nor_stop_the_robot(seconds, tmp_path, measured):
    with launched(tmp_path) as system:
        wait_until(system.moves, "robot moves")
        with burners():
            time.sleep(WARM_UP_S)
            from_ns = time.time_ns()
            time.sleep(seconds)
            to_ns = time.time_ns()
    records = [r for r in open_recording(system.recording).messages() if r.key in KINDS]
    messages = [decode(KINDS[r.key], r.data) for r in records]
    within = [m for m in messages if from_ns <= m.stamp_ns <= to_ns]
    ticks = [m for m in within if isinstance(m, TickReport)]
    late_s = sorted(m.lateness_ns / 1e9 for m in ticks)
    real_time = '"scheduler": "fifo' in next(m.json for m in messages if isinstance(m, Provenance))
    assert len(ticks) > 9 * seconds
    assert {m.mode for m in within if isinstance(m, DriverState)} == {"armed"}, "a stop by itself"
    if real_time:
        measured.add(sum(m.skipped for m in ticks), 0, unit="ticks", what="skipped")
    measured.add(late_s[len(late_s) * 99 // 100], MAX_P99_S, what="lateness, p99")
