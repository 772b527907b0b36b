#!/usr/bin/python3
"""Watches the force that is commanded to a finger: watch_force.py FINGER FELT prints `felt` when it
is above FELT, in N, then waits for a line on its standard input, which says that the renderer has
gone, and prints the last force once nothing has come for a second. Ends after a minute if no force
is felt."""
import sys
import time

import rospy
from haptex.msg import ServoForce

PATIENCE = 60.0  # s, for a force, and for the master before it
SILENCE = 1.0  # s


class Watcher:
    def __init__(self, finger):
        self.size, self.time = 0.0, time.monotonic()
        rospy.Subscriber(f'/haptex/{finger}/servo_cf', ServoForce, self.take, tcp_nodelay=True)

    def take(self, message):
        force = message.force
        self.size = (force.x ** 2 + force.y ** 2 + force.z ** 2) ** 0.5
        self.time = time.monotonic()


def main():
    finger, felt = sys.argv[1], float(sys.argv[2])
    rospy.init_node('watch_force', anonymous=True, disable_signals=True)
    watcher = Watcher(finger)
    end = time.monotonic() + PATIENCE
    while watcher.size <= felt:
        if time.monotonic() > end:
            sys.exit('no force')
        time.sleep(0.01)
    print('felt', flush=True)
    sys.stdin.readline()  # silence alone may be that of a busy machine
    while time.monotonic() < watcher.time + SILENCE:
        time.sleep(0.01)
    print(f'the last force: {watcher.size:.3g} N', flush=True)


if __name__ == '__main__':
    main()
