"""What the machine took away from everybody who runs on it: steal, and when a processor stood still.

On a virtual machine the host may run something else; /proc/stat counts that as steal, in ticks of
10 ms. When a processor stands still is seen by a process of SCHED_FIFO on each that wakes every few
milliseconds: nothing but the kernel or the host keeps it from waking.
"""
import os
import signal
import struct
import time

PERIOD = 0.004  # s, between two wake-ups
LATE = 0.003  # s, that a wake-up comes late: a stall
PRIORITY = 95  # of SCHED_FIFO: above every node's
TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # s
RECORD = struct.Struct('<3d')  # begin (s since the epoch), length (s) and steal (s) of a stall
STEAL = 8  # place in a line of /proc/stat


def steal_of(line):
    """s since the machine was switched on, of a line of /proc/stat for one or all processors."""
    fields = line.split()
    return TICK * float(fields[STEAL]) if len(fields) > STEAL else 0.0


def read_steal(processor=''):
    with open('/proc/stat', encoding='ascii') as file:
        return next(steal_of(line) for line in file if line.startswith(f'cpu{processor} '))


def fifo_granted(priority):
    """Whether this process may have SCHED_FIFO."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        return True
    except OSError:  # also where the kernel has none
        return False


def watch_processor(processor, pipe):
    """Writes the stalls of a processor into a pipe until its other end is closed."""
    os.sched_setaffinity(0, {processor})
    parent = os.getppid()
    stolen, looked = read_steal(processor), time.monotonic()
    before = time.monotonic()
    while os.getppid() == parent:
        time.sleep(PERIOD)
        now = time.monotonic()
        late = now - before - PERIOD
        if late > LATE:
            steal = read_steal(processor) - stolen
            os.write(pipe, RECORD.pack(time.time() - late, late, steal))
        if late > LATE or now - looked > 1.0:
            stolen, looked = read_steal(processor), now
        before = time.monotonic()


class HostWatch:
    """Watches from its construction on. To be made before there are threads: it forks."""

    def __init__(self):
        self.processors = sorted(os.sched_getaffinity(0))
        self.begin, self.steal_before = time.time(), read_steal()
        self.stalls = []  # begin (s since the epoch), length (s), steal (s) of its processor
        self.children = []
        self.pipe, write_end = os.pipe()
        os.set_blocking(self.pipe, False)
        self.has_fifo = fifo_granted(PRIORITY)
        for processor in self.processors:
            child = os.fork()
            if child == 0:
                self.run_child(processor, write_end)
            self.children.append(child)
        os.close(write_end)

    def run_child(self, processor, write_end):
        try:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # it ends with its parent
            if self.has_fifo:
                os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
            watch_processor(processor, write_end)
        except OSError:  # the other end is closed
            pass
        finally:
            os._exit(0)

    def close(self):
        for child in self.children:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        self.children = []

    def read_stalls(self):
        try:
            data = os.read(self.pipe, 1 << 16)
        except BlockingIOError:
            return
        self.stalls += RECORD.iter_unpack(data[:len(data) - len(data) % RECORD.size])

    def values(self):
        """Keys and texts for /diagnostics, since the construction."""
        self.read_stalls()
        elapsed = time.time() - self.begin
        steal = read_steal() - self.steal_before
        begin, length, stolen = max(self.stalls, key=lambda stall: stall[1], default=(0.0,) * 3)
        return {
            'watched for (s)': f'{elapsed:.3f}',
            'steal (s)': f'{steal:.2f}',
            'steal (share)': f'{steal / (elapsed * len(self.processors)):.6f}',
            'stalls': str(len(self.stalls)),
            'longest stall (ms)': f'{1e3 * length:.1f}',
            'longest stall began (s since the epoch)': f'{begin:.3f}',
            'steal around the longest stall (ms)': f'{1e3 * stolen:.0f}',
            'SCHED_FIFO': 'granted' if self.has_fifo else
                          'not granted: other programs cause stalls, too',
        }
