"""ROS 2 types for rosbags: those that each process of a robot needs, compiled for CDR alone."""
