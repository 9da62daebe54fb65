"""Hashes of source: they change with behaviour, not with words, and only with the robot's own parts."""

import sys
from functools import lru_cache

import pytest

from tailor.schemas.installed import source, source_text
from tailor.schemas.installed.source import episodes_sha256, learning_sha256, runs_sha256
from tailor.schemas.installed.source_text import code_text, content_sha256
from tailor.schemas.packages.spec import DomainSpec

CODE = "def f(x):\n    return x + 1\n"


@pytest.mark.parametrize("same", ["# why\n" + CODE, CODE.replace("return", '"""What."""\n    return'), CODE + "\n\n"])
def test_words_and_layout_do_not_count(same):
    assert code_text(same) == code_text(CODE)


@pytest.mark.parametrize("other", [CODE.replace("+", "-"), CODE.replace("1", "1.0"), CODE.replace("(x)", "(x=0)")])
def test_every_change_of_behaviour_counts(other):
    assert code_text(other) != code_text(CODE)


MEANING = lru_cache(maxsize=None)(code_text)


@pytest.fixture(autouse=True)
def _each_file_is_parsed_once(monkeypatch):
    """Two hashes of a test differ in one file; to parse the other 500 again takes a second."""
    monkeypatch.setattr(source_text, "code_text", MEANING)


@lru_cache(maxsize=1)
def hash_of_learning(domain):
    """The hash of what learns, which is the same for every domain."""
    return learning_sha256.__wrapped__()


@pytest.fixture
def altered(monkeypatch):
    """Hashes as they were before, and after a file was altered."""

    def alter(path, hashed, domain):
        before = hashed(domain)
        read = source.Path.read_text
        monkeypatch.setattr(
            source.Path, "read_text", lambda self, **how: read(self, **how) + "altered = 1\n" * str(self).endswith(path)
        )
        return hashed.__wrapped__(domain) != before

    return alter


@pytest.mark.parametrize(
    ("path", "hashed", "domain", "counts"),
    [
        ("executive/actions/reach.py", episodes_sha256, "arm", True),
        ("simnodes/powercube/body.py", episodes_sha256, "arm", True),
        ("simnodes/agilo/body.py", episodes_sha256, "arm", False),
        ("executive/refinement/refinement.py", episodes_sha256, "arm", False),
        ("executive/refinement/refinement.py", runs_sha256, "arm", True),
        ("executive/core/sensing/freshness.py", runs_sha256, "arm", True),
        ("executive/deliberation/plan_source.py", runs_sha256, "arm", True),
        ("simnodes/powercube/driver.toml", runs_sha256, "arm", True),
        ("schemas/kitchen/kitchen.toml", episodes_sha256, "kitchen", True),
        ("schemas/kitchen/kinematics.py", episodes_sha256, "kitchen", True),
        ("schemas/kitchen/kitchen.toml", runs_sha256, "kitchen", True),
        ("schemas/kitchen/kinematics.py", runs_sha256, "kitchen", True),
        ("schemas/kitchen/kitchen.toml", runs_sha256, "soccer", False),
        ("executive/actions/reach.py", runs_sha256, "soccer", False),
        ("schemas/codec.py", runs_sha256, "kitchen", False),
        ("models/features/drive_clearance/way.py", runs_sha256, "kitchen", True),
        ("models/features/drive_clearance/way.py", hash_of_learning, "kitchen", True),
        ("models/features/drive_clearance/way.py", episodes_sha256, "kitchen", False),
        ("tools/viewer/page.py", runs_sha256, "arm", False),
    ],
)
def test_only_what_determines_the_behaviour_counts(altered, path, hashed, domain, counts):
    assert altered(path, hashed, domain) is counts


@pytest.mark.parametrize(
    "file", ["domain.py", "driver.toml", "control/pid.py", "scenarios/tour.toml", "scenarios/tour.pddl"]
)
def test_every_file_of_a_package_of_others_counts_whatever_its_folder(tmp_path, monkeypatch, file):
    """`tailor evaluate` keeps finished runs by this hash: those of a changed scenario passed for those of today's."""
    package = tmp_path / "ferry_robot"
    for name in ("__init__.py", "domain.py", "driver.toml", "control/pid.py", "scenarios/tour.toml"):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text("leg = 1.0\n")
    (package / "scenarios" / "tour.pddl").write_text("(define (problem tour))")
    monkeypatch.syspath_prepend(str(tmp_path))
    for name in [name for name in sys.modules if name.startswith("ferry_robot")]:  # of the test before
        monkeypatch.delitem(sys.modules, name)
    spec = DomainSpec(
        "ferry", "ferry", "ferry_robot.domain:make", draw="ferry_robot.domain:draw", package="ferry_robot"
    )
    monkeypatch.setattr(source, "spec_of", lambda _: spec)
    before = runs_sha256.__wrapped__("ferry")
    (package / "notes.txt").write_text("none of the source")
    assert runs_sha256.__wrapped__("ferry") == before
    (package / file).write_text("leg = 2.0\n")
    assert runs_sha256.__wrapped__("ferry") != before


@pytest.mark.parametrize("name", ["a.toml", "a.py", "a.xml"])
def test_a_file_with_faults_counts_as_it_is(tmp_path, name):
    """What needs it names the fault in one line; the hash ended commands with a traceback before."""
    (tmp_path / name).write_bytes(b"= ) <a>\xff")
    first = content_sha256(tmp_path / name)
    (tmp_path / name).write_bytes(b"= ) <b>\xff")
    assert content_sha256(tmp_path / name) != first
