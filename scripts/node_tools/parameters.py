"""What nodes in Python read from the parameter server, and refuse."""
import math

import rospy


def number(name, least, largest, default=None, above=False, unit=''):
    """A private parameter: from `least` (above it, if `above`) to `largest`.
    @throws ValueError naming the parameter, its value and what is allowed"""
    value = rospy.get_param('~' + name, default)
    sound = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    if not sound or not least <= value <= largest or (above and value == least):
        raise ValueError(f'parameter {rospy.resolve_name("~" + name)} is {str(value)[:200]}: allowed are numbers '
                         f'{">" if above else "from"} {least:g} to {largest:g}{unit and " " + unit}')
    return float(value)


def frame_prefix():
    """What tf's frames begin with, without the slash: the parameter tf_prefix, or ''."""
    name = rospy.search_param('tf_prefix')
    return rospy.get_param(name) if name else ''
