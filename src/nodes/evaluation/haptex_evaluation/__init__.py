"""Evaluation by people: protocol, session, statistics, hand values. Only `node` and `recording` know ROS."""
