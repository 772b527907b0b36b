"""What the unit tests in Python have in common, without ROS."""
import pathlib
import tempfile
import unittest


class Folder(unittest.TestCase):
    """With a folder of its own for every test."""

    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)


def suite_of(*cases):
    """Of several test cases, for rostest, which takes one."""
    class Tests(unittest.TestSuite):
        def __init__(self):
            load = unittest.TestLoader().loadTestsFromTestCase
            super().__init__(map(load, cases))
    return Tests
