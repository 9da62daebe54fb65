"""The live page and its stop button work again after the bus was started anew, with the passwords of another run."""

from __future__ import annotations

import http.client
import json
import re
import subprocess
from pathlib import Path

import pytest

from tailor.runtime.processes.child import Child, tailor
from tailor.tools.launch.hosting import free_endpoint
from tests.support.bus_system import answers
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.xdist_group("systems")


def request(port: int, method: str, path: str, token: str = "") -> bytes:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request(method, path, headers={"Origin": f"http://127.0.0.1:{port}", "X-Stop-Token": token})
    body = connection.getresponse().read()
    connection.close()
    return body


def test_a_stop_button_without_a_bus_confirms_nothing_and_reaches_the_next_run(tmp_path: Path) -> None:
    endpoint, log = free_endpoint(), tmp_path / "view.log"
    children = [Child("bus", tailor("bus", "--connect", endpoint), subprocess.DEVNULL)]
    try:
        wait_until(lambda: answers(endpoint), "router")
        with log.open("w") as out:
            children.append(Child("view", tailor("view", "--live", "--port", "0", "--connect", endpoint), out))
        wait_until(lambda: log.read_text().startswith("http"), "address")
        port = int(re.search(r":(\d+)/", log.read_text())[1])
        token = re.search(rb'"stop":"([^"]+)"', request(port, "GET", "/"))[1].decode()

        def pressed() -> dict:
            return json.loads(request(port, "POST", "/stop", token))

        assert pressed() == {"confirmed": False, "drivers": {}, "connected": True}
        children[0].kill()
        wait_until(lambda: not pressed()["connected"], "the loss of the bus")
        children.append(Child("bus", tailor("bus", "--connect", endpoint), subprocess.DEVNULL))
        children.append(Child("sim", tailor("sim", "agilo", "--connect", endpoint), subprocess.DEVNULL))
        wait_until(
            lambda: pressed() == {"confirmed": True, "drivers": {"agilo": "estopped"}, "connected": True}, "stop"
        )
    finally:
        for child in reversed(children):
            child.kill()
