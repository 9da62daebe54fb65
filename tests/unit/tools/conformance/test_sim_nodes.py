"""The simulated robots that ship keep to every clause, and move as themselves."""

import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.fit import differences, responses
from tailor.tools.conformance.simulated_link import SimulatedLink
from tailor.tools.conformance.suite import verdicts
from tailor.tools.lockstep.worlds import make_world


def bench_of(robot, seed=0):
    domain, spec = domains.load(spec_of_robot(robot).name), shipped_driver_spec(robot)
    try:
        world = make_world(robot, "", seed)
    except (UsageError, ImportError) as error:  # its physics are an optional dependency
        pytest.skip(str(error))
    return Bench(SimulatedLink(world, spec), domain, spec, fraction=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("robot", robot_names())
def test_a_simulated_robot_keeps_to_every_clause(robot):
    broken = [each for each in verdicts(bench_of(robot)) if each.faults or each.skipped]
    assert broken == []


@pytest.mark.slow
@pytest.mark.parametrize("robot", robot_names())
@pytest.mark.parametrize("fraction", [0.15, 1.0])
def test_a_simulated_robot_moves_as_itself_with_other_noise(robot, fraction):
    one, other = responses(bench_of(robot), fraction), responses(bench_of(robot, seed=1), fraction)
    assert one
    assert list(differences(one, other)) == []
