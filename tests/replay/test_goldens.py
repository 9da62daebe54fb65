"""Golden recordings: today's core publishes the recorded outputs; differences are reported."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from dataclasses import replace

import pytest
from rosbags.highlevel import AnyReader

from tailor.executive.composition import rebuild_context
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_named
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.platform_fingerprint import platform_fingerprint, same_kind
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.core_source import core_source
from tailor.schemas.messages import Provenance, RefinementReport, VelocityCommand
from tailor.tools.goldens import renew
from tailor.tools.main import main
from tailor.tools.recordings.executive_run import decoded
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.recorded_source import UNSTATED
from tailor.tools.recordings.verification import verdict_text, verify
from tests.support.bus_system import ROOT

GOLDENS = {golden.name: renew.FOLDER / f"{golden.name}.mcap" for golden in renew.goldens()}
SOME = GOLDENS["soccer-waypoints"]
SHORT = GOLDENS["soccer-approach"]  # a quarter of it, where one is recorded several times
RENEW = "`make goldens` prints the changes and renews the recordings"

of_this_kind = pytest.mark.skipif(
    not same_kind(RecordedRuns(SOME).runs[0].provenance["machine"], platform_fingerprint()),
    reason="the goldens were recorded on another kind of machine",
)


def verdict_of(path):
    runs = RecordedRuns(path)
    return verify(runs, runs.runs[0], rebuild_context(runs.runs[0].provenance))


def rewritten(source, target, change):
    """A copy in which change(value) stands for each message of a type that it knows; None: as it is."""
    tape = McapWriter(target, {}, compact=True)
    for recorded in open_recording(source).messages():
        changed = change(decoded(recorded))
        data = recorded.data if changed is None else encode(changed)
        attachment = pack(Origin(recorded.sequence, recorded.publish_ns, recorded.sender))
        tape.write(Raw(recorded.key, data, attachment, encoding_named(recorded.ros_type), True, None), recorded.log_ns)
    tape.close()
    return target


def with_provenance(change):
    def changed(message):
        if not isinstance(message, Provenance):
            return None
        made_of = json.loads(message.json)
        change(made_of)
        return replace(message, json=json.dumps(made_of, sort_keys=True))

    return changed


def other_horizon(made_of):
    made_of["config"]["settings"]["refinement"]["horizon"] = 1


def other_machine(made_of):
    made_of["machine"]["arithmetic"] = "another"


def other_products(made_of):
    made_of["machine"]["products"] = "another"


def other_gaps(by, change):
    """Changes each gap that was proven by some amount, and the provenance."""
    provenance = with_provenance(change)

    def changed(message):
        if isinstance(message, RefinementReport) and message.gap_pct > 0:
            return replace(message, gap_pct=message.gap_pct + by)
        return provenance(message)

    return changed


def nudged(by, change=lambda made_of: None, command=100):
    """Changes a command, the 100th, by some amount, and the provenance."""
    provenance, seen = with_provenance(change), iter(range(10_000))

    def changed(message):
        if isinstance(message, VelocityCommand) and next(seen) == command:
            return replace(message, v=by(message.v))
        return provenance(message)

    return changed


@pytest.mark.promise("P35")
@pytest.mark.parametrize("name", GOLDENS)
def test_core_publishes_what_it_published_when_the_golden_was_recorded(name):
    try:
        verdict = verdict_of(GOLDENS[name])
    except UsageError as error:
        pytest.fail(f"{name}: {error}; {RENEW}")
    assert verdict.difference is None, f"{name}: {verdict_text(verdict)}; {RENEW}"
    assert not verdict.lost
    assert verdict.ticks > 20


def test_there_are_no_other_goldens_and_all_together_they_are_small():
    files = set(renew.FOLDER.iterdir())
    assert files == set(GOLDENS.values())
    assert sum(path.stat().st_size for path in files) < 600_000


def test_a_golden_opens_in_another_reader_and_lacks_no_number():
    with AnyReader([SOME]) as reader:
        assert sum(1 for _ in reader.messages()) == sum(1 for _ in open_recording(SOME).messages()) > 1000
    numbers = [recorded.sequence for recorded in open_recording(SOME).messages() if recorded.key == "agilo/odom"]
    assert numbers == list(range(5, 5 * len(numbers) + 1, 5)), "the newest of five in a tick"


@pytest.mark.promise("P35")
def test_a_changed_setting_fails_with_tick_field_and_both_values(tmp_path, capsys):
    path = rewritten(SOME, tmp_path / "changed.mcap", with_provenance(other_horizon))
    assert main(["verify", str(path)]) == 1
    output = capsys.readouterr().out
    assert re.match(r"different: tick \d+, exec/refinement, horizon: recorded 2, today 1\n", output), output
    assert UNSTATED in output


def test_a_difference_names_the_folders_whose_source_is_another(tmp_path, capsys):
    def older(made_of):
        other_horizon(made_of)
        made_of["source"] = {"version": "0.0.9", "folders": {**core_source("soccer"), "executive/core": "0"}}

    assert main(["verify", str(rewritten(SOME, tmp_path / "older.mcap", with_provenance(older)))]) == 1
    assert "\n  recorded by tailor 0.0.9 with another executive/core\n" in capsys.readouterr().out


@of_this_kind
def test_a_last_bit_is_a_difference_on_the_same_kind_of_machine(tmp_path):
    path = rewritten(SOME, tmp_path / "bit.mcap", nudged(lambda v: math.nextafter(v, 9.0)))
    difference = verdict_of(path).difference
    assert (difference.tick, difference.key, difference.field) == (102, "agilo/cmd_vel", "v")
    assert float(difference.recorded) == math.nextafter(float(difference.today), 9.0)


def test_a_last_bit_is_tolerated_and_reported_on_another_kind_of_machine(tmp_path, capsys):
    path = rewritten(SOME, tmp_path / "bit.mcap", nudged(lambda v: math.nextafter(v, 9.0), other_machine))
    assert main(["verify", str(path)]) == 0
    output = capsys.readouterr().out
    assert output.startswith("equal within 1e-09, gaps within 0.01 %: ")
    assert re.search(r"; \d+ of them not to the last bit\n  recorded on arithmetic another", output), output


@of_this_kind
def test_where_only_matrix_products_differ_gaps_are_compared_but_for_rounding_and_commands_exactly(tmp_path):
    near = rewritten(SOME, tmp_path / "near.mcap", other_gaps(0.009, other_products))
    verdict = verdict_of(near)
    assert verdict.difference is None
    assert verdict.rounded > 0
    far = rewritten(SOME, tmp_path / "far.mcap", other_gaps(0.02, other_products))
    assert verdict_of(far).difference.field == "gap_pct"
    bit = rewritten(SOME, tmp_path / "bit.mcap", nudged(lambda v: math.nextafter(v, 9.0), other_products))
    assert verdict_of(bit).difference.key == "agilo/cmd_vel"


def test_more_than_rounding_is_a_difference_on_any_machine(tmp_path):
    path = rewritten(SOME, tmp_path / "more.mcap", nudged(lambda v: v + 1e-8, other_machine))
    assert verdict_of(path).difference is not None


@of_this_kind
def test_without_proofs_everything_else_is_compared(tmp_path, capsys):
    def other_gap(message):
        return replace(message, gap_pct=message.gap_pct + 1) if isinstance(message, RefinementReport) else None

    gaps = str(rewritten(SOME, tmp_path / "gaps.mcap", other_gap))
    assert main(["verify", gaps]) == 1
    assert "gap_pct: recorded" in capsys.readouterr().out
    assert main(["verify", "--without-proofs", gaps]) == 0
    bit = str(rewritten(SOME, tmp_path / "bit.mcap", nudged(lambda v: math.nextafter(v, 9.0))))
    assert main(["verify", "--without-proofs", bit]) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="needs glibc's switch for CPU features")
def test_a_machine_without_fused_multiply_add_counts_as_another_kind():
    switched = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
    command = [sys.executable, "-c", "from tailor.runtime.platform_fingerprint import arithmetic; print(arithmetic())"]
    there = subprocess.run(command, env=switched, capture_output=True, text=True, check=True, cwd=ROOT).stdout.strip()
    if there == platform_fingerprint()["arithmetic"]:
        pytest.skip("this libm computes alike with and without")
    command = [sys.executable, "-P", "-m", "tailor.tools.main", "verify", str(SOME)]
    done = subprocess.run(command, env=switched, capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_goldens_are_renewed_only_after_printing_the_changes(tmp_path, capsys, monkeypatch):
    kept, fresh = tmp_path / SHORT.name, tmp_path / "fresh.mcap"
    renew.record(
        next(golden for golden in renew.goldens() if golden.name == SHORT.stem), fresh
    )  # with this CPU's proofs
    rewritten(fresh, kept, nudged(lambda v: v + 0.5, other_horizon, 20))
    before = kept.read_bytes()
    monkeypatch.setattr(renew, "FOLDER", tmp_path)
    assert renew.main([SHORT.stem, "--check"]) == 1
    output = capsys.readouterr().out
    assert f"{SHORT.stem}: changed\n" in output
    assert "settings.refinement.horizon was 1, now 2" in output
    assert re.search(r"first at  tick 22, agilo/cmd_vel, v: was [\d.]+, now [\d.]+", output)
    assert kept.read_bytes() == before
    assert renew.main([SHORT.stem]) == 0
    assert verdict_of(kept).difference is None
    assert renew.main([SHORT.stem, "--check"]) == 0
    assert capsys.readouterr().out.endswith(f"{SHORT.stem}: unchanged\n")
