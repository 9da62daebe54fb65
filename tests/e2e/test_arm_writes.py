"""The arm over the bus, with every process real: it writes, and the recording shows the letter."""

import pytest

from tailor.runtime.stopping import Stop
from tailor.tools.cli.live_status import screen
from tailor.tools.cli.systems.deployment import Deployment, executive_config
from tailor.tools.commands.run.letters import recorded_track
from tailor.tools.launch.hosting import private_bus
from tailor.tools.launch.processes import LaunchConfig
from tailor.tools.launch.system import run_system
from tailor.tools.writing.measures import waypoint_errors_rad


@pytest.mark.slow
def test_a_letter_written_live_passes_its_waypoints(tmp_path):
    recording = tmp_path / "letter.mcap"
    config = LaunchConfig(executive_config("arm", Deployment(scenario="word-I")), private_bus(), recording, once=True)
    with screen() as shown:
        assert run_system(config, shown, Stop()) == "achieved"
    track = recorded_track("live", "I", recording)
    assert track.result == "achieved"
    assert len(track.arrivals_s) == len(track.waypoints) == 4
    assert waypoint_errors_rad(track).max() < 0.03
    assert track.peak_current_a > 1.0
