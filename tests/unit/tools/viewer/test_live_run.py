"""The live page while a bus comes back: its pages keep the last run, marked as past, until the next one is heard."""

from __future__ import annotations

import argparse
import json
from contextlib import ExitStack, contextmanager, suppress

import pytest

from tailor.runtime.stopping import Stop
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems import bus_renewal
from tailor.tools.viewer.live import live_run
from tailor.tools.viewer.live.live_run import LiveRun
from tailor.tools.viewer.timeline import Event
from tests.support.stand_ins.silent_session import SilentSession
from tests.unit.tools.viewer.test_view_live import tick

FLAGS = argparse.Namespace(connect="tcp/127.0.0.1:7999", key=None, config="", robot="", sender="", no_models=True)
PAST, BEGINS = [[0.0, "tick", {"work": 1.0}]], []


@pytest.mark.parametrize("refused", ["people", "observer", ""])
def test_pages_begin_anew_only_once_the_next_run_is_listened_to(monkeypatch, refused):
    @contextmanager
    def open_bus(arguments, role, sender=""):
        if role == refused:
            raise UsageError("no router responds")
        yield SilentSession()

    for module in (live_run, bus_renewal):
        monkeypatch.setattr(module, "open_bus", open_bus)
    stop = Stop()
    stop.requested = True
    run = LiveRun(FLAGS, stop)
    monkeypatch.setattr(run._button, "of", lambda session: ExitStack())
    run._broadcast.publish([tick(0.0)])
    with run._broadcast.subscribe() as page, ExitStack() as sessions:
        with suppress(UsageError):
            run._open_again(sessions, button=True)
        assert page.lost is (not refused)
        assert json.loads(page.next(0)) == PAST
        assert json.loads(page.next(0)) == [Event(0.0, "now", {"bus": False}).json_value()]
    with run._broadcast.subscribe() as page:
        assert json.loads(page.next(0)) == (PAST if refused else BEGINS)


def test_a_bus_that_nobody_can_open_is_one_error(monkeypatch, capsys):
    """A remark on the stop button came before it, on standard output."""

    def open_bus(arguments, role, sender=""):
        raise UsageError("no router responds")

    for module in (live_run, bus_renewal):
        monkeypatch.setattr(module, "open_bus", open_bus)
    monkeypatch.setattr(live_run.os, "nice", lambda _: 0)
    with pytest.raises(UsageError, match="no router responds"):
        LiveRun(argparse.Namespace(**vars(FLAGS), port=0), Stop()).serve()
    assert capsys.readouterr().out == ""
