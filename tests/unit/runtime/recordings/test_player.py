"""Playback clock, playback, cutting and recovery without a bus."""

import json

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.playback_clock import PlaybackClock
from tailor.runtime.recordings.player import Player
from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.runtime.recordings.selection import selection
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState
from tailor.schemas.own import example
from tailor.tools.main import main
from tailor.tools.recordings.playback import RecordingPart, remapping
from tailor.tools.recordings.substitution import armed_for
from tests.unit.runtime.recordings.test_mcap_writer import S, write_tape
from tests.unit.runtime.test_loop import SteppedClock

MS = 1_000_000


def test_messages_are_due_at_absolute_times_at_any_rate():
    assert [PlaybackClock(1000, 50).due_ns(1000 + k * 100) for k in range(3)] == [50, 150, 250]
    assert [PlaybackClock(1000, 50, rate=4.0).due_ns(1000 + k * 100) for k in range(3)] == [50, 75, 100]


def test_a_pause_stops_recorded_time_and_continues_from_there():
    playback = PlaybackClock(0, 0)
    playback.toggle(300)
    assert (playback.due_ns(500), playback.recorded_ns(900)) == (None, 300)
    playback.toggle(1000)
    assert (playback.recorded_ns(1000), playback.due_ns(500)) == (300, 1200)


def test_a_step_permits_one_message_during_a_pause():
    playback = PlaybackClock(0, 0, paused=True)
    assert not playback.take_step(10)
    playback.step()
    assert playback.take_step(10)
    assert not playback.take_step(20)
    playback.toggle(100)
    assert playback.due_ns(30) == 120, "time goes on from the message that was stepped to"
    playback.step()
    assert not playback.take_step(40), "steps count only while paused"


def test_the_rate_changes_from_now_on_and_stays_in_its_bounds():
    playback = PlaybackClock(0, 0)
    playback.scale(2.0, 100)
    assert playback.due_ns(300) == 200
    for _ in range(100):
        playback.scale(10.0, 100)
    assert playback.rate == 100.0


class FakePublisher:
    def __init__(self, clock):
        self.clock, self.sent = clock, []

    def __call__(self, key, ros_type):
        self.key = key
        return self

    def put_raw(self, data, origin):
        self.sent.append((self.clock.now_ns(), self.key, data, origin))


def play(tmp_path, watch=lambda playback: True, **passage):
    recording = open_recording(write_tape(tmp_path / "a.mcap", count=10, chunks=1))
    clock = SteppedClock(7)
    publisher = FakePublisher(clock)
    ticks = []
    player = Player(publisher, clock, watch, ticks.append, tick_ns=S)
    part = RecordingPart(recording, selection([], []), **passage)
    finished = player.play(part.messages(), PlaybackClock(part.bounds_ns()[0], clock.now_ns(), rate=2.0))
    return publisher.sent, player.stats, finished, ticks


def test_a_replay_publishes_the_same_bytes_at_the_recorded_intervals(tmp_path):
    sent, stats, finished, ticks = play(tmp_path)
    assert finished
    assert [at for at, *_ in sent] == [7 + k * S // 2 for k in range(10)]
    recorded = list(open_recording(tmp_path / "a.mcap").messages())
    assert [(data, o.sequence, o.source_ns, o.sender) for _, _, data, o in sent] == [
        (m.data, m.sequence, m.publish_ns, m.sender) for m in recorded
    ]
    assert stats.messages == 10
    assert list(stats.lateness_ns) == [0] * 10
    assert ticks[:3] == [S, 3 * S, 5 * S]


def test_a_replay_can_start_later_end_earlier_and_use_another_key(tmp_path):
    sent, *_ = play(tmp_path, start_s=2.0, duration_s=3.0, remap={"agilo/odom": "ghost/odom"})
    assert [(key, origin.sequence) for _, key, _, origin in sent] == [("ghost/odom", k) for k in (3, 4, 5)]


def test_the_watch_function_may_end_a_replay(tmp_path):
    polls = iter([True] * 5 + [False])
    sent, _, finished, _ = play(tmp_path, watch=lambda playback: next(polls))
    assert not finished
    assert len(sent) < 10


def test_a_clock_that_was_set_back_while_it_was_recorded_ends_no_interval():
    """All that followed was sent at once: of a clock that was set back by an hour, the rest of a run."""
    times_s = [5000, 5001, 1401, 1402, 1403, 1402.5, 1404]
    clock = SteppedClock(7)
    publisher = FakePublisher(clock)
    player = Player(publisher, clock, lambda playback: True)
    messages = [Recorded("agilo/odom", "", "", n, round(at_s * S), 0, b"") for n, at_s in enumerate(times_s)]
    assert player.play(messages, PlaybackClock(5000 * S, clock.now_ns()))
    assert [(at - 7) / S for at, *_ in publisher.sent] == [0, 1, 1, 2, 3, 3, 4]


def test_remap_words_are_checked():
    assert remapping(["a/b=c/d"]) == {"a/b": "c/d"}
    with pytest.raises(UsageError, match="--remap a/b"):
        remapping(["a/b"])


def test_a_key_that_is_not_recorded_is_not_replaced_in_silence(tmp_path):
    """A robot on the bus would hear the messages that were to go elsewhere."""
    recording = open_recording(write_tape(tmp_path / "a.mcap"))
    with pytest.raises(
        UsageError, match=r"--remap agilo/odm=ghost/odom: .*has no such key, expected one of: agilo/odom"
    ):
        RecordingPart(recording, selection([], []), {"agilo/odm": "ghost/odom"}).channels()
    part = RecordingPart(recording, selection([], []), {"agilo/odom": "ghost/odom"})
    assert {key for key, _ in part.channels()} == {"ghost/odom"}


def test_a_recorded_driver_appears_to_obey_the_live_executive(tmp_path):
    from dataclasses import replace

    state = replace(example(DriverState), mode="armed", armed_sender="a" * 32)
    recorded = Recorded("agilo/driver", "tailor_msgs/msg/DriverState", "", 1, 0, 0, encode(state))
    rewritten = decode(DriverState, armed_for("b" * 32, recorded).data)
    assert rewritten == replace(state, armed_sender="b" * 32)
    idle = replace(recorded, data=encode(replace(state, armed_sender="")))
    assert armed_for("b" * 32, idle) == idle


def test_a_cut_keeps_bytes_times_and_metadata(tmp_path):
    source = write_tape(tmp_path / "a.mcap")
    copied = copy(source, tmp_path / "b.mcap", lambda key, ros_type, log_ns: 10 * S <= log_ns < 13 * S, {"from_s": "9"})
    assert (copied.kept, copied.left_out) == (3, 47)
    whole, cut = open_recording(source), open_recording(tmp_path / "b.mcap")
    assert list(cut.messages()) == list(whole.messages())[9:12]
    metadata = dict(cut.metadata())
    assert metadata["made"] == {"by": "test"}
    assert metadata["copy"] == {"of": "a.mcap", "damage": "", "from_s": "9"}


def foreign(path, spoil=False):
    """A recording of another program: with the time of a simulator, an attachment, and another profile."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="x-lab", library="other")
        writer.add_attachment(1, 2, "camera.yaml", "text/yaml", b"focal: 525")
        for topic in ("/clock", "/camera"):
            writer.add_message(writer.register_channel(topic, "json", 0), S, b"{}", S)
        writer.finish()
    if spoil:
        path.write_bytes(path.read_bytes().replace(b"focal: 525", b"focal: 595", 1))
    return path


def test_a_cut_of_another_program_s_recording_keeps_its_clock_profile_and_attachments(tmp_path, capsys):
    """The clock was left out as if it were a replay's, attachments were lost, and all was said to be of ROS 2."""
    assert main(["cut", str(foreign(tmp_path / "a.mcap")), "-o", str(tmp_path / "b.mcap")]) == 0
    assert "b.mcap: 2 messages of 2" in capsys.readouterr().out
    with (tmp_path / "b.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "x-lab"
        (kept,) = reader.iter_attachments()
        assert [channel.topic for _, channel, _ in reader.iter_messages()] == ["/clock", "/camera"]
    assert (kept.create_time, kept.log_time, kept.name, kept.data) == (1, 2, "camera.yaml", b"focal: 525")


def test_a_cut_that_selects_nothing_leaves_no_file(tmp_path, capsys):
    """It was one without messages, which the next attempt was refused for."""
    source, target = write_tape(tmp_path / "a.mcap"), tmp_path / "b.mcap"
    assert main(["cut", str(source), "-o", str(target), "--from", "500"]) == 1
    assert capsys.readouterr().out == f"{source}: 0 messages of 50; no file is written\n"
    assert main(["cut", str(source), "-o", str(target), "--from", "500", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["output"] is None
    assert main(["cut", str(source), "-o", str(target), "--from", "9"]) == 0
    assert target.exists()


def torn(path, attachment=False):
    """A recording without messages and without its end."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        if attachment:
            writer.add_attachment(1, 2, "camera.yaml", "text/yaml", b"focal: 525")
        writer.finish()
    path.write_bytes(path.read_bytes()[:-20])
    return path


def test_a_recovery_that_finds_nothing_leaves_no_file(tmp_path, capsys):
    """It was one without messages, which the next attempt was refused for, and which was printed as if it helped."""
    source, target = torn(tmp_path / "a.mcap"), tmp_path / "b.mcap"
    assert main(["recover", str(source), "-o", str(target)]) == 1
    assert "0 of unknown channels skipped; no file is written\n" in capsys.readouterr().out
    assert main(["recover", str(source), "-o", str(target), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["output"] is None
    assert not target.exists()


def test_a_recovery_that_finds_attachments_alone_keeps_them(tmp_path, capsys):
    source, target = torn(tmp_path / "a.mcap", attachment=True), tmp_path / "b.mcap"
    assert main(["recover", str(source), "-o", str(target)]) == 1
    assert "no file is written" not in capsys.readouterr().out
    with target.open("rb") as file:
        assert [each.data for each in make_reader(file).iter_attachments()] == [b"focal: 525"]


def test_a_damaged_attachment_is_reported_and_not_copied(tmp_path, capsys):
    path, new = foreign(tmp_path / "a.mcap", spoil=True), tmp_path / "b.mcap"
    assert main(["recover", str(path), "-o", str(new)]) == 0
    assert "bytes lost (a record is damaged: ValueError)" in capsys.readouterr().out
    with new.open("rb") as file:
        assert list(make_reader(file).iter_attachments()) == []
    assert len(list(open_recording(new).messages())) == 2


def test_recovering_a_truncated_file_gives_a_complete_one_and_reports_the_loss(tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(write_tape(tmp_path / "a.mcap").read_bytes()[:-2000])
    copied = copy(torn, tmp_path / "whole.mcap", lambda *_: True, {})
    assert copied.damage.text().startswith("no footer; ")
    recovered = open_recording(tmp_path / "whole.mcap")
    assert [m.sequence for m in recovered.messages()] == list(range(1, copied.kept + 1))
    assert copied.kept >= 40
    assert recovered.damage.text() == ""
    assert dict(recovered.metadata())["copy"]["damage"] == copied.damage.text()


def test_a_copy_never_overwrites(tmp_path):
    source = write_tape(tmp_path / "a.mcap")
    with pytest.raises(UsageError, match="exists already"):
        copy(source, source, lambda *_: True, {})
    assert open_recording(source).metadata()
