#!/usr/bin/python3
"""clock_ahead.py SECONDS: a node that stamps as on a computer whose clock is so far ahead, diagnostics
and places of fingertips."""
import itertools
import sys

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from haptex.msg import Fingertips


def main():
    ahead = rospy.Duration(float(sys.argv[1]))
    rospy.init_node('clock_ahead')
    publishers = {kind: (rospy.Publisher(topic, kind, queue_size=1), every) for topic, kind, every in
                  (('/diagnostics', DiagnosticArray, 50), ('/haptex/exoskeleton/fingertips', Fingertips, 1))}
    for count in itertools.count():
        if rospy.is_shutdown():
            break
        for kind, (publisher, every) in publishers.items():
            if count % every == 0:
                message = kind()
                for pose in getattr(message, 'poses', []):
                    pose.orientation.w = 1.0
                message.header.stamp, message.header.frame_id = rospy.Time.now() + ahead, 'hand_base'
                publisher.publish(message)
        rospy.sleep(0.02)


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
