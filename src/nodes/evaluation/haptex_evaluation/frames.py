"""Names of tf frames, which the parameter tf_prefix may precede."""
import rospy


def frame_name(name):
    parameter = rospy.search_param('tf_prefix')
    prefix = rospy.get_param(parameter) if parameter else ''
    return f'{prefix}/{name}' if prefix else name
