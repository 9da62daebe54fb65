"""The action of ROS 2 that pursues a goal: what became of each client's goal, and its server."""
