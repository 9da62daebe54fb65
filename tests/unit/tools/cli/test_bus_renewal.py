"""A session that is cut off for good is told from one whose bus hung."""

import argparse
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.rights.hosted_folder import hosted
from tailor.runtime.bus.rights.run_folder import RunFolder
from tailor.tools.cli.bus_renewal import CHECK_NS, GONE_NS, BusRenewal

ENDPOINT = "tcp/127.0.0.1:7999"
FLAGS = argparse.Namespace(config="", connect=ENDPOINT)


@pytest.fixture
def cut_off(tmp_path, monkeypatch):
    """A renewal of a session that lost a bus with passwords, which listens again; and when it knows of the loss."""
    monkeypatch.setenv("TAILOR_RUN_DIR", str(tmp_path))
    monkeypatch.setattr(RunFolder, "running", lambda folder: True)
    with hosted(ENDPOINT, ["observer"]) as folder:
        renewal = BusRenewal(FLAGS, SimpleNamespace(connected=False), 0)
        yield folder, renewal, GONE_NS + CHECK_NS


def test_a_session_waits_for_a_bus_that_hung_though_it_may_be_opened_anew(cut_off):
    _, renewal, now_ns = cut_off
    assert not renewal.final(now_ns)
    assert renewal.due(now_ns + CHECK_NS)


def test_a_loop_never_knocks_at_a_bus_that_hangs(cut_off, monkeypatch):
    """Knocks that nobody answers fill a queue, and then the next one waits: for seconds, in the loop of a driver."""
    _, renewal, now_ns = cut_off
    knocks = []
    monkeypatch.setattr(RunFolder, "running", knocks.append)
    renewal.final(now_ns)
    assert knocks == []


def test_a_session_is_cut_off_for_good_by_other_passwords(cut_off):
    folder, renewal, now_ns = cut_off
    folder.users_file.write_text("observer:another")
    assert renewal.final(now_ns)
