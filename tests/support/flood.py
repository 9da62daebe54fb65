"""Floods keys of a bus with junk until it is killed. Arguments: endpoint, keys."""

import sys

import zenoh

from tailor.runtime.bus import zenoh_config

NO_STOP = bytes([0, 1, 0, 0, 0])  # std_msgs/Bool in CDR: false, which a driver decodes and heeds not


def main(endpoint, *keys):
    with zenoh.open(zenoh.Config.from_json5(zenoh_config.client(endpoint))) as session:
        publishers = [session.declare_publisher(key, congestion_control=zenoh.CongestionControl.DROP) for key in keys]
        while True:
            for publisher in publishers:
                publisher.put(NO_STOP)


if __name__ == "__main__":
    main(*sys.argv[1:])
