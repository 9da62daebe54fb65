"""Hashes of source: they change with behaviour, not with words, and only with the robot's own parts."""

from functools import lru_cache

import pytest

from tailor.schemas.installed import source
from tailor.schemas.installed.source import episodes_sha256, learning_sha256, runs_sha256
from tailor.schemas.installed.source_text import code_text

CODE = "def f(x):\n    return x + 1\n"


@pytest.mark.parametrize("same", ["# why\n" + CODE, CODE.replace("return", '"""What."""\n    return'), CODE + "\n\n"])
def test_words_and_layout_do_not_count(same):
    assert code_text(same) == code_text(CODE)


@pytest.mark.parametrize("other", [CODE.replace("+", "-"), CODE.replace("1", "1.0"), CODE.replace("(x)", "(x=0)")])
def test_every_change_of_behaviour_counts(other):
    assert code_text(other) != code_text(CODE)


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
        ("models/features/drive_clearance/way.py", runs_sha256, "kitchen", True),
        ("models/features/drive_clearance/way.py", hash_of_learning, "kitchen", True),
        ("models/features/drive_clearance/way.py", episodes_sha256, "kitchen", False),
        ("tools/viewer/page.py", runs_sha256, "arm", False),
    ],
)
def test_only_what_determines_the_behaviour_counts(altered, path, hashed, domain, counts):
    assert altered(path, hashed, domain) is counts
