"""What the programs that are started from a shell have in common."""
import pathlib
import sys

import roslib.packages


def run(name, usage, arguments, work):
    """Of a program that takes two arguments or more.
    @param work does it, by the arguments and the package's folder config; of it OSError and ValueError
    are said on standard error
    @returns the exit status"""
    if arguments == ['--help']:
        sys.stdout.write(usage)
        return 0
    if len(arguments) < 2:
        sys.stderr.write(usage)
        return 2
    try:
        work(arguments, pathlib.Path(roslib.packages.get_pkg_dir('haptex')) / 'config')
    except (OSError, ValueError) as error:
        print(f'{name}: {error}', file=sys.stderr)
        return 1
    return 0
