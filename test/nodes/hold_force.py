#!/usr/bin/python3
"""Commands a constant force until it is ended: hold_force.py FINGER X Y Z, in N by hand_base."""
import sys

import rospy
from geometry_msgs.msg import Vector3
from haptex.msg import ServoForce

RATE = 500.0  # Hz; the driver waits 10 ms for the next


def main():
    finger, *components = sys.argv[1:]
    force = Vector3(*(float(component) for component in components))
    rospy.init_node('hold_force', anonymous=True)
    publisher = rospy.Publisher(f'{finger}/servo_cf', ServoForce, queue_size=1)
    rate = rospy.Rate(RATE)
    message = ServoForce(force=force)
    message.header.frame_id = 'hand_base'
    while not rospy.is_shutdown():
        message.header.stamp = rospy.Time.now()
        publisher.publish(message)
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
