"""Anyone may publish on exec/tick: messages that are no ticks of an executive are counted and reported."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from tailor.executive.composition import rebuild_context
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_named
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import EStop, PlanReport, Provenance, TickReport, VelocityCommand
from tailor.schemas.typesystem import ros_type
from tailor.tools.main import main
from tailor.tools.recordings.executive_run import PROVENANCE_KEY, TICK_KEY
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.verification import verify

GOLDEN = Path(__file__).parents[2] / "data" / "golden" / "soccer-approach.mcap"
STRANGER = "ab" * 16
GARBAGE = b"\0\1\0\0garbage"
TICK = ros_type(TickReport)


@pytest.fixture(scope="module")
def whole():
    return list(open_recording(GOLDEN).messages())


@pytest.fixture(scope="module")
def executive(whole):
    return next(message.sender for message in whole if message.key == TICK_KEY)


def written(path, messages, extra=(), metadata=None):
    """Recording of the messages and extra ones on exec/tick: (sender, bytes, ROS type)."""
    tape = McapWriter(path, metadata or {}, compact=True)
    rows = [(m.key, m.data, m.sender, m.sequence, m.ros_type) for m in messages]
    rows[20:20] = [(TICK_KEY, data, sender, 9000 + n, kind) for n, (sender, data, kind) in enumerate(extra)]
    for n, (key, data, sender, sequence, kind) in enumerate(rows):
        attachment = pack(Origin(sequence, 10 + n, sender)) if sender else None
        tape.write(Raw(key, data, attachment, encoding_named(kind), True, None), 10 + n)
    tape.close()
    return path


@pytest.mark.parametrize("sender", ["", STRANGER], ids=["unsigned", "a stranger"])
def test_foreign_garbage_on_the_tick_topic_is_ignored(tmp_path, capsys, whole, sender):
    path = written(tmp_path / "a.mcap", whole, [(sender, GARBAGE, TICK)] * 3)
    assert main(["verify", str(path)]) == 0
    extra = capsys.readouterr().out.splitlines()
    assert extra[0].startswith("equal: ")
    assert extra[1] == f"  ignored on exec/tick: 3 from {sender[:8] or 'an unknown sender'}, not an executive"


def test_foreign_well_formed_ticks_are_not_a_run(tmp_path, whole, executive):
    tick = next(m.data for m in whole if m.key == TICK_KEY)
    runs = RecordedRuns(written(tmp_path / "a.mcap", whole, [(STRANGER, tick, TICK)]))
    assert [run.sender for run in runs.runs] == [executive]
    assert runs.left_out.total() == 1


def test_a_tick_whose_inputs_are_no_rows_counts_as_malformed(tmp_path, capsys, whole, executive):
    """Every column has as many entries as the others; without one, `verify` ended in a traceback."""
    last = next(m.data for m in reversed(whole) if m.key == TICK_KEY and decode(TickReport, m.data).input_keys)
    tick = decode(TickReport, last)
    wrong = encode(replace(tick, input_arrivals_ns=tick.input_arrivals_ns[1:]))
    assert main(["verify", str(written(tmp_path / "a.mcap", whole, [(executive, wrong, TICK)]))]) == 0
    assert "1 with inputs that lack key, sender, number or arrival" in capsys.readouterr().out


def test_garbage_under_the_executives_sender_is_reported_and_the_run_is_verified(tmp_path, capsys, whole, executive):
    stop = encode(EStop(True))
    extra = [(executive, GARBAGE, TICK), (executive, GARBAGE, TICK), (executive, stop, ros_type(EStop))]
    assert main(["verify", str(written(tmp_path / "a.mcap", whole, extra))]) == 0
    assert "ignored on exec/tick: 2 malformed, 1 std_msgs/msg/Bool" in capsys.readouterr().out


def test_a_damaged_tick_is_detected_by_its_number_and_reported(tmp_path, capsys, whole, executive):
    kept = [m for m in whole if m.key != TICK_KEY or decode(TickReport, m.data).tick != 7]
    path = written(tmp_path / "a.mcap", kept, [(executive, GARBAGE, TICK)])
    assert main(["verify", str(path)]) == 2
    verdict, ends, _ = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r"equal: \d+ messages of 6 ticks \(.*\)", verdict)
    assert ends.startswith(f"  not verified to the end: {path}: tick 7 is missing (ignored on exec/tick: 1 malformed)")


def test_of_two_runs_the_one_that_lacks_no_tick_is_verified(tmp_path, capsys, whole, executive):
    other = [replace(m, sender=STRANGER) for m in whole if m.sender == executive]
    kept = [m for m in whole if m.key != TICK_KEY or decode(TickReport, m.data).tick != 7]
    assert main(["verify", str(written(tmp_path / "a.mcap", [*kept, *other]))]) == 2
    verdicts = capsys.readouterr().out.splitlines()
    assert [line.partition(":")[0].strip() for line in verdicts] == ["equal", "not verified to the end", "equal"]


def test_a_difference_before_a_missing_tick_counts(tmp_path, whole, executive):
    kept = [m for m in whole if m.key != TICK_KEY or decode(TickReport, m.data).tick != 7]
    first = next(m for m in kept if m.key == "agilo/cmd_vel")
    changed = replace(decode(VelocityCommand, first.data), v=0.123)
    kept[kept.index(first)] = replace(first, data=encode(changed))
    assert main(["verify", str(written(tmp_path / "a.mcap", kept))]) == 1


def unnumbered(message, odometry):
    """A message as if odometry of these numbers had come without them."""
    if message.key == "agilo/odom":
        return replace(message, sequence=0) if message.sequence in odometry else message
    if message.key != TICK_KEY:
        return message
    report = decode(TickReport, message.data)
    inputs = zip(report.input_keys, report.input_sequences, strict=True)
    numbers = tuple(0 if key == "agilo/odom" and number in odometry else number for key, number in inputs)
    return replace(message, data=encode(replace(report, input_sequences=numbers)))


def test_which_of_several_messages_without_numbers_a_tick_has_read_is_not_guessed(tmp_path, capsys, whole):
    """The first one was taken for all, so that today's core was said to differ."""
    ticks = [decode(TickReport, m.data) for m in whole if m.key == TICK_KEY]
    read = [n for t in ticks for key, n in zip(t.input_keys, t.input_sequences, strict=True) if key == "agilo/odom"]
    one = written(tmp_path / "a.mcap", [unnumbered(message, read[:1]) for message in whole])
    assert main(["verify", str(one)]) == 0, "there is no other"
    two = written(tmp_path / "b.mcap", [unnumbered(message, read[5:7]) for message in whole])
    assert main(["verify", str(two)]) == 2
    assert "read one of 2 messages of agilo/odom without numbers, expected numbers" in capsys.readouterr().out


def test_without_its_first_tick_nothing_is_verified(tmp_path, capsys, whole):
    kept = [m for m in whole if m.key != TICK_KEY or decode(TickReport, m.data).tick != 1]
    assert main(["verify", str(written(tmp_path / "a.mcap", kept))]) == 2
    assert "tick 1 is missing" in capsys.readouterr().err


@pytest.mark.parametrize("field", ["now_ns", "input_arrivals_ns"])
@pytest.mark.parametrize("time_ns", [-1, 2**62])
def test_a_tick_at_a_time_that_no_message_states_ends_the_verification(tmp_path, capsys, whole, field, time_ns):
    """Of ticks of foreign clocks `verify` and `verify -o` ended in tracebacks."""
    ticks = [(at, message) for at, message in enumerate(whole) if message.key == TICK_KEY]
    at, seventh = next(row for row in ticks if decode(TickReport, row[1].data).tick == 7)
    tick = decode(TickReport, seventh.data)
    values = {"now_ns": time_ns, "input_arrivals_ns": (time_ns,) * len(tick.input_keys)}
    changed = replace(seventh, data=encode(replace(tick, **{field: values[field]})))
    path = written(tmp_path / "a.mcap", [*whole[:at], changed, *whole[at + 1 :]])
    expected = f"{path}: tick 7 has a time of {time_ns} ns, expected 0 to 2.14748e+18"
    assert main(["verify", str(path)]) == 2
    assert f"not verified to the end: {expected}" in capsys.readouterr().out
    assert main(["verify", str(path), "-o", str(tmp_path / "b.mcap")]) == 2
    assert capsys.readouterr().err.startswith(f"tailor verify: {expected}")
    assert not (tmp_path / "b.mcap").exists()


def copied(whole, executive, **provenance):
    """The run once more, by a stranger of another provenance."""
    copies = [replace(m, sender=STRANGER) for m in whole if m.sender == executive]
    data = {PROVENANCE_KEY: encode(Provenance(0, **provenance))}
    return [replace(m, data=data.get(m.key, m.data)) for m in copies]


def test_a_stranger_whose_provenance_cannot_be_read_is_no_executive(tmp_path, capsys, whole, executive):
    """It made the file one that cannot be verified."""
    path = written(tmp_path / "a.mcap", [*copied(whole, executive, json="none"), *whole])
    assert main(["verify", str(path)]) == 0
    verdict, ignored = capsys.readouterr().out.splitlines()
    assert verdict.startswith("equal: ")
    assert re.fullmatch(rf"  ignored on exec/tick: \d+ from {STRANGER[:8]}, whose provenance is damaged", ignored)
    assert main(["verify", str(written(tmp_path / "b.mcap", copied(whole, executive, json="none")))]) == 2
    assert "exec/provenance: not JSON" in capsys.readouterr().err


def test_beside_an_executive_of_a_robot_that_is_unknown_here_the_others_are_verified(
    tmp_path, capsys, whole, executive
):
    made = json.loads(decode(Provenance, next(m.data for m in whole if m.key == PROVENANCE_KEY)).json)
    made["config"]["domain"] = "elsewhere"
    path = written(tmp_path / "a.mcap", [*copied(whole, executive, json=json.dumps(made)), *whole])
    assert main(["verify", str(path)]) == 2
    printed = capsys.readouterr()
    assert printed.out.startswith("equal: ")
    assert re.match(rf"tailor verify: executive {STRANGER[:8]}: .*'elsewhere'", printed.err)


def test_what_an_executive_read_from_another_one_is_found(tmp_path, whole, executive):
    """On an open bus whoever publishes ticks and a provenance may publish readings of sensors as well."""
    driver = next(m.sender for m in whole if m.key == "agilo/driver")
    false = [replace(m, sender=driver) for m in whole if m.key in (TICK_KEY, PROVENANCE_KEY)]
    runs = RecordedRuns(written(tmp_path / "a.mcap", [*whole, *false]))
    own = next(run for run in runs.runs if run.sender == executive)
    assert len(runs.runs) == 2
    assert verify(runs, own, rebuild_context(own.provenance)).difference is None


def test_a_damaged_message_of_a_run_is_reported_with_its_file(tmp_path, capsys, whole, executive):
    status = next(m for m in whole if m.key == "exec/status")
    path = written(tmp_path / "a.mcap", [*whole, replace(status, sequence=9999, data=GARBAGE)])
    assert main(["compare", str(path), str(path)]) == 2
    assert capsys.readouterr().err.startswith(f"tailor compare: {path}: exec/status number 9999: ")


def test_a_file_with_only_garbage_on_the_tick_topic_holds_no_run(tmp_path, whole):
    others = [m for m in whole if m.key not in (TICK_KEY, PROVENANCE_KEY)]
    path = written(tmp_path / "a.mcap", others, [(STRANGER, GARBAGE, TICK)])
    with pytest.raises(UsageError, match=r"no usable message of exec/tick \(ignored on exec/tick: 1 malformed\)"):
        RecordedRuns(path)


def test_without_any_provenance_every_sender_of_ticks_has_a_run(tmp_path, whole, executive):
    others = [m for m in whole if m.key != PROVENANCE_KEY]
    tick = next(m.data for m in whole if m.key == TICK_KEY)
    runs = RecordedRuns(written(tmp_path / "a.mcap", others, [(STRANGER, tick, TICK)]))
    assert {run.sender for run in runs.runs} == {executive, STRANGER}


def test_any_number_of_foreign_senders_is_reported_in_one_short_line(tmp_path, whole):
    extra = [(f"{n:08x}" * 4, GARBAGE, TICK) for n in range(40)]
    runs = RecordedRuns(written(tmp_path / "a.mcap", whole, extra))
    assert runs.left_out_text().endswith(", 37 others")


def test_only_who_asks_for_a_part_gets_the_verdict_on_one(tmp_path, whole):
    """A golden recording that lost a tick must not pass for whole."""
    kept = [m for m in whole if m.key != TICK_KEY or decode(TickReport, m.data).tick != 7]
    runs = RecordedRuns(written(tmp_path / "a.mcap", kept))
    with pytest.raises(UsageError, match="tick 7 is missing"):
        verify(runs, runs.runs[0], rebuild_context(runs.runs[0].provenance))


def test_what_an_executive_published_in_the_tick_in_which_it_ended_is_no_difference(tmp_path, capsys, whole):
    """An executive that is killed, or whose robot's code raises, reports no tick; verify called that a fault."""
    last = next(message for message in reversed(whole) if message.key == TICK_KEY)
    path = written(tmp_path / "a.mcap", [message for message in whole if message is not last])
    assert main(["verify", str(path)]) == 0
    assert capsys.readouterr().out.startswith("equal: ")


LOST = "  not recorded, thus not compared: 1 of {}"


@pytest.mark.parametrize("flags", [[], ["--without-proofs"]], ids=["all", "without proofs"])
@pytest.mark.parametrize("key", ["agilo/cmd_vel", "exec/status"])
def test_an_output_that_a_recording_lost_is_no_difference(tmp_path, capsys, whole, key, flags):
    """The one after it was compared instead, which verify called a fault of the core."""
    kept = [m for m in whole if (m.key, m.sequence) != (key, 20)]
    assert main(["verify", str(written(tmp_path / "a.mcap", kept)), *flags]) == 2
    verdict, lost, *_ = capsys.readouterr().out.splitlines()
    assert verdict.startswith("equal: ")
    assert lost == LOST.format(key)


@pytest.mark.parametrize("key", ["agilo/cmd_vel", "exec/status", "exec/plan"])
def test_an_output_of_the_last_tick_that_is_not_recorded_is_counted(tmp_path, capsys, whole, key):
    """The recording was called equal to its end: the tick's report is published last, so the output was, too."""
    last = next(m for m in reversed(whole) if m.key == key)
    assert main(["verify", str(written(tmp_path / "a.mcap", [m for m in whole if m is not last]))]) == 2
    assert capsys.readouterr().out.splitlines()[1] == LOST.format(key)


@pytest.mark.parametrize("flags", [[], ["--without-proofs"]], ids=["all", "without proofs"])
def test_the_last_output_of_a_key_of_which_the_recorder_dropped_messages_is_no_difference(
    tmp_path, capsys, whole, flags
):
    """No later number shows the loss; the recorder's own count does. It was called a difference of the core."""
    kept = [m for m in whole if m.key != "exec/refinement"]
    path = written(tmp_path / "a.mcap", kept, metadata={"drops": {"exec/refinement": "1"}})
    assert main(["verify", str(path), *flags]) == 2
    assert capsys.readouterr().out.splitlines()[1] == LOST.format("exec/refinement")


def test_a_difference_that_may_be_a_loss_is_called_so(tmp_path, capsys, whole):
    kept = [m for m in whole if m.key != "exec/refinement"]
    assert main(["verify", str(written(tmp_path / "a.mcap", kept))]) == 1
    output = capsys.readouterr().out
    assert "exec/refinement, message: recorded none" in output
    assert "\n  unless the recording lost it: of exec/refinement nothing later is recorded" in output


def test_an_output_that_today_s_core_does_not_publish_is_placed_in_its_tick(tmp_path, capsys, whole):
    """It was found at the end, and placed there."""
    plan = next(m for m in whole if m.key == "exec/plan")
    stamped = replace(decode(PlanReport, plan.data), stamp_ns=2_000_000_000)
    added = replace(plan, sequence=3, data=encode(stamped))
    assert main(["verify", str(written(tmp_path / "a.mcap", [*whole, added]))]) == 1
    output = capsys.readouterr().out
    assert output.startswith("different: tick 20, exec/plan, message: recorded number 3, today none\n")
    assert "unless the recording lost it" not in output


def test_a_difference_after_an_output_that_was_lost_counts(tmp_path, capsys, whole):
    last = next(m for m in reversed(whole) if m.key == "agilo/cmd_vel")
    changed = replace(last, data=encode(replace(decode(VelocityCommand, last.data), v=0.123)))
    kept = [changed if m is last else m for m in whole if (m.key, m.sequence) != (last.key, 20)]
    assert main(["verify", str(written(tmp_path / "a.mcap", kept))]) == 1
    assert LOST.format("agilo/cmd_vel") in capsys.readouterr().out.splitlines()


def test_without_proofs_reports_are_compared_up_to_one_that_was_lost(tmp_path, capsys):
    """Reports whose proofs alone are new are omitted there: beyond, their numbers do not tell which one is which."""
    whole = list(open_recording(GOLDEN.with_name("soccer-waypoints.mcap")).messages())
    kept = [m for m in whole if (m.key, m.sequence) != ("exec/refinement", 5)]
    assert main(["verify", str(written(tmp_path / "a.mcap", kept)), "--without-proofs"]) == 2
    verdict, lost, *_ = capsys.readouterr().out.splitlines()
    assert verdict.startswith("equal: ")
    assert re.fullmatch(r"  not recorded, thus not compared: \d of exec/refinement", lost)


def test_messages_that_are_recorded_twice_count_once(tmp_path, capsys, whole):
    """As in a file that two recordings of one run were merged into: ticks were missing, and commands differed."""
    path = written(tmp_path / "a.mcap", [m for m in whole for _ in range(2)])
    assert main(["verify", str(path)]) == 0
    assert main(["compare", str(path), str(GOLDEN)]) == 0
