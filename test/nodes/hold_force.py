#!/usr/bin/python3
"""Commands a constant force until it is ended: hold_force.py FINGER X Y Z [listen], in N by
hand_base. With "listen" it subscribes to the fingertip's pose, as force_renderer does."""
import sys

import rospy
from geometry_msgs.msg import PoseStamped, Vector3
from haptex.msg import ServoForce

RATE = 500.0  # Hz; the driver holds a command for 12.5 ms


def main():
    finger, *components = sys.argv[1:]
    force = Vector3(*(float(component) for component in components[:3]))
    rospy.init_node('hold_force', anonymous=True)
    if 'listen' in components:
        rospy.Subscriber(f'{finger}/measured_cp', PoseStamped, lambda pose: None)
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
