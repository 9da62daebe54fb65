"""Property tests draw the same examples in every run, and no clock judges them: a check fails for a reason or never.

`pytest --hypothesis-profile explore` draws new ones. Tests that share a fixture of their module run on one worker.
"""

import gc
import os
import signal
from functools import lru_cache, partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.support.spreading import spread

pytest_plugins = ["tests.support.safety.promises"]
# On busy cores the threads of scikit-learn spin while they wait for one another: 22 s of CPU for what takes 5.
os.environ.setdefault("OMP_NUM_THREADS", "1")
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # `make test &` in a script: what tests start would ignore Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)
os.environ.setdefault("MUJOCO_GL", "disable")  # no test draws with MuJoCo; to load OpenGL takes each simulator 0.1 s
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # for tests that import onnxruntime before tailor.models

WAITING = {Path(__file__).with_name(name) for name in ("e2e", "faults")}  # folders of tests that start processes

unfrozen = []  # not empty: the test that runs has unfrozen all objects

settings.register_profile("explore", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("repeat", settings.get_profile("explore"), derandomize=True)
settings.load_profile("repeat")


@pytest.fixture(scope="session", autouse=True)
def _shared_sessions():
    """A model's bytes are opened once a worker: a session keeps nothing of a call, and many tests load what ships."""
    from tailor.models import runtime

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runtime, "open_session", lru_cache(maxsize=100)(runtime.open_session))
        yield


@pytest.fixture
def few_first_ticks(monkeypatch):
    """Candidates enough where their choice is not what is tested: five take most of the time of a training."""
    from tailor.models.training import first_ticks

    monkeypatch.setattr(first_ticks, "FIRST_TICKS", (1, 2))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Where pybullet is not installed, what needs the kitchen's simulator is skipped: later Pythons have no wheel."""
    try:
        return (yield)
    except ModuleNotFoundError as error:
        if error.name == "pybullet":
            pytest.skip("pybullet is not installed (extra bullet)")
        raise


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session):
    """Ten thousand tests are kept to the end: garbage collections skip them, now and later."""
    gc.disable()


def pytest_collection_finish(session):
    gc.enable()
    gc.freeze()
    gc.unfreeze = partial(_unfreeze, gc.unfreeze)


def _unfreeze(unfreeze):
    """Noted, as `gc.get_freeze_count` visits each frozen object: 50 ms for each test."""
    unfreeze()
    unfrozen.append(True)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item):
    """What a test has frozen for itself it has unfrozen with all the others: freeze them again."""
    yield
    if unfrozen:
        gc.freeze()
        unfrozen.clear()


@pytest.hookimpl(tryfirst=True)  # xdist reads the marks in its own
def pytest_collection_modifyitems(config, items):
    """With `--dist loadgroup`, run a group on one worker, make each fixture of a module once, and spread what waits."""
    for item in items:
        fixtures = (each for defs in item._fixtureinfo.name2fixturedefs.values() for each in defs)
        if item.get_closest_marker("xdist_group") is None and any(each.scope == "module" for each in fixtures):
            item.add_marker(pytest.mark.xdist_group(item.nodeid.partition("::")[0]))
        group = item.get_closest_marker("xdist_group")
        # xdist up to 3.8 cannot name the group of an item to pytest from 9.2 on: pytest-dev/pytest-xdist#1386
        if group is not None and getattr(config.option, "loadgroup", False) and hasattr(item, "_id"):
            item._id = type(item._id).parse(f"{item.nodeid}@{group.args[0]}")
    if getattr(config.option, "loadgroup", False):
        spread(items, lambda item: waits(item) and item.get_closest_marker("xdist_group") is None)


def waits(item):
    return not WAITING.isdisjoint(item.path.parents)
