"""On an open bus a stranger who speaks as executive and driver neither ends a run nor keeps it from arming."""

import dataclasses
import random
import subprocess
import threading
import time

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import ActionFinished, DriverState, ExecStatus
from tailor.schemas.own import example
from tests.support.bus_system import ROOT, answers, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

PERIOD_S = 0.02  # faster than executive and driver, so that a stranger is usually the first one heard


def lie(session, until):
    """Publish that the goal is achieved, and that the driver is disarmed or stopped, until the event."""
    forged = {
        "status": [dataclasses.replace(example(ExecStatus), result="achieved")],
        "driver": [
            dataclasses.replace(example(DriverState), mode=mode, epoch=99, armed_sender="")
            for mode in ("disarmed", "stopped")
        ],
    }
    publishers = {topic: session.publisher(topic, "agilo") for topic in forged}
    turn = 0
    while not until.wait(PERIOD_S):
        turn += 1
        for topic, messages in forged.items():
            publishers[topic].publish(messages[turn // 50 % len(messages)])


@pytest.mark.promise("P48")
@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize("number", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 21))])
def test_a_stranger_who_speaks_as_executive_and_driver_does_not_disturb_a_run(number, tmp_path):
    endpoint, ended = free_endpoint(), threading.Event()
    (tmp_path / "open.toml").write_text(f'[bus]\nendpoint = "{endpoint}"\nsecurity = "open"\n')
    command = tailor("up", "soccer", "--once", "--seed", "1", "--config", str(tmp_path / "open.toml"))
    up = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        wait_until(lambda: answers(endpoint), "router")
        with open_client(endpoint) as session:
            finished = session.inbox(["finished"], "agilo")
            time.sleep(random.Random(number).uniform(0.0, 3.0) if number > 1 else 0.0)
            liar = threading.Thread(target=lie, args=(session, ended))
            liar.start()
            try:
                output, _ = up.communicate(timeout=2 * PATIENCE_S)
                done = [s.message for s in finished.drain() if isinstance(s.message, ActionFinished)]
            finally:
                ended.set()
                liar.join()
    finally:
        up.kill()
        up.wait()
    assert (up.returncode, output.splitlines()[-1]) == (0, "achieved"), output
    assert [action.outcome for action in done] == ["done", "done"], "the goal was reached, not only claimed"
