"""What rviz shows of the fabric: passed on, or kept from the person."""
import rospy
from visualization_msgs.msg import Marker, MarkerArray

SOURCES = ('cloth', 'contact', 'tactile', 'proximity')  # whose SOURCE/markers tell about the fabric


class Picture:
    """rviz draws evaluation/SOURCE_markers (launch/evaluation.launch). If the fabric is hidden they
    say once that nothing is to be drawn. Nothing is subscribed to that nobody looks at."""

    def __init__(self, shown):
        self._shown = shown
        self._subscribers = {}
        self._publishers = {}
        for source in SOURCES:
            self._publishers[source] = rospy.Publisher(f'evaluation/{source}_markers', MarkerArray,
                                                       queue_size=2, latch=not shown)
            if not shown:
                self._publishers[source].publish(MarkerArray([Marker(action=Marker.DELETEALL)]))

    def look(self):
        """To be called about once a second: begins or ends to pass on."""
        if not self._shown:
            return
        for source, publisher in self._publishers.items():
            looked_at = publisher.get_num_connections() > 0
            if looked_at and source not in self._subscribers:
                self._subscribers[source] = rospy.Subscriber(f'{source}/markers', rospy.AnyMsg,
                                                             publisher.publish, queue_size=2)
            elif not looked_at and source in self._subscribers:
                self._subscribers.pop(source).unregister()
