"""What rviz shows of the fabric: passed on, or kept from the person."""
import rospy
from haptex.msg import ClothMesh, ClothState, Contact, ContactForces
from visualization_msgs.msg import Marker, MarkerArray

# That tell about the fabric, forces included.
MARKERS = ('cloth/markers', 'contact/markers', 'tactile/markers', 'proximity/markers',
           'exoskeleton/force_markers')
# Of our displays, which draw nothing of what does not come. The first is latched.
DRAWN = {'cloth/mesh': ClothMesh, 'cloth/state': ClothState, 'cloth/contact_forces': ContactForces,
         'index/contact': Contact, 'thumb/contact': Contact}


class Picture:
    """rviz draws evaluation/cloth_markers and so on (launch/evaluation.launch). If the fabric is
    hidden markers say once that nothing is to be drawn, and the others never come. Nothing is
    subscribed to that nobody looks at."""

    def __init__(self, shown):
        self._shown = shown
        self._subscribers = {}
        self._publishers = {}
        for topic in (*MARKERS, *DRAWN):
            drawn = f'evaluation/{topic.replace("/", "_")}'
            latched = topic == 'cloth/mesh' or (topic in MARKERS and not shown)
            self._publishers[topic] = rospy.Publisher(drawn, DRAWN.get(topic, MarkerArray), queue_size=2,
                                                      latch=latched)
            if topic in MARKERS and not shown:
                self._publishers[topic].publish(MarkerArray([Marker(action=Marker.DELETEALL)]))

    def look(self):
        """To be called about once a second: begins or ends to pass on."""
        if not self._shown:
            return
        for topic, publisher in self._publishers.items():
            looked_at = publisher.get_num_connections() > 0
            if looked_at and topic not in self._subscribers:
                self._subscribers[topic] = rospy.Subscriber(topic, rospy.AnyMsg, publisher.publish,
                                                            queue_size=2)
            elif not looked_at and topic in self._subscribers:
                self._subscribers.pop(topic).unregister()
