"""Programs that draw: whether they are there, and that the same picture is the same file."""
import os
import pathlib
import shutil
import subprocess

from bag_report.bags import Refused

PICTURE = 'picture.png'  # what they write


def require(program):
    """@param program name of an executable, and of Debian's package of it"""
    if shutil.which(program) is None:
        raise Refused(f'{program} is not installed: apt-get install {program}')


def error_in(said):
    """Of all that a program says, on one line."""
    lines = [line.strip() for line in said.splitlines() if 'error' in line.lower()]
    return '; '.join(lines) or ' '.join(said.split())[-400:]


def without_time(png):
    """The chunks that make the picture, without when and by what it was drawn."""
    kept, place = png[:8], 8
    while place < len(png):
        end = place + 12 + int.from_bytes(png[place:place + 4], 'big')
        if png[place + 4:place + 8] in (b'IHDR', b'gAMA', b'sRGB', b'IDAT', b'IEND'):
            kept += png[place:end]
        place = end
    return kept


def run(command, folder, picture):
    """@param command a program and its arguments, that writes the picture in the folder, where it runs
    @param picture its path @throws Refused with what the program says"""
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors='replace',
                           stdin=subprocess.DEVNULL, env={**os.environ, 'HOME': str(folder)})
    if ended.returncode != 0 or not picture.exists():
        raise Refused(f'{command[0]} could not draw it: {error_in(ended.stderr)}')


def draw(command, folder, output):
    """As run(), of a program that writes PICTURE. @param output path of a PNG"""
    picture = pathlib.Path(folder, PICTURE)
    run(command, folder, picture)
    keep(picture, output)


def keep(picture, output):
    """@param picture, output paths of PNGs"""
    pathlib.Path(output).write_bytes(without_time(picture.read_bytes()))
