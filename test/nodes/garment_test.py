#!/usr/bin/python3
"""A garment that is worn moves and is felt as a sample is, and passes through nothing."""
import pathlib
import subprocess
import tempfile

import roslib.packages
import rospy
import rostest
from haptex.msg import ClothMesh, ClothState, Contact
from ros_fixtures import NodeTest

PANELS = 8
FELT = 0.05  # N
WAIT = 90.0  # s


def written(positions, triangles):
    """Lines of an OBJ file, and how many positions it has before those of another one."""
    lines = [f'v {place.x!r} {place.y!r} {place.z!r}' for place in positions]
    corners = [corner + 1 for corner in triangles]
    return lines + ['f {} {} {}'.format(*corners[i:i + 3]) for i in range(0, len(corners), 3)]


def moved(line, by):
    """A line of an OBJ file that follows others."""
    words = line.split()
    if words[:1] != ['f']:
        return line
    return 'f ' + ' '.join(str(int(word.split('/')[0]) + by) for word in words[1:])


class Garment(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.states, cls.contact, cls.touched = [], None, []
        cls.mesh = rospy.wait_for_message('cloth/mesh', ClothMesh, WAIT)
        cls.subscribers = [rospy.Subscriber('cloth/state', ClothState, cls.take_state),
                           rospy.Subscriber('index/contact', Contact, cls.take_contact)]

    @classmethod
    def take_state(cls, state):
        cls.states.append(state)
        del cls.states[:-10]

    @classmethod
    def take_contact(cls, contact):
        cls.contact = contact
        if contact.normal_force > FELT and not cls.touched and cls.states:
            cls.touched.append(cls.states[-1])

    def intersections(self, state):
        """Pairs of triangles of the cloth and of its figure."""
        figure = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'config/meshes/figure.obj')
        lines = written(state.positions, self.mesh.triangles)
        lines += [moved(line, len(state.positions)) for line in figure.read_text().splitlines()]
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory, 'both.obj')
            path.write_text('\n'.join(lines) + '\n')
            program = roslib.packages.find_node('haptex', 'count_intersections')[0]
            return int(subprocess.run([program, str(path)], check=True, capture_output=True,
                                      text=True).stdout)

    def test_1_the_mesh_says_of_every_triangle_where_it_was_cut(self):
        triangles = len(self.mesh.triangles) // 3
        self.assertEqual(len(self.mesh.triangle_panels), triangles)
        self.assertEqual(set(self.mesh.triangle_panels), set(range(PANELS)))
        self.assertEqual(len(self.mesh.corner_weft_coordinates), 3 * triangles)
        self.assertEqual(len(self.mesh.corner_warp_coordinates), 3 * triangles)

    def test_2_it_starts_without_an_intersection(self):
        self.eventually(lambda: self.states, 'a state of the cloth')
        self.assertEqual(self.intersections(self.states[-1]), 0)

    def test_3_a_finger_feels_its_sleeve_and_pushes_it_through_nothing(self):
        self.eventually(lambda: self.touched, f'more than {FELT} N at the sleeve', wait=WAIT)
        self.assertEqual(self.intersections(self.touched[0]), 0)
        rospy.sleep(2.0)
        self.assertEqual(self.intersections(self.states[-1]), 0)


if __name__ == '__main__':
    rospy.init_node('garment_test')
    rostest.rosrun('haptex', 'garment', Garment)
