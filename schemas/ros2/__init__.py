"""Tailor among ROS 2 nodes: keys and tokens of rmw_zenoh, the service, and the interface package `tailor_msgs`."""
