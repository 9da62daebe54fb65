"""Runs a module with the environment of the ROS 2 wheels: `python -m tests.support.ros2.in_ros MODULE ARGUMENTS`."""

import os
import sys
import sysconfig
from glob import glob


def environment():
    """What a setup script of ROS 2 would export; nodes meet on this machine alone."""
    return {
        **os.environ,
        "AMENT_PREFIX_PATH": sys.prefix,
        "LD_LIBRARY_PATH": ":".join(
            [os.path.join(sys.prefix, "lib"), *glob(f"{sysconfig.get_path('platlib')}/ros_*.libs")]
        ),
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_DOMAIN_ID": str(100 + os.getppid() % 100),  # of one test process
    }


if __name__ == "__main__":
    os.execve(sys.executable, [sys.executable, "-m", *sys.argv[1:]], environment())
