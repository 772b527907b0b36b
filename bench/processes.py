"""What the benchmarks of running graphs ask the system: a port for a ROS master, and the computing
time of processes."""
import os
import pathlib
import socket

TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # s


def free_port():
    with socket.socket() as free:
        free.bind(('', 0))
        return free.getsockname()[1]


def stat_of(process):
    """Fields of /proc/<process>/stat from the third on; none of a process that has ended."""
    try:
        return pathlib.Path(f'/proc/{process}/stat').read_text().rsplit(')', 1)[1].split()
    except OSError:
        return None


def computing_time(process):
    """Of all its threads (s); none of a process that has ended."""
    fields = stat_of(process)
    return TICK * sum(map(int, fields[11:13])) if fields else None
