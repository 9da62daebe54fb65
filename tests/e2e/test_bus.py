"""Sessions on a real router: errors in one line, services, foreign publications, reconnection, arrival times."""

import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack

import pytest
import zenoh

from tailor.runtime.bus.inbox import EVENT_DEPTH
from tailor.runtime.bus.opening import open_client, open_router
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas import codec
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.schemas.messages import EStop, ExecStatus, Odometry, VelocityCommand
from tailor.schemas.own import example
from tailor.schemas.topics import TOPICS
from tests.support.bus_system import free_endpoint
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

ODOMETRY = Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2)


@pytest.fixture
def pair():
    codec.prime()
    endpoint = free_endpoint()
    with open_router(endpoint), open_client(endpoint) as a, open_client(endpoint) as b:
        yield a, b


def test_a_port_in_use_is_reported_in_one_line():
    endpoint = free_endpoint()
    with open_router(endpoint), pytest.raises(UsageError, match="the port is in use"), open_router(endpoint):
        pass


def test_a_missing_router_is_reported_in_one_line():
    with pytest.raises(UsageError, match="no router responds"), open_client(free_endpoint(), timeout_s=0.3):
        pass


def test_a_router_that_hangs_is_no_bus_of_another_user():
    endpoint = free_endpoint()
    bus = Child("bus", tailor("bus", "--connect", endpoint))
    try:
        wait_until(run_folder(endpoint).running, "bus")
        os.kill(bus.pid, signal.SIGSTOP)
        with pytest.raises(UnreachableError, match=r"runs here, but does not respond within 0\.5 s: it hangs"):
            open_client(endpoint, timeout_s=0.5).__enter__()
    finally:
        bus.kill()


@pytest.mark.parametrize("endpoint", ["", "7447", "tcp/localhost", "tcp/1.2.3.4:99999", "ftp/x:1", "tcp/a b:1"])
def test_a_misspelt_endpoint_is_reported_before_anything_is_opened(endpoint):
    with pytest.raises(UsageError, match="expected PROTOCOL/HOST:PORT"), open_client(endpoint):
        pass


def test_the_newest_state_is_stamped_with_its_arrival_not_with_the_drain(pair):
    a, b = pair
    publisher, inbox = a.publisher("odom", "agilo"), b.inbox(["odom"], "agilo")
    wait_until(publisher.matched)
    errors = []
    for _ in range(10):
        inbox.drain()
        publisher.publish(ODOMETRY)
        sent_ns = time.monotonic_ns()
        time.sleep(0.1)
        (sample,) = wait_until(inbox.drain)
        errors.append(sample.arrival_ns - sent_ns)
    assert (sample.sequence, sample.sender, sample.message.x) == (10, a.sender, 1.0)
    assert min(errors) < 20e6, "100 ms would be the time of the drain"


def test_every_command_between_two_drains_is_received_but_only_the_newest_state(pair):
    a, b = pair
    commands, states = a.publisher("cmd_vel", "agilo"), a.publisher("odom", "agilo")
    inbox, witness = (b.inbox(["cmd_vel", "odom"], "agilo") for _ in range(2))
    wait_until(lambda: commands.matched() and states.matched())
    for number in range(5):
        commands.publish(VelocityCommand(number, 0.1, 0.0))
        states.publish(ODOMETRY)
    came = set()
    wait_until(lambda: came.update((s.key, s.sequence) for s in witness.drain()) or len(came) >= 6)
    time.sleep(0.2)
    sequences = [(s.key, s.sequence) for s in inbox.drain()]
    assert sorted(sequences) == [*(("agilo/cmd_vel", k) for k in range(1, 6)), ("agilo/odom", 5)]


def test_an_inbox_can_keep_the_states_of_several_senders(pair):
    a, b = pair
    ours, theirs = a.publisher("status", "agilo"), b.publisher("status", "agilo")
    inbox = b.inbox(["status"], "agilo", newest_only=False)
    wait_until(lambda: ours.matched() and theirs.matched())
    for publisher in (ours, theirs, theirs):
        publisher.publish(example(ExecStatus))
        time.sleep(0.05)
    assert [s.sender for s in inbox.drain()] == [a.sender, b.sender, b.sender]


def test_a_stop_is_not_pushed_out_by_later_messages_of_its_key(pair):
    a, b = pair
    publisher, inbox = a.publisher("estop", ""), b.inbox(["estop"], "")
    witness, subscription = b.subscribe_all("estop")
    wait_until(publisher.matched)
    publisher.publish(EStop(True))
    for _ in range(4 * EVENT_DEPTH):
        time.sleep(0.002)  # the router limits their rate
        publisher.publish(EStop(False))
    wait_until(lambda: witness.received > 2 * EVENT_DEPTH, "more messages than a ring holds")
    subscription.undeclare()
    assert [sample.message for sample in inbox.drain()] == [EStop(True), EStop(False)]


def test_no_publisher_of_a_loop_waits_for_a_slow_reader_and_stops_and_commands_go_first(pair):
    a, _ = pair
    for name, topic in TOPICS.items():
        for declared in a.publisher(name, "agilo")._wire._publishers:
            assert declared.congestion_control == zenoh.CongestionControl.DROP
            assert (declared.priority == zenoh.Priority.REAL_TIME) is (topic.priority == "real_time")
    assert {name for name, topic in TOPICS.items() if topic.priority == "real_time"} == {
        "cmd_vel",
        "joint_cmd",
        "gripper_cmd",
        "estop",
    }


def test_a_put_on_a_wildcard_is_not_accepted_as_a_command(pair):
    a, b = pair
    inbox = b.inbox(["cmd_vel"], "agilo")
    wait_until(a.publisher("cmd_vel", "agilo").matched)
    a._zenoh.put("agilo/*", codec.encode(VelocityCommand(0, 0.5, 0.0)))
    wait_until(lambda: inbox.drain() or inbox.rejected, "wildcard put")
    assert inbox.rejected == {("agilo/cmd_vel", "other key"): 1}


def test_a_plain_put_of_a_ros_bridge_is_accepted(pair):
    a, b = pair
    inbox = b.inbox(["odom"], "agilo")
    wait_until(a.publisher("odom", "agilo").matched)
    a._zenoh.put("agilo/odom", codec.encode(ODOMETRY))
    (sample,) = wait_until(inbox.drain, "plain put")
    assert (sample.sequence, sample.sender) == (0, "")


def test_requests_are_served_from_a_loop(pair):
    a, b = pair
    questions, over = b.service_server("exec/goal"), threading.Event()

    def loop():
        while not over.is_set():
            if question := questions.poll():
                question.accept("gladly") if question.text == "(good)" else question.refuse("no such goal")
            time.sleep(0.005)

    thread = threading.Thread(target=loop)
    thread.start()
    try:
        wait_until(lambda: a.call("exec/goal", "(good)") == (True, "gladly"), "an answer")
        assert a.call("exec/goal", "(bad)") == (False, "no such goal")
        assert a.call("exec/none", "(good)") == (False, "no service at exec/none")
    finally:
        over.set()
        thread.join()
    assert a.call("exec/goal", "(good)", timeout_s=0.2) == (False, "no response within 0.2 s")


@pytest.mark.promise("P41")
def test_a_look_at_all_keys_is_no_request(pair):
    """An empty request to this service is one for the scenario's goal: an armed robot would set off."""
    a, b = pair
    server, texts = b.service_server("exec/goal"), []

    def called(key):
        pending = pool.submit(a.call, key, "", 5.0)
        while not pending.done():
            if request := server.poll():
                texts.append(request.text)
                request.accept()
            time.sleep(0.005)
        return pending.result()

    with ThreadPoolExecutor() as pool:
        wait_until(lambda: called("exec/goal") == (True, "accepted"), "an answer")
        texts.clear()
        for pattern in ("**", "exec/*", "exec/go$*"):
            assert called(pattern) == (False, f"no service at {pattern}")
    assert texts == []


def test_clients_reconnect_within_a_second_of_their_router():
    def back():
        endpoint = free_endpoint()
        with ExitStack() as router:
            router.enter_context(open_router(endpoint))
            with open_client(endpoint) as a, open_client(endpoint) as b:
                publisher, inbox = a.publisher("estop", ""), b.inbox(["estop"], "")
                wait_until(publisher.matched)
                router.close()
                publisher.publish(EStop(True))
                time.sleep(0.7)
                assert not inbox.drain()
                with open_router(endpoint):
                    began = time.monotonic()

                    def received():
                        publisher.publish(EStop(True))
                        return inbox.drain()

                    wait_until(received, "traffic")
                    assert time.monotonic() - began < 1.0

    repeat_on_stall(3, back)
