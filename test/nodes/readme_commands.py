"""The commands of README.md, as they stand there."""
import collections
import re
import shlex

# in_block: one of a block, not within a sentence or a table.
Command = collections.namedtuple('Command', 'section text in_block')
INLINE = re.compile(r'`((?:scripts/|rosrun |roslaunch |rostopic |rosservice |catkin_make|export )[^`\n]*)`')


def is_whole(text):
    try:
        shlex.split(text, comments=True)
        return True
    except ValueError:  # within quotes
        return False


def without_comment(text):
    """Of one line, or of several whose quotes hold no '#'."""
    return re.sub(r'\s+# .*$', '', text)


def commands_of(text):
    """@param text of README.md @returns its commands in their order, without comments behind them"""
    section, unfinished, commands = '', '', []
    for line in text.splitlines():
        if line.startswith('#'):
            section = line.lstrip('# ')
        elif line.startswith('    ') or unfinished:
            unfinished += line.strip() if not unfinished else f'\n{line.strip()}'
            if is_whole(unfinished):
                commands.append(Command(section, without_comment(unfinished), True))
                unfinished = ''
        else:
            commands += [Command(section, inline, False) for inline in INLINE.findall(line)]
    return commands
