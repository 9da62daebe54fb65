"""A base as a node of real ROS 2 (rclpy): takes TwistStamped on /cmd_vel, publishes /odom."""

import math
import sys

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry

from tests.support.stand_ins.plain_robot import DEAD_S, FASTER, PERIOD_S, SLOWER, TIMEOUT_S, TURN, moved, ramped


class Base:
    """Its state is the pose in odom and the speeds; it stops by itself without commands, as most bases do."""

    def __init__(self, node):
        self.node, self.pose, self.v, self.omega = node, (0.0, 0.0, 0.0), 0.0, 0.0
        self.waiting, self.wanted, self.heard_s = [], (0.0, 0.0), -math.inf
        self.odometry = node.create_publisher(Odometry, "/odom", 10)
        node.create_subscription(TwistStamped, "/cmd_vel", self.take, 10)
        node.create_timer(PERIOD_S, self.step)

    def now_s(self):
        return self.node.get_clock().now().nanoseconds / 1e9

    def take(self, command):
        self.waiting.append((self.now_s() + DEAD_S, (command.twist.linear.x, command.twist.angular.z)))

    def step(self):
        now_s = self.now_s()
        while self.waiting and self.waiting[0][0] <= now_s:
            self.heard_s, self.wanted = self.waiting.pop(0)
        v, omega = self.wanted if now_s - self.heard_s < TIMEOUT_S else (0.0, 0.0)
        self.v = ramped(self.v, v, FASTER if abs(v) > abs(self.v) and v * self.v >= 0 else SLOWER)
        self.omega = ramped(self.omega, omega, TURN)
        self.pose = moved(self.pose, self.v, self.omega)
        self.publish()

    def publish(self):
        message = Odometry()
        message.header.stamp = self.node.get_clock().now().to_msg()
        message.header.frame_id, message.child_frame_id = "odom", "base_link"
        point, turn = message.pose.pose.position, message.pose.pose.orientation
        point.x, point.y = self.pose[:2]
        turn.z, turn.w = math.sin(self.pose[2] / 2), math.cos(self.pose[2] / 2)
        message.twist.twist.linear.x, message.twist.twist.angular.z = self.v, self.omega
        self.odometry.publish(message)


if __name__ == "__main__":
    rclpy.init()
    robot = Base(rclpy.create_node("base"))
    print("ready", file=sys.stderr)
    rclpy.spin(robot.node)
