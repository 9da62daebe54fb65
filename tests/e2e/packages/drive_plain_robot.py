"""Drives a stand-in for a real robot with plain topics to the goal of a domain's first scenario; prints the result.

Arguments: domain, repository. Runs in an environment that has the domain's package.
"""

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tailor.executive import domains
from tailor.runtime.bus.opening import open_router
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import ExecStatus
from tailor.tools.launch.hosting import free_endpoint


def main(domain: str, repository: str) -> None:
    scenario = domains.scenarios(domain)[0]
    start = domains.seeded_scenario(domain, scenario, 0)[1]
    pose = [start[name] for name in ("x", "y", "phi")]
    ours, robots = free_endpoint(), free_endpoint()
    stand_in = Path(repository, "tests", "support", "stand_ins", "plain_robot.py")
    with TemporaryDirectory() as folder, open_router(ours) as session, open_router(robots):
        file, trace = Path(folder, "robot.toml"), Path(folder, "trace")
        file.write_text(f'robot = "{domain}"\ncommand = "twist"\n[bus]\nconnect = "{robots}"\n[pose]\nstart = {pose}\n')
        options = json.dumps({"endpoint": robots, "trace": str(trace), "start": pose})
        children = [Child("base", [sys.executable, str(stand_in), options])]
        children.append(Child("driver", tailor("driver", str(file), "--connect", ours)))
        executive = Child("executive", tailor("executive", domain, "--once", "--connect", ours))
        children.append(executive)
        statuses = session.inbox(["status"], domain)
        while executive.exit_code() is None:
            for sample in statuses.drain():
                if isinstance(sample.message, ExecStatus):
                    arm = ("arm", domain, "--sender", sample.sender, "--connect", ours)
                    armed = subprocess.run(tailor(*arm), capture_output=True, timeout=60).returncode == 0
                    if armed:
                        executive.wait(180)
                    break
        print("achieved" if executive.exit_code() == 0 else "not achieved")
        for child in children:
            child.kill()


if __name__ == "__main__":
    main(*sys.argv[1:])
