"""Copies bytes between topics of ROS 2 and keys of zenoh. Arguments: endpoint, then in:TOPIC=TYPE or out:TOPIC=TYPE."""

import importlib
import sys

import rclpy
import zenoh


def main(endpoint, *links):
    rclpy.init()
    node = rclpy.create_node("byte_bridge")
    config = zenoh.Config.from_json5(f'{{mode: "client", connect: {{endpoints: ["{endpoint}"]}}}}')
    with zenoh.open(config) as session:
        for link in links:
            direction, topic, ros_type = link.replace("=", ":").split(":")
            package, _, name = ros_type.split("/")
            kind = getattr(importlib.import_module(f"{package}.msg"), name)
            if direction == "in":
                copies = node.create_publisher(kind, topic, 10)
                session.declare_subscriber(topic, lambda s, p=copies: p.publish(s.payload.to_bytes()))
            else:
                key = session.declare_publisher(topic, express=True)
                node.create_subscription(kind, topic, lambda data, k=key: k.put(bytes(data)), 10, raw=True)
        rclpy.spin(node)


if __name__ == "__main__":
    main(*sys.argv[1:])
