"""The cloth that the person touches: gives it a fabric and knows which one it has."""
import pathlib

import rospy
from haptex.msg import ClothMesh
from haptex.srv import SetFabric

from .strict_yaml import path_of


class Cloth:
    """Of the services and topics cloth/* of the node's namespace."""

    def __init__(self, config):
        """@param config the folder with fabrics/"""
        self._folder = pathlib.Path(config) / 'fabrics'
        self._text = None  # of the present fabric's file
        self._set_fabric = rospy.ServiceProxy('cloth/set_fabric', SetFabric)
        self._subscriber = rospy.Subscriber('cloth/mesh', ClothMesh, self._take, queue_size=1)

    def _take(self, mesh):
        self._text = mesh.fabric_files[0] if mesh.fabric_files else None

    def has(self, fabric):
        """Whether cloth/mesh, which is published after the change, tells this fabric."""
        return self._text == path_of(fabric, self._folder).read_text('utf-8')

    def ask_for(self, fabric):
        """@returns why it was refused; empty: it was accepted, and has() will tell"""
        try:
            response = self._set_fabric(fabric)
        except (rospy.ServiceException, rospy.ROSException) as error:
            return f'cloth/set_fabric: {error}'
        return '' if response.success else response.message
