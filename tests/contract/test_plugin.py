"""The pytest plug-in: `--tailor-domain` adds the contract to a repository's own tests; without it nothing changes."""

import subprocess
import sys
from importlib.metadata import entry_points

import pytest

from tailor.schemas.installed import domain_names

PLUGIN = "tailor.tools.contract.plugin"
# an editable install may be older than the entry point; naming a plug-in twice is an error
NAMED = [] if any(point.value == PLUGIN for point in entry_points(group="pytest11")) else ["-p", PLUGIN]


@pytest.fixture
def run(tmp_path):
    (tmp_path / "test_own.py").write_text("def test_own():\n    pass\n")

    def completed(*arguments):
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *NAMED, *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)

    return completed


def test_without_the_option_nothing_of_tailor_runs(run):
    assert "1 passed" in run().stdout


def test_the_contract_runs_beside_the_repositorys_tests(run):
    done = run("--tailor-domain", "arm", "--tailor-domain", "soccer", "-k", "own or units or stamp", "-v")
    assert done.returncode == 0, done.stdout
    assert "test_own.py::test_own PASSED" in done.stdout
    for name in ("arm", "soccer"):
        assert f"[{name}-parameters_have_units] PASSED" in done.stdout
        assert done.stdout.count(f"[{name}-parameters_have_units]") == 1


def test_an_unknown_domain_is_refused_in_one_line(run):
    done = run("--tailor-domain", "chess")
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert (
        done.stderr.strip()
        == f"ERROR: --tailor-domain: no domain 'chess', expected one of: {', '.join(domain_names())}"
    )
