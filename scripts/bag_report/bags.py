"""Opens bags as they come: whole, cut off by a kill, or not ours."""
import contextlib
import os
import shutil
import tempfile

import rosbag

WANTED = ('cloth/mesh', 'cloth/state', 'index/measured_cf', 'index/contact', 'index/tactile')


class Refused(ValueError):
    """A report cannot be made: what was wrong, and what is allowed."""


class OpenBag:
    """A bag that can be read, and what was wrong with it."""

    def __init__(self, bag, path, cut_off):
        self.bag = bag
        self.path = path
        self.size = os.path.getsize(path)  # bytes
        self.cut_off = cut_off  # it had no index, because its recorder was killed
        self.compression = bag.get_compression_info().compression
        self.types = {topic: information.msg_type for topic, information
                      in bag.get_type_and_topic_info().topics.items()}


@contextlib.contextmanager
def open_bag(path):
    """The file is not changed: what was cut off gets its index in a temporary copy.

    Raises Refused if it is no bag, or none of this package."""
    if not os.path.isfile(path):
        raise Refused(f'{path}: there is no such file')
    with tempfile.TemporaryDirectory() as directory, contextlib.ExitStack() as stack:
        cut_off = False
        try:
            bag = stack.enter_context(rosbag.Bag(path))
        except rosbag.ROSBagUnindexedException:
            cut_off = True
            bag = stack.enter_context(rosbag.Bag(with_index(path, directory)))
        except (rosbag.ROSBagException, OSError, ValueError) as error:
            raise Refused(f'{path}: this is no bag that can be read ({error}); allowed are bags of '
                          'format 2.0, as rosbag and record_topics write them') from error
        opened = OpenBag(bag, path, cut_off)
        require_ours(opened)
        yield opened


def with_index(path, directory):
    """A copy up to the last whole chunk, with an index."""
    copy = os.path.join(directory, 'indexed.bag')
    shutil.copyfile(path, copy)
    try:
        with rosbag.Bag(copy, 'a', allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
    except Exception as error:  # what rosbag raises depends on where the file ends
        raise Refused(f'{path}: it was cut off before anything that can be read was in it '
                      f'({type(error).__name__}: {error})') from error
    return copy


def require_ours(opened):
    if any(name.startswith('haptex/') for name in opened.types.values()):
        return
    if not opened.types:
        raise Refused(f'{opened.path}: the bag holds no message'
                      + (' before the place where it was cut off' if opened.cut_off else '')
                      + '; wanted are topics like ' + ', '.join(WANTED))
    topics = sorted(opened.types)
    some = ', '.join(topics[:8]) + (f' and {len(topics) - 8} more' if len(topics) > 8 else '')
    raise Refused(f'{opened.path}: no topic of haptex is in it, but {some}; wanted are topics '
                  'like ' + ', '.join(WANTED))
